#include "slamot/core/association/AssociationMarginals.h"

#include <algorithm>

#include "PairGraph.h"

namespace slamot {
namespace {

/// Sums stay within the range of their types; who has two explanations above this cannot tell them apart.
constexpr double largest_log_weight = 500;

/// Clusters of one object, or of one detection: most of them, where things are sparse. At most one pair is made in each,
/// so that they are summed at once.
class Stars {
  public:
    Stars(const AssociationProblem& problem, bool wanted)
        : problem_(problem),
          detections_of_(static_cast<std::size_t>(problem.objects()), 0),
          star_(static_cast<std::size_t>(problem.detections()), wanted) {
        if (!wanted) {
            are_all_ = problem.candidates() == 0;
            return;
        }
        for (int c = 0; c < problem.candidates(); ++c) ++detectionsOf(c);
        // An object that two detections want is the middle of a star if neither wants another.
        for (int d = 0; d < problem.detections(); ++d) {
            if (problem.candidatesOf(d) < 2) continue;
            for (int c = problem.first(d); c < problem.first(d + 1); ++c)
                if (detectionsOf(c) != 1) detectionsOf(c) = entangled;
        }
        for (int d = 0; d < problem.detections(); ++d) {
            for (int c = problem.first(d); c < problem.first(d + 1); ++c) {
                if (detectionsOf(c) != entangled) continue;
                star_[static_cast<std::size_t>(d)] = false;
                are_all_ = false;
            }
        }
    }

    bool have(int detection) const { return star_[static_cast<std::size_t>(detection)]; }
    bool areAll() const { return are_all_; }

    void sum(const std::vector<double>& log_ratios, AssociationMarginals& out) const;

  private:
    static constexpr int entangled = -1;
    int& detectionsOf(int c) {
        return detections_of_[static_cast<std::size_t>(problem_.candidate(c).object)];
    }
    int detectionsOf(int c) const {
        return detections_of_[static_cast<std::size_t>(problem_.candidate(c).object)];
    }

    const AssociationProblem& problem_;
    std::vector<int> detections_of_;  ///< by object
    std::vector<char> star_;          ///< by detection
    bool are_all_ = true;
};

void Stars::sum(const std::vector<double>& log_ratios, AssociationMarginals& out) const {
    const auto missed = [&](int c) -> double& {
        return out.missed[static_cast<std::size_t>(problem_.candidate(c).object)];
    };
    // Around an object `missed` collects what all its pairs weigh, first.
    for (int d = 0; d < problem_.detections(); ++d) {
        if (!have(d)) continue;
        const int first = problem_.first(d), end = problem_.first(d + 1);
        double sum = 1;
        for (int c = first; c < end; ++c) {
            double& weight = out.pair[static_cast<std::size_t>(c)];
            weight = std::exp(std::min(log_ratios[static_cast<std::size_t>(c)], largest_log_weight));
            sum += weight;
        }
        ++out.states;
        if (end - first == 1) missed(first) += out.pair[static_cast<std::size_t>(first)];
        if (end - first < 2) continue;
        for (int c = first; c < end; ++c) {
            out.pair[static_cast<std::size_t>(c)] /= sum;
            missed(c) = 1 - out.pair[static_cast<std::size_t>(c)];
        }
        out.none[static_cast<std::size_t>(d)] = 1 / sum;
        out.log_sum += std::log(sum);
    }
    for (int d = 0; d < problem_.detections(); ++d) {
        if (!have(d) || problem_.candidatesOf(d) != 1) continue;
        const int c = problem_.first(d);
        double& pair = out.pair[static_cast<std::size_t>(c)];
        const double sum = missed(c);
        out.none[static_cast<std::size_t>(d)] = (detectionsOf(c) == 1 ? 1 : sum - pair) / sum;
        pair /= sum;
    }
    for (std::size_t o = 0; o < out.missed.size(); ++o) {
        if (out.missed[o] <= 1) continue;
        out.log_sum += std::log(out.missed[o]);
        out.missed[o] = 1 / out.missed[o];
    }
}

PairGraph graphOf(const AssociationProblem& problem, const Cluster& cluster,
                  const std::vector<double>& ratios) {
    PairGraph graph;
    graph.rows = static_cast<int>(cluster.detections.size());
    graph.columns = static_cast<int>(cluster.objects.size());
    for (int row = 0; row < graph.rows; ++row) {
        const int detection = cluster.detections[static_cast<std::size_t>(row)];
        graph.first.push_back(static_cast<int>(graph.edges.size()));
        for (int c = problem.first(detection); c < problem.first(detection + 1); ++c) {
            const auto object =
                std::lower_bound(cluster.objects.begin(), cluster.objects.end(), problem.candidate(c).object);
            graph.edges.push_back({row, static_cast<int>(object - cluster.objects.begin()),
                                   std::min(ratios[static_cast<std::size_t>(c)], largest_log_weight)});
        }
    }
    graph.first.push_back(static_cast<int>(graph.edges.size()));
    return graph;
}

}  // namespace

AssociationMarginals associationMarginals(const AssociationProblem& problem, const DetectionModel& model,
                                          int state_budget) {
    return associationMarginals(problem, logPairRatios(problem, model), state_budget);
}

AssociationMarginals associationMarginals(const AssociationProblem& problem,
                                          const std::vector<double>& log_ratios, int state_budget) {
    AssociationMarginals out;
    out.pair.resize(static_cast<std::size_t>(problem.candidates()));
    out.none.assign(static_cast<std::size_t>(problem.detections()), 1.0);
    out.missed.assign(static_cast<std::size_t>(problem.objects()), 1.0);
    const Stars stars(problem, state_budget > 0);
    stars.sum(log_ratios, out);
    if (stars.areAll()) return out;
    for (const Cluster& cluster : clusters(problem)) {
        if (stars.have(cluster.detections.front())) continue;
        const PairGraph graph = graphOf(problem, cluster, log_ratios);
        std::optional<PairMarginals> found = exactMarginals(graph, state_budget);
        if (found) {
            out.states += found->cost;
        } else {
            found = loopyMarginals(graph);
            out.rounds += found->cost;
            ++out.approximated;
        }
        out.log_sum += found->log_sum;
        for (int row = 0; row < graph.rows; ++row) {
            const int detection = cluster.detections[static_cast<std::size_t>(row)];
            out.none[static_cast<std::size_t>(detection)] = found->none[static_cast<std::size_t>(row)];
            std::copy(found->edge.begin() + graph.first[static_cast<std::size_t>(row)],
                      found->edge.begin() + graph.first[static_cast<std::size_t>(row) + 1],
                      out.pair.begin() + problem.first(detection));
        }
        for (const int object : cluster.objects) out.missed[static_cast<std::size_t>(object)] = 1;
        for (const int detection : cluster.detections)
            for (int c = problem.first(detection); c < problem.first(detection + 1); ++c)
                out.missed[static_cast<std::size_t>(problem.candidate(c).object)] -=
                    out.pair[static_cast<std::size_t>(c)];
    }
    for (double& missed : out.missed) missed = std::max(missed, 0.0);  // round-off
    return out;
}

}  // namespace slamot
