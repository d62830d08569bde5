#include "Matchings.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>

#include "slamot/core/association/Assignment.h"

namespace slamot::eval {
namespace {

/// Prices of the objects from the best matching, by duality: a pair's two prices are at least what it saves,
/// and exactly that if it is in the best matching; an object outside of it has none. So any other matching
/// saves less than the best by what its pairs' prices exceed their savings, plus the prices of objects it
/// leaves out.
std::vector<double> pricesOf(const PairSet& pairs, const PairSet& best, std::size_t objects) {
    std::vector<double> price(objects, 0);
    std::vector<const PlacedGain*> best_of(objects, nullptr);
    for (const PlacedGain& g : best) best_of[g.target] = &g;
    // Prices of tracks rise until no target would rather have another (Bellman and Ford): in as many rounds
    // as there are pairs, since the matching is the best.
    for (std::size_t round = 0; round <= best.size(); ++round)
        for (const PlacedGain& g : pairs) {
            const PlacedGain* own = best_of[g.target];
            const double left = own ? own->saved - price[own->track] : 0;
            price[g.track] = std::max(price[g.track], g.saved - left);
        }
    for (const PlacedGain& g : best) price[g.target] = g.saved - price[g.track];
    return price;
}

}  // namespace

double sumOf(const PairSet& pairs) {
    double sum = 0;
    for (const PlacedGain& g : pairs) sum += g.saved;
    return sum;
}

PairSet bestMatching(const PairSet& pairs, std::size_t objects) {
    if (pairs.size() == 1) return pairs;
    const auto n = static_cast<Eigen::Index>(objects);
    Eigen::MatrixXd cost = Eigen::MatrixXd::Zero(n, n);
    std::vector<std::vector<const PlacedGain*>> of(objects);
    for (const PlacedGain& g : pairs) {
        cost(static_cast<Eigen::Index>(g.target), static_cast<Eigen::Index>(g.track)) = -g.saved;
        of[g.target].push_back(&g);
    }
    const Assignment assignment = optimalAssignment(cost);
    PairSet matching;
    for (std::size_t i = 0; i < objects; ++i)
        for (const PlacedGain* g : of[i])
            if (assignment.column_of_row[i] == static_cast<int>(g->track)) matching.push_back(*g);
    return matching;
}

std::vector<PairSet> matchingsWithin(double gap, const PairSet& pairs, const PairSet& best,
                                     std::size_t objects, std::size_t most) {
    const std::vector<double> price = pricesOf(pairs, best, objects);
    std::map<std::size_t, PairSet> by_target;
    for (const PlacedGain& g : pairs) by_target[g.target].push_back(g);
    double untaken = 0;  // prices of tracks not chosen so far
    std::vector<bool> taken(objects, false), counted(objects, false);
    for (const PlacedGain& g : pairs) {
        if (!counted[g.track]) untaken += price[g.track];
        counted[g.track] = true;
    }
    std::vector<PairSet> matchings;
    PairSet chosen;
    std::size_t looked_at = 0;
    const std::size_t most_looked_at = 16 * most;
    // `short_by`: of the targets decided so far.
    const std::function<void(std::map<std::size_t, PairSet>::const_iterator, double)> decide =
        [&](auto target, double short_by) {
            if (short_by > gap || ++looked_at > most_looked_at || matchings.size() > most) return;
            if (target == by_target.end()) {
                if (short_by + untaken <= gap) matchings.push_back(chosen);
                return;
            }
            for (const PlacedGain& g : target->second) {
                if (taken[g.track]) continue;
                taken[g.track] = true;
                untaken -= price[g.track];
                chosen.push_back(g);
                decide(std::next(target), short_by + price[g.target] + price[g.track] - g.saved);
                chosen.pop_back();
                untaken += price[g.track];
                taken[g.track] = false;
            }
            decide(std::next(target), short_by + price[target->first]);
        };
    decide(by_target.begin(), 0);
    if (looked_at > most_looked_at || matchings.size() > most) matchings.clear();
    return matchings;
}

}  // namespace slamot::eval
