// Loopy belief propagation: J. L. Williams and R. A. Lau, Approximate evaluation of marginal association
// probabilities with belief propagation, IEEE Transactions on Aerospace and Electronic Systems 50(4), 2014,
// where it is proved to converge. Ends when no marginal moves by more than `steady`, or after `most_rounds`.
// The sum over all pairings from the messages is Bethe's (J. S. Yedidia, W. T. Freeman and Y. Weiss, IEEE
// Transactions on Information Theory 51(7), 2005): product over rows and columns of what each sums to given its
// messages, over that of the edges.
#include <algorithm>
#include <cmath>

#include "PairGraph.h"

namespace slamot {
namespace {

constexpr double steady = 1e-9;
constexpr int most_rounds = 1000;

/// out[e] = 1 + the sum of `value` over the other edges of e's group; `groups` lists edges. Never by
/// subtraction: one edge often weighs a million times all others.
void sumOfOthers(const std::vector<std::vector<std::size_t>>& groups, const std::vector<double>& value,
                 std::vector<double>& out) {
    for (const auto& group : groups) {
        double before = 1;
        for (const std::size_t e : group) {
            out[e] = before;
            before += value[e];
        }
        double after = 0;
        for (auto e = group.rbegin(); e != group.rend(); ++e) {
            out[*e] += after;
            after += value[*e];
        }
    }
}

}  // namespace

PairMarginals loopyMarginals(const PairGraph& graph) {
    const std::size_t count = graph.edges.size();
    std::vector<std::vector<std::size_t>> of_row(static_cast<std::size_t>(graph.rows)),
        of_column(static_cast<std::size_t>(graph.columns));
    std::vector<double> psi(count);
    for (std::size_t e = 0; e < count; ++e) {
        of_row[static_cast<std::size_t>(graph.edges[e].row)].push_back(e);
        of_column[static_cast<std::size_t>(graph.edges[e].column)].push_back(e);
        psi[e] = std::exp(graph.edges[e].log_weight);
    }

    // mu: what an object says to a detection, how much it wants it compared with its other choices; phi: what
    // a detection answers, how free it is.
    std::vector<double> mu(count, 0), phi(count, 1), wanted(count), others(count);
    PairMarginals result;
    result.edge.assign(count, 0);
    result.none.assign(of_row.size(), 1);
    for (double change = 1; change > steady && result.cost < most_rounds; ++result.cost) {
        for (std::size_t e = 0; e < count; ++e) wanted[e] = psi[e] * phi[e];
        sumOfOthers(of_column, wanted, others);
        for (std::size_t e = 0; e < count; ++e) mu[e] = psi[e] / others[e];
        sumOfOthers(of_row, mu, others);
        change = 0;
        for (std::size_t e = 0; e < count; ++e) {
            phi[e] = 1 / others[e];
            const double marginal = mu[e] / (others[e] + mu[e]);
            change = std::max(change, std::abs(marginal - result.edge[e]));
            result.edge[e] = marginal;
        }
    }
    for (std::size_t row = 0; row < of_row.size(); ++row) {
        double sum = 1;
        for (const std::size_t e : of_row[row]) sum += mu[e];
        result.none[row] = 1 / sum;
        result.log_sum += std::log(sum);
    }
    for (const auto& edges : of_column) {
        double sum = 1;
        for (const std::size_t e : edges) sum += psi[e] * phi[e];
        result.log_sum += std::log(sum);
    }
    for (std::size_t e = 0; e < count; ++e) result.log_sum -= std::log1p(mu[e] * phi[e]);
    return result;
}

}  // namespace slamot
