#pragma once
// One cluster as the sums over its pairings see it: a pairing weighs the product of its edges' weights.
#include <optional>
#include <vector>

namespace slamot {

struct PairGraph {
    struct Edge {
        int row, column;  ///< detection and object, numbered within the cluster
        double log_weight;
    };
    int rows = 0, columns = 0;
    std::vector<Edge> edges;  ///< ordered by row
    std::vector<int> first;   ///< edges of a row are [first[row], first[row + 1])
};

/// Probabilities over all pairings: of each edge, and of each row to have none.
struct PairMarginals {
    std::vector<double> edge, none;
    double log_sum = 0;  ///< log of the sum of all pairings' weights; the pairing of none weighs 1
    int cost = 0;  ///< states or rounds
};

/// By sums over sets of objects already taken; nothing when that needs more than `state_budget` states.
std::optional<PairMarginals> exactMarginals(const PairGraph& graph, int state_budget);

/// By loopy belief propagation: exact where the graph has no cycles. The sum is Bethe's approximation.
PairMarginals loopyMarginals(const PairGraph& graph);

}  // namespace slamot
