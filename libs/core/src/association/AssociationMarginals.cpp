#include "slamot/core/association/AssociationMarginals.h"

#include <algorithm>

#include "PairGraph.h"

namespace slamot {
namespace {

/// Sums stay within the range of their types; who has two explanations above this cannot tell them apart.
constexpr double largest_log_weight = 500;

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
    for (const Cluster& cluster : clusters(problem)) {
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
    }
    for (int c = 0; c < problem.candidates(); ++c)
        out.missed[static_cast<std::size_t>(problem.candidate(c).object)] -=
            out.pair[static_cast<std::size_t>(c)];
    for (double& missed : out.missed) missed = std::max(missed, 0.0);  // round-off
    return out;
}

}  // namespace slamot
