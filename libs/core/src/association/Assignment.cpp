#include "slamot/core/association/Assignment.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

// Templates only: nothing of LEMON's library is linked.
#define LEMON_ONLY_TEMPLATES
#include <lemon/network_simplex.h>
#include <lemon/static_graph.h>

namespace slamot {
namespace {

bool allowed(double cost) {
    return cost != forbidden_pair;
}

/// Smallest and largest cost of the allowed pairs.
std::pair<double, double> costRange(const Eigen::MatrixXd& cost) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (Eigen::Index i = 0; i < cost.size(); ++i) {
        const double c = cost.data()[i];
        if (!allowed(c)) continue;
        if (!std::isfinite(c))
            throw std::invalid_argument(
                "optimalAssignment: a cost is NaN or -infinity, expected a finite cost or forbidden_pair");
        low = std::min(low, c);
        high = std::max(high, c);
    }
    return {low, high};
}

}  // namespace

// A minimum-cost flow of one unit per row: to a column along an allowed pair, or to a slack node at a price
// above any sum of pair costs, so that pairs are never given up for cost. The slack node fills the columns no
// row took.
Assignment optimalAssignment(const Eigen::MatrixXd& cost) {
    const int rows = static_cast<int>(cost.rows()), columns = static_cast<int>(cost.cols());
    Assignment result;
    result.column_of_row.assign(static_cast<std::size_t>(rows), -1);
    const auto [low, high] = costRange(cost);
    if (low > high) return result;  // empty, or all pairs forbidden

    // The solver adds up (largest arc cost) x (number of nodes): that must stay below 2^62.
    const int most_pairs = std::min(rows, columns);
    const double largest =
        std::min(std::exp2(50), std::floor(std::exp2(60) / (most_pairs + 1.0) / (rows + columns + 1.0)));
    const double scale = high > low ? largest / (high - low) : 0.0;
    const auto alone = static_cast<std::int64_t>(largest) * (most_pairs + 1);

    // Nodes: rows, columns, slack. Arcs in the order of their sources, as StaticDigraph wants them.
    std::vector<std::pair<int, int>> arcs;
    std::vector<std::int64_t> costs;
    const int slack = rows + columns;
    const auto add_arc = [&arcs, &costs](int from, int to, std::int64_t arc_cost) {
        arcs.emplace_back(from, to);
        costs.push_back(arc_cost);
    };
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c)
            if (allowed(cost(r, c)))
                add_arc(r, rows + c, static_cast<std::int64_t>(std::llround((cost(r, c) - low) * scale)));
        add_arc(r, slack, alone);
    }
    for (int c = 0; c < columns; ++c) add_arc(slack, rows + c, 0);

    using Graph = lemon::StaticDigraph;
    Graph graph;
    graph.build(rows + columns + 1, arcs.begin(), arcs.end());
    Graph::ArcMap<std::int64_t> arc_cost(graph), capacity(graph, 1);
    for (std::size_t i = 0; i < arcs.size(); ++i) arc_cost[Graph::arc(static_cast<int>(i))] = costs[i];
    Graph::NodeMap<std::int64_t> supply(graph);
    for (int i = 0; i < rows; ++i) supply[Graph::node(i)] = 1;
    for (int i = rows; i < slack; ++i) supply[Graph::node(i)] = -1;
    supply[Graph::node(slack)] = columns - rows;

    lemon::NetworkSimplex<Graph, std::int64_t, std::int64_t> solver(graph);
    solver.costMap(arc_cost).upperMap(capacity).supplyMap(supply);
    if (solver.run() != decltype(solver)::OPTIMAL)
        throw std::logic_error("optimalAssignment: the flow has no optimum, which cannot be");

    for (std::size_t i = 0; i < arcs.size(); ++i) {
        const auto [from, to] = arcs[i];
        if (from == slack || to == slack || solver.flow(Graph::arc(static_cast<int>(i))) == 0) continue;
        result.column_of_row[static_cast<std::size_t>(from)] = to - rows;
        ++result.pairs;
        result.cost += cost(from, to - rows);
    }
    return result;
}

}  // namespace slamot
