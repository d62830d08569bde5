#include "slamot/core/association/AssociationProblem.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>

namespace slamot {

AssociationProblem::AssociationProblem(int detections, int objects, std::vector<Candidate> candidates)
    : objects_(objects), candidates_(std::move(candidates)) {
    const auto key = [](const Candidate& c) { return std::make_tuple(c.detection, c.object); };
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
        const Candidate& c = candidates_[i];
        const bool inside =
            c.detection >= 0 && c.detection < detections && c.object >= 0 && c.object < objects;
        const bool ordered = i == 0 || key(candidates_[i - 1]) < key(c);
        if (!inside || !ordered || !std::isfinite(c.nis) || !std::isfinite(c.log_likelihood))
            throw std::invalid_argument(
                "AssociationProblem: candidate " + std::to_string(i) + " pairs detection " +
                std::to_string(c.detection) + " with object " + std::to_string(c.object) +
                ", expected finite candidates in order, each once, of " + std::to_string(detections) +
                " detections and " + std::to_string(objects) + " objects");
    }
    first_.assign(static_cast<std::size_t>(detections) + 1, 0);
    for (const Candidate& c : candidates_) ++first_[static_cast<std::size_t>(c.detection) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
}

std::vector<int> AssociationProblem::unambiguousFirst() const {
    std::vector<std::tuple<int, double, int>> order;
    for (int d = 0; d < detections(); ++d) {
        if (candidatesOf(d) == 0) continue;
        double best = candidate(first(d)).log_likelihood;
        for (int c = first(d); c < first(d + 1); ++c) best = std::max(best, candidate(c).log_likelihood);
        order.emplace_back(candidatesOf(d), -best, d);
    }
    std::sort(order.begin(), order.end());
    std::vector<int> out;
    for (const auto& [count, likelihood, detection] : order) out.push_back(detection);
    return out;
}

int Pairing::pairs() const {
    return static_cast<int>(candidate_of_detection.size()) -
           static_cast<int>(std::count(candidate_of_detection.begin(), candidate_of_detection.end(), -1));
}

std::vector<int> Pairing::objects(const AssociationProblem& problem) const {
    std::vector<int> out;
    for (const int c : candidate_of_detection) out.push_back(c < 0 ? -1 : problem.candidate(c).object);
    return out;
}

std::vector<Cluster> clusters(const AssociationProblem& problem) {
    // Union of the detections that share an object; the smallest number of a group is its root.
    std::vector<int> parent(static_cast<std::size_t>(problem.detections()));
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&parent](int d) {
        auto& of = parent;
        while (of[static_cast<std::size_t>(d)] != d)
            d = of[static_cast<std::size_t>(d)] =
                of[static_cast<std::size_t>(of[static_cast<std::size_t>(d)])];
        return d;
    };
    std::vector<std::pair<int, int>> by_object;  // (object, detection)
    for (int c = 0; c < problem.candidates(); ++c)
        by_object.emplace_back(problem.candidate(c).object, problem.candidate(c).detection);
    std::sort(by_object.begin(), by_object.end());
    for (std::size_t i = 1; i < by_object.size(); ++i) {
        if (by_object[i].first != by_object[i - 1].first) continue;
        const auto [low, high] = std::minmax({root(by_object[i].second), root(by_object[i - 1].second)});
        parent[static_cast<std::size_t>(high)] = low;
    }

    std::vector<Cluster> out;
    std::vector<int> number(parent.size(), -1);
    for (int d = 0; d < problem.detections(); ++d) {
        if (problem.candidatesOf(d) == 0) continue;
        int& n = number[static_cast<std::size_t>(root(d))];
        if (n < 0) {
            n = static_cast<int>(out.size());
            out.emplace_back();
        }
        out[static_cast<std::size_t>(n)].detections.push_back(d);
    }
    for (std::size_t i = 0; i < by_object.size(); ++i) {
        if (i > 0 && by_object[i].first == by_object[i - 1].first) continue;
        const int n = number[static_cast<std::size_t>(root(by_object[i].second))];
        out[static_cast<std::size_t>(n)].objects.push_back(by_object[i].first);
    }
    return out;
}

}  // namespace slamot
