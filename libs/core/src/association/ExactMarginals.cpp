// Rows are decided one after the other. All that later rows need to know of earlier ones is which objects are
// taken, and only of those objects they can still reach: that is the state. Weights summed over all ways into
// a state (forward) and out of it (backward) give the marginals. So the cost is the number of sets of open
// objects, not of hypotheses: it is small for long chains and for full clusters of up to about ten objects.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "PairGraph.h"

namespace slamot {
namespace {

using Mask = std::uint64_t;
/// For its range: weights of states differ by the product of many likelihood ratios.
using Weight = long double;

/// The edge of a row that is decided, or none of them (taken 0).
struct Option {
    Mask taken;
    Weight weight;
    int edge;
};

struct Stage {
    int row;
    std::vector<Option> options;
    Weight log_scale;  ///< weights are relative to the exponential of this
    Mask open;         ///< objects that matter to later stages
};

/// The next row is the one that leaves the fewest objects open. Each object has a bit from its first row to
/// its last; nothing is given when more than 64 are open at a time.
std::optional<std::vector<Stage>> stages(const PairGraph& graph) {
    std::vector<int> rows_left(static_cast<std::size_t>(graph.columns), 0);
    for (const auto& edge : graph.edges) ++rows_left[static_cast<std::size_t>(edge.column)];
    std::vector<Mask> bit(rows_left.size(), 0);
    std::vector<char> done(static_cast<std::size_t>(graph.rows), 0);
    const auto edgesOf = [&graph](int row, const auto& visit) {
        for (int e = graph.first[static_cast<std::size_t>(row)];
             e < graph.first[static_cast<std::size_t>(row) + 1]; ++e)
            visit(e, static_cast<std::size_t>(graph.edges[static_cast<std::size_t>(e)].column));
    };

    std::vector<Stage> out;
    Mask open = 0;
    while (static_cast<int>(out.size()) < graph.rows) {
        int next = -1, fewest = std::numeric_limits<int>::max();
        for (int row = 0; row < graph.rows; ++row) {
            if (done[static_cast<std::size_t>(row)]) continue;
            int opened = 0;  // minus those closed
            edgesOf(row, [&](int, std::size_t o) { opened += (bit[o] == 0) - (rows_left[o] == 1); });
            if (opened >= fewest) continue;
            next = row;
            fewest = opened;
        }
        done[static_cast<std::size_t>(next)] = 1;

        Stage stage{next, {}, 0, 0};
        Weight largest = 0;  // log weight of the heaviest option: weights are taken relative to it
        edgesOf(next, [&](int e, std::size_t) {
            largest = std::max<Weight>(largest, graph.edges[static_cast<std::size_t>(e)].log_weight);
        });
        stage.log_scale = largest;
        stage.options.push_back({0, std::exp(-largest), -1});
        bool room = true;
        edgesOf(next, [&](int e, std::size_t o) {
            if (bit[o] == 0) bit[o] = ~open & (open + 1);  // the lowest that is free
            room = room && bit[o] != 0;
            open |= bit[o];
            const Weight weight = std::exp(graph.edges[static_cast<std::size_t>(e)].log_weight - largest);
            stage.options.push_back({bit[o], weight, e});
        });
        if (!room) return std::nullopt;
        edgesOf(next, [&](int, std::size_t o) {
            if (--rows_left[o] == 0) open &= ~bit[o];
        });
        stage.open = open;
        out.push_back(std::move(stage));
    }
    return out;
}

/// Sets of open objects that are taken, ascending, and weights of the ways into and out of each.
struct States {
    std::vector<Mask> taken;
    std::vector<Weight> in, out;

    std::size_t find(Mask mask) const {
        return static_cast<std::size_t>(std::lower_bound(taken.begin(), taken.end(), mask) - taken.begin());
    }
};

/// Returns what they summed to.
Weight normalise(std::vector<Weight>& weights) {
    Weight sum = 0;
    for (const Weight w : weights) sum += w;
    for (Weight& w : weights) w /= sum;
    return sum;
}

/// Adds the log of the factor by which the sum over all ways has grown.
States advance(const States& from, const Stage& stage, Weight& log_sum) {
    std::vector<std::pair<Mask, Weight>> ways;
    for (std::size_t s = 0; s < from.taken.size(); ++s)
        for (const Option& option : stage.options)
            if (!(from.taken[s] & option.taken))
                ways.emplace_back((from.taken[s] | option.taken) & stage.open, from.in[s] * option.weight);
    std::stable_sort(ways.begin(), ways.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    States to;
    for (const auto& [mask, weight] : ways) {
        if (to.taken.empty() || to.taken.back() != mask) {
            to.taken.push_back(mask);
            to.in.push_back(0);
        }
        to.in.back() += weight;
    }
    log_sum += stage.log_scale + std::log(normalise(to.in));
    return to;
}

}  // namespace

std::optional<PairMarginals> exactMarginals(const PairGraph& graph, int state_budget) {
    PairMarginals result;
    result.edge.assign(graph.edges.size(), 0);
    result.none.assign(static_cast<std::size_t>(graph.rows), 0);
    if (state_budget <= 0) return std::nullopt;
    const std::optional<std::vector<Stage>> path = stages(graph);
    if (!path) return std::nullopt;

    std::vector<States> states{{{0}, {1}, {}}};
    Weight log_sum = 0;
    for (const Stage& stage : *path) {
        states.push_back(advance(states.back(), stage, log_sum));
        result.cost += static_cast<int>(states.back().taken.size());
        if (result.cost > state_budget) return std::nullopt;
    }
    states.back().out = {1};
    result.log_sum = static_cast<double>(log_sum);

    for (std::size_t i = path->size(); i-- > 0;) {
        const Stage& stage = (*path)[i];
        States& from = states[i];
        const States& to = states[i + 1];
        from.out.assign(from.taken.size(), 0);
        std::vector<Weight> by_option(stage.options.size(), 0);
        for (std::size_t s = 0; s < from.taken.size(); ++s) {
            for (std::size_t o = 0; o < stage.options.size(); ++o) {
                const Option& option = stage.options[o];
                if (from.taken[s] & option.taken) continue;
                const Weight onward =
                    option.weight * to.out[to.find((from.taken[s] | option.taken) & stage.open)];
                from.out[s] += onward;
                by_option[o] += from.in[s] * onward;
            }
        }
        normalise(from.out);
        normalise(by_option);
        result.none[static_cast<std::size_t>(stage.row)] = static_cast<double>(by_option[0]);
        for (std::size_t o = 1; o < by_option.size(); ++o)
            result.edge[static_cast<std::size_t>(stage.options[o].edge)] = static_cast<double>(by_option[o]);
    }
    return result;
}

}  // namespace slamot
