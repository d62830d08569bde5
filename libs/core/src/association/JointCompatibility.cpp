#include "slamot/core/association/JointCompatibility.h"

#include <algorithm>
#include <functional>

#include "slamot/core/association/SequentialCompatibility.h"

namespace slamot {
namespace {

/// For each place in `order`, the most pairs that the detections from there on can make with distinct
/// objects: maximum matchings, each grown from the one before by an augmenting path.
std::vector<int> mostPairsFrom(const AssociationProblem& problem, const std::vector<int>& order) {
    std::vector<int> owner(static_cast<std::size_t>(problem.objects()), -1), visit(owner);
    const std::function<bool(int, int)> augment = [&](int detection, int round) {
        for (int c = problem.first(detection); c < problem.first(detection + 1); ++c) {
            const auto object = static_cast<std::size_t>(problem.candidate(c).object);
            if (visit[object] == round) continue;
            visit[object] = round;
            if (owner[object] >= 0 && !augment(owner[object], round)) continue;
            owner[object] = detection;
            return true;
        }
        return false;
    };
    std::vector<int> most(order.size() + 1, 0);
    for (std::size_t i = order.size(); i-- > 0;)
        most[i] = most[i + 1] + augment(order[i], static_cast<int>(i));
    return most;
}

class Search {
  public:
    Search(const AssociationProblem& problem, JointInnovations& innovations, PairGates& gates,
           int node_budget)
        : problem_(problem),
          gates_(gates),
          budget_(node_budget),
          order_(problem.unambiguousFirst()),
          most_(mostPairsFrom(problem, order_)),
          taken_(static_cast<std::size_t>(problem.objects()), 0),
          hypothesis_(innovations, static_cast<int>(order_.size())),
          best_{sequentialCompatibility(problem, innovations, gates)} {
        for (const int detection : order_)
            if (const int c = best_.pairing.of(detection); c >= 0) hypothesis_.push(c);
        best_pairs_ = hypothesis_.pairs();
        best_.nis = hypothesis_.nis();
        while (hypothesis_.pairs() > 0) hypothesis_.pop();
    }

    JointCompatibility run() {
        decide(0);
        return best_;
    }

  private:
    /// Tries all that can be made of the detections from `place` on, nearest first.
    void decide(std::size_t place) {
        if (!promising(place)) return;
        if (place == order_.size()) return keep();

        struct Branch {
            double nis;
            int candidate;
            bool operator<(const Branch& b) const {
                return nis < b.nis || (nis == b.nis && candidate < b.candidate);
            }
        };
        std::vector<Branch> branches;
        const int detection = order_[place];
        for (int c = problem_.first(detection); c < problem_.first(detection + 1); ++c) {
            if (taken(c)) continue;
            if (best_.nodes == budget_) best_.exhausted = true;
            if (best_.exhausted) return;
            ++best_.nodes;
            if (!hypothesis_.push(c)) continue;
            if (hypothesis_.nis() <= gates_(hypothesis_.pairs())) branches.push_back({hypothesis_.nis(), c});
            hypothesis_.pop();
        }
        std::sort(branches.begin(), branches.end());
        for (const Branch& branch : branches) {
            hypothesis_.push(branch.candidate);
            taken(branch.candidate) = 1;
            decide(place + 1);
            taken(branch.candidate) = 0;
            hypothesis_.pop();
            if (best_.exhausted) return;
        }
        decide(place + 1);  // the detection stays alone
    }

    /// Whether more pairs than the best has, or as many at a smaller NIS, can still come of the hypothesis.
    bool promising(std::size_t place) const {
        const int reachable = hypothesis_.pairs() + most_[place];
        return reachable > best_pairs_ || (reachable == best_pairs_ && hypothesis_.nis() < best_.nis);
    }

    void keep() {
        best_.pairing = Pairing(problem_.detections());
        for (const int c : hypothesis_.candidates()) best_.pairing.add(problem_, c);
        best_pairs_ = hypothesis_.pairs();
        best_.nis = hypothesis_.nis();
        best_.is_sequential = false;
    }

    char& taken(int candidate) {
        return taken_[static_cast<std::size_t>(problem_.candidate(candidate).object)];
    }

    const AssociationProblem& problem_;
    PairGates& gates_;
    int budget_;
    std::vector<int> order_;   ///< detections
    std::vector<int> most_;    ///< [place]
    std::vector<char> taken_;  ///< by object
    InnovationFactor hypothesis_;
    JointCompatibility best_;
    int best_pairs_ = 0;
};

}  // namespace

JointCompatibility jointCompatibility(const AssociationProblem& problem, JointInnovations& innovations,
                                      PairGates& gates, int node_budget) {
    return Search(problem, innovations, gates, node_budget).run();
}

}  // namespace slamot
