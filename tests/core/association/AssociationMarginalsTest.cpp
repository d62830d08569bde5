#include <gtest/gtest.h>

#include <algorithm>

#include "AssociationProblems.h"
#include "slamot/core/association/AssociationMarginals.h"

namespace slamot {
namespace association_marginals_test {

constexpr int unlimited = 1 << 30, loopy = 0;

/// All pairings, each with its weight.
AssociationMarginals bruteForce(const AssociationProblem& problem, const DetectionModel& model) {
    const std::vector<double> ratios = logPairRatios(problem, model);
    AssociationMarginals out;
    out.pair.assign(static_cast<std::size_t>(problem.candidates()), 0);
    double total = 0;
    test::forEachPairing(problem, test::allDetections(problem), [&](const std::vector<int>& pairs) {
        double weight = 1;
        for (const int c : pairs) weight *= std::exp(ratios[static_cast<std::size_t>(c)]);
        total += weight;
        for (const int c : pairs) out.pair[static_cast<std::size_t>(c)] += weight;
    });
    for (double& p : out.pair) p /= total;
    out.log_sum = std::log(total);
    out.none.assign(static_cast<std::size_t>(problem.detections()), 1);
    out.missed.assign(static_cast<std::size_t>(problem.objects()), 1);
    for (int c = 0; c < problem.candidates(); ++c) {
        out.none[static_cast<std::size_t>(problem.candidate(c).detection)] -=
            out.pair[static_cast<std::size_t>(c)];
        out.missed[static_cast<std::size_t>(problem.candidate(c).object)] -=
            out.pair[static_cast<std::size_t>(c)];
    }
    return out;
}

double largestDifference(const AssociationMarginals& a, const AssociationMarginals& b) {
    double largest = 0;
    const auto compare = [&largest](const std::vector<double>& x, const std::vector<double>& y) {
        ASSERT_EQ(x.size(), y.size());
        for (std::size_t i = 0; i < x.size(); ++i) {
            ASSERT_GE(x[i], 0);
            largest = std::max(largest, std::abs(x[i] - y[i]));
        }
    };
    compare(a.pair, b.pair);
    compare(a.none, b.none);
    compare(a.missed, b.missed);
    return largest;
}

/// A problem whose pairs have given odds against clutter and miss: P_D N / (c (1 - P_D)) with P_D 0.5 and
/// c 1.
struct Odds {
    AssociationProblem problem;
    DetectionModel model;
};
Odds withOdds(int detections, int objects, const std::vector<std::tuple<int, int, double>>& odds) {
    std::vector<Candidate> candidates;
    for (const auto& [d, o, value] : odds) candidates.push_back({d, o, 1, std::log(value)});
    return {{detections, objects, candidates},
            {std::vector<double>(static_cast<std::size_t>(objects), 0.5),
             std::vector<double>(static_cast<std::size_t>(detections), 1.0), 1}};
}

TEST(AssociationMarginals, ExactAgreesWithBruteForce) {
    RandomStream random(31, RandomPurpose::test);
    for (int trial = 0; trial < 300; ++trial) {
        const AssociationProblem problem = test::randomProblem(random, 1 + trial % 6, 1 + trial % 5, 0.6);
        const DetectionModel model = test::randomModel(random, problem);
        const AssociationMarginals found = associationMarginals(problem, model, unlimited);
        ASSERT_EQ(found.approximated, 0);
        // Sums of up to a few thousand positive terms, and 1 minus a few of them.
        const AssociationMarginals all = bruteForce(problem, model);
        ASSERT_LT(largestDifference(found, all), 1e-12) << trial;
        ASSERT_NEAR(found.log_sum, all.log_sum, 1e-12 * (1 + std::abs(all.log_sum))) << trial;
    }
}

TEST(AssociationMarginals, OnePairByHand) {
    const Odds one = withOdds(1, 1, {{0, 0, 3.0}});
    const AssociationMarginals found = associationMarginals(one.problem, one.model, unlimited);
    EXPECT_NEAR(found.pair[0], 0.75, 1e-15);
    EXPECT_NEAR(found.none[0], 0.25, 1e-15);
    EXPECT_NEAR(found.missed[0], 0.25, 1e-15);
    EXPECT_NEAR(found.log_sum, std::log(4.0), 1e-15);
}

TEST(AssociationMarginals, TwoByTwoByHand) {
    // Odds 1 everywhere: 1 + 4 + 2 hypotheses of equal weight, each pair in 1 + 1 of them. Belief
    // propagation's fixed point is mu = nu = 1 / (1 + nu), the golden section g, so a pair has mu nu / (1 +
    // mu nu), and Bethe's sum is ((1 + 2 g) / (1 + g^2))^4 = 6.85 instead of 7.
    const Odds odds = withOdds(2, 2, {{0, 0, 1.0}, {0, 1, 1.0}, {1, 0, 1.0}, {1, 1, 1.0}});
    const AssociationMarginals exact = associationMarginals(odds.problem, odds.model, unlimited);
    for (const double p : exact.pair) EXPECT_NEAR(p, 2.0 / 7.0, 1e-15);
    EXPECT_NEAR(exact.log_sum, std::log(7.0), 1e-15);
    const AssociationMarginals approximate = associationMarginals(odds.problem, odds.model, loopy);
    EXPECT_EQ(approximate.approximated, 1);
    // Rounds end when marginals move by less than 1e-9; each shrinks the error by more than two here.
    for (const double p : approximate.pair) EXPECT_NEAR(p, (5 - std::sqrt(5.0)) / 10, 1e-9);
    const double g = (std::sqrt(5.0) - 1) / 2;
    EXPECT_NEAR(approximate.log_sum, 4 * std::log((1 + 2 * g) / (1 + g * g)), 1e-8);
}

TEST(AssociationMarginals, BeliefPropagationIsExactWithoutCycles) {
    RandomStream random(32, RandomPurpose::test);
    int approximated = 0;
    for (int trial = 0; trial < 200; ++trial) {
        // A tree over up to 6 detections and 6 objects: each new node hangs on an earlier one of the other
        // kind.
        std::vector<std::pair<int, int>> edges{{0, 0}};
        int detections = 1, objects = 1;
        for (int n = 0; n < 10; ++n) {
            if (random.uniform() < 0.5 && detections < 6)
                edges.emplace_back(detections++, static_cast<int>(random.uniform(0, objects)));
            else if (objects < 6)
                edges.emplace_back(static_cast<int>(random.uniform(0, detections)), objects++);
        }
        std::sort(edges.begin(), edges.end());
        std::vector<Candidate> candidates;
        for (const auto& [d, o] : edges) candidates.push_back({d, o, 1, random.uniform(-4, 3)});
        const AssociationProblem problem(detections, objects, candidates);
        const DetectionModel model = test::randomModel(random, problem);
        const AssociationMarginals found = associationMarginals(problem, model, loopy);
        approximated += found.approximated;
        // Messages are final after as many rounds as the tree is long; the last one moves nothing.
        const AssociationMarginals all = bruteForce(problem, model);
        ASSERT_LT(largestDifference(found, all), 1e-12) << trial;
        ASSERT_NEAR(found.log_sum, all.log_sum, 1e-12 * (1 + std::abs(all.log_sum))) << trial;
    }
    EXPECT_EQ(approximated, 200);
}

/// What both the exact marginals and the fixed point of belief propagation must lie between. The probability
/// that v stays alone in G is p_v(G) = 1 / (1 + sum_w psi_vw p_w(G - v)), for every v and G: unrolled, a tree
/// of the self-avoiding walks from v (Godsil, Matchings and walks in graphs, J. Graph Theory 5, 1981; Bayati
/// et al., Simple deterministic approximation algorithms for counting matchings, STOC 2007). Belief
/// propagation evaluates the same formula on the tree of all walks without an immediate return. p falls with
/// every further branch, so the larger tree with the upper ends below gives a lower end for both, the smaller
/// one an upper end. Ends below the last level are 0 and 1.
class WalkBounds {
  public:
    struct Range {
        double low, high;
    };
    WalkBounds(const AssociationProblem& problem, const std::vector<double>& ratios) {
        const int first_object = problem.detections();
        edges_.resize(static_cast<std::size_t>(first_object + problem.objects()));
        for (int c = 0; c < problem.candidates(); ++c) {
            const int d = problem.candidate(c).detection, o = first_object + problem.candidate(c).object;
            const double psi = std::exp(ratios[static_cast<std::size_t>(c)]);
            edges_[static_cast<std::size_t>(d)].emplace_back(o, psi);
            edges_[static_cast<std::size_t>(o)].emplace_back(d, psi);
        }
    }
    Range alone(int node, int levels) { return alone(node, std::vector<int>{}, levels); }
    /// psi p_v(G) p_w(G - v)
    Range pair(int detection, int object_node, double psi, int levels) {
        const Range v = alone(detection, levels), w = alone(object_node, {detection}, levels);
        return {psi * v.low * w.low, psi * v.high * w.high};
    }

  private:
    Range alone(int node, std::vector<int> walk, int levels) {
        if (levels == 0) return {0, 1};
        double largest = 1, smallest = 1;
        const int came_from = walk.empty() ? -1 : walk.back();
        walk.push_back(node);
        for (const auto& [next, psi] : edges_[static_cast<std::size_t>(node)]) {
            if (next == came_from) continue;
            const Range below = alone(next, walk, levels - 1);
            largest += psi * below.high;
            if (std::find(walk.begin(), walk.end(), next) == walk.end()) smallest += psi * below.low;
        }
        return {1 / largest, 1 / smallest};
    }

    std::vector<std::vector<std::pair<int, double>>> edges_;
};

TEST(AssociationMarginals, BeliefPropagationStaysWithinTheBoundsOfWalks) {
    RandomStream random(33, RandomPurpose::test);
    double width = 0;
    int values = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const AssociationProblem problem = test::randomProblem(random, 5, 5, 0.45);
        DetectionModel model = test::randomModel(random, problem);
        for (double& p : model.detection_probability) p *= 0.5;  // weaker ties: bounds that say something
        const std::vector<double> ratios = logPairRatios(problem, model);
        WalkBounds bounds(problem, ratios);
        const AssociationMarginals exact = bruteForce(problem, model),
                                   found = associationMarginals(problem, model, loopy);
        const auto hold = [&](const WalkBounds::Range& range, double truth, double value) {
            // Rounds end at a change of 1e-9.
            ASSERT_GE(truth, range.low - 1e-12);
            ASSERT_LE(truth, range.high + 1e-12);
            ASSERT_GE(value, range.low - 1e-8);
            ASSERT_LE(value, range.high + 1e-8);
            width += range.high - range.low;
            ++values;
        };
        for (int d = 0; d < 5; ++d)
            hold(bounds.alone(d, 8), exact.none[static_cast<std::size_t>(d)],
                 found.none[static_cast<std::size_t>(d)]);
        for (int o = 0; o < 5; ++o)
            hold(bounds.alone(5 + o, 8), exact.missed[static_cast<std::size_t>(o)],
                 found.missed[static_cast<std::size_t>(o)]);
        for (int c = 0; c < problem.candidates(); ++c)
            hold(bounds.pair(problem.candidate(c).detection, 5 + problem.candidate(c).object,
                             std::exp(ratios[static_cast<std::size_t>(c)]), 8),
                 exact.pair[static_cast<std::size_t>(c)], found.pair[static_cast<std::size_t>(c)]);
    }
    EXPECT_LT(width / values, 0.01);  // they do say something
}

TEST(AssociationMarginals, ErrorOfBeliefPropagationOnEntangledClusters) {
    RandomStream random(34, RandomPurpose::test);
    double largest = 0, sum = 0;
    int count = 0;
    for (int trial = 0; trial < 500; ++trial) {
        const AssociationProblem problem = test::randomProblem(random, 5, 5, 0.8);
        const DetectionModel model = test::randomModel(random, problem);
        const AssociationMarginals exact = associationMarginals(problem, model, unlimited),
                                   found = associationMarginals(problem, model, loopy);
        for (std::size_t c = 0; c < exact.pair.size(); ++c) {
            sum += std::abs(exact.pair[c] - found.pair[c]);
            largest = std::max(largest, std::abs(exact.pair[c] - found.pair[c]));
            ++count;
        }
    }
    // No theory: measured on these very problems, 0.0060 on average and 0.164 at most.
    EXPECT_LT(sum / count, 0.0061);
    EXPECT_LT(largest, 0.165);
}

TEST(AssociationMarginals, ALongChainIsExactAtLittleCost) {
    // Detection d goes with objects d and d + 1: one object is open at a time, so two states a stage. Belief
    // propagation is exact here, too: no cycles.
    std::vector<std::tuple<int, int, double>> odds;
    for (int d = 0; d < 150; ++d)
        for (const int o : {d, d + 1}) odds.emplace_back(d, o, 1.0 + 0.01 * d + 2.0 * (o - d));
    const Odds chain = withOdds(150, 151, odds);
    const AssociationMarginals exact = associationMarginals(chain.problem, chain.model, 300);
    EXPECT_EQ(exact.approximated, 0);
    EXPECT_LE(exact.states, 300);
    EXPECT_LT(largestDifference(exact, associationMarginals(chain.problem, chain.model, loopy)), 1e-8);
}

TEST(AssociationMarginals, AboveTheBudgetItApproximates) {
    std::vector<std::tuple<int, int, double>> odds;
    for (int d = 0; d < 8; ++d)
        for (int o = 0; o < 8; ++o) odds.emplace_back(d, o, 2.0);
    odds.emplace_back(8, 8, 3.0);  // a cluster of its own
    const Odds full = withOdds(9, 9, odds);
    const AssociationMarginals exact = associationMarginals(full.problem, full.model, 2000),
                               found = associationMarginals(full.problem, full.model, 100);
    EXPECT_EQ(exact.approximated, 0);
    EXPECT_EQ(found.approximated, 1);
    EXPECT_NEAR(found.pair.back(), 0.75, 1e-15);
    // All alike: sum_k k C(8,k)^2 k! 2^k / (8 sum_k C(8,k)^2 k! 2^k) / 8 of each pair, by counting.
    double weight = 1, total = 1, pairs = 0;
    for (int k = 1; k <= 8; ++k) {
        weight *= 2.0 * (9 - k) * (9 - k) / k;
        total += weight;
        pairs += k * weight;
    }
    for (int c = 0; c < 64; ++c)
        EXPECT_NEAR(exact.pair[static_cast<std::size_t>(c)], pairs / total / 64, 1e-14);
}

TEST(AssociationMarginals, ExtremeOddsStayFinite) {
    // Three detections want one object, each e^400 times more than to be clutter: a third each.
    std::vector<Candidate> candidates{{0, 0, 1, 400}, {1, 0, 1, 400}, {2, 0, 1, 400}};
    const AssociationProblem problem(3, 2, candidates);
    for (const int budget : {unlimited, loopy}) {
        const AssociationMarginals found = associationMarginals(problem, {{0.5, 0.5}, {1, 1, 1}, 1}, budget);
        for (const double p : found.pair) EXPECT_NEAR(p, 1.0 / 3.0, 1e-12);
        for (const double p : found.none) EXPECT_NEAR(p, 2.0 / 3.0, 1e-12);
        EXPECT_NEAR(found.missed[0], 0, 1e-12);
        EXPECT_EQ(found.missed[1], 1);
    }
}

TEST(AssociationMarginals, AnObjectThatCannotBeSeenIsMissed) {
    const AssociationProblem problem(1, 2, {{0, 0, 1, 0}, {0, 1, 1, 0}});
    for (const int budget : {unlimited, loopy}) {
        const AssociationMarginals found = associationMarginals(problem, {{0, 0.5}, {1}, 1}, budget);
        EXPECT_EQ(found.pair[0], 0);
        EXPECT_NEAR(found.pair[1], 0.5, 1e-12);
        EXPECT_EQ(found.missed[0], 1);
    }
}

}  // namespace association_marginals_test
}  // namespace slamot
