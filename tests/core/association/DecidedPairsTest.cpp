#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "AssociationProblems.h"
#include "slamot/core/association/DecidedPairs.h"

namespace slamot {
namespace decided_pairs_test {

using testing::ElementsAre;
using testing::IsEmpty;

/// Candidates of given residuals along the first row. All share an error of variance `common` along it, and
/// each has 0.01 of its own; second rows are zero with variance 0.01.
struct Shared {
    Shared(const std::vector<std::pair<int, int>>& pairs, const std::vector<double>& residuals, double common)
        : problem(problemOf(pairs)) {
        const auto n = static_cast<Eigen::Index>(pairs.size());
        innovations.nu = Eigen::VectorXd::Zero(2 * n);
        innovations.S = Eigen::MatrixXd::Zero(2 * n, 2 * n);
        for (Eigen::Index i = 0; i < n; ++i) {
            innovations.nu(2 * i) = residuals[static_cast<std::size_t>(i)];
            innovations.S(2 * i + 1, 2 * i + 1) = 0.01;
            for (Eigen::Index j = 0; j < n; ++j) innovations.S(2 * i, 2 * j) = common + (i == j ? 0.01 : 0);
        }
        model.detection_probability.assign(static_cast<std::size_t>(problem.objects()), 0.8);
        model.clutter_density.assign(static_cast<std::size_t>(problem.detections()), 0.001);
    }
    static AssociationProblem problemOf(const std::vector<std::pair<int, int>>& pairs) {
        std::vector<Candidate> candidates;
        int detections = 0, objects = 0;
        for (const auto& [d, o] : pairs) {
            candidates.push_back({d, o, 0, 0});
            detections = std::max(detections, d + 1);
            objects = std::max(objects, o + 1);
        }
        return {detections, objects, candidates};
    }
    std::vector<int> decided(const std::vector<int>& pairs, double probability) {
        const std::vector<Matrix2> R(static_cast<std::size_t>(problem.detections()),
                                     0.01 * Matrix2::Identity());
        const std::vector<bool> may_be_rivals(static_cast<std::size_t>(problem.objects()), true);
        return decidedPairs(problem, innovations, pairs, {model, R, may_be_rivals}, probability);
    }

    AssociationProblem problem;
    test::MatrixInnovations innovations;
    DetectionModel model;
};

/// 0.8 N(nu; 0, S) of a pair of variance `s` along the first row.
double weight(double nu, double s) {
    return 0.8 * std::exp(-0.5 * nu * nu / s) / (2 * pi * std::sqrt(s * 0.01));
}

TEST(DecidedPairs, OnePairAgainstClutterInAsManyPlacesAsItsGateHolds) {
    // Variance 4.01 in x, noise 0.01: sqrt(401) = 20 places along x, one along y.
    Shared alone({{0, 0}}, {1}, 4);
    const double mine = weight(1, 4.01), others = 0.001 * std::sqrt(401), p = mine / (mine + others);
    EXPECT_THAT(alone.decided({0}, p - 1e-6), ElementsAre(0));
    EXPECT_THAT(alone.decided({0}, p + 1e-6), IsEmpty());
}

TEST(DecidedPairs, AnotherObjectElsewhereWeighs) {
    // Its expected detection is 3 m away, thirty times the noise.
    Shared two({{0, 0}, {0, 1}}, {1, -2}, 4);
    const double mine = weight(1, 4.01), others = 0.001 * std::sqrt(401) + weight(-2, 4.01),
                 p = mine / (mine + others);
    EXPECT_THAT(two.decided({0}, p - 1e-6), ElementsAre(0));
    EXPECT_THAT(two.decided({0}, p + 1e-6), IsEmpty());
}

TEST(DecidedPairs, AnotherObjectAtTheSamePlaceDoesNot) {
    // chi^2_2(0.999) = 13.8: in noise of 0.1 m places are told apart from 0.372 m on.
    Shared near({{0, 0}, {0, 1}}, {1, 1.37}, 4), far({{0, 0}, {0, 1}}, {1, 1.38}, 4);
    EXPECT_THAT(near.decided({0}, 0.9), ElementsAre(0));
    EXPECT_THAT(far.decided({0}, 0.9), IsEmpty());
}

TEST(DecidedPairs, WhatIsSureTellsWhichOfTwoItIs) {
    // Detection 0 fits two objects alike. Detection 1 is sure of its own (clutter is rare for it), and says
    // that the robot is off by 1: given that, object 1, expected at -1, is out of the question.
    Shared both({{0, 0}, {0, 1}, {1, 2}}, {1, -1, 1}, 4);
    EXPECT_THAT(both.decided({0}, 0.9), IsEmpty());
    EXPECT_THAT(both.decided({0, 2}, 0.9), ElementsAre(2, 0));
}

TEST(DecidedPairs, AnObjectThatIsTakenIsNoRival) {
    // Detection 1 is surely of object 1, so detection 0 is not.
    Shared both({{0, 0}, {0, 1}, {1, 1}}, {0.3, -0.3, 0}, 0.05);
    EXPECT_THAT(both.decided({0}, 0.9), IsEmpty());
    EXPECT_THAT(both.decided({0, 2}, 0.9), ElementsAre(2, 0));
}

TEST(DecidedPairs, SeveralThatFitInOneWayCountTogether) {
    // Each alone is less likely than the clutter in its wide gate; the second, given the first, fits to 0.1
    // m.
    Shared both({{0, 0}, {1, 1}}, {3, 3.05}, 4);
    for (double& c : both.model.clutter_density) c = 0.02;
    const double first = weight(3, 4.01) / (0.02 * std::sqrt(401));
    ASSERT_LT(first, 1);
    const double variance = 4.01 - 16 / 4.01, expected = 3 * 4 / 4.01;
    const double second = weight(3.05 - expected, variance) / (0.02 * std::sqrt(variance / 0.01));
    const double odds = first * second, p = odds / (1 + odds);
    ASSERT_GT(p, 0.5);
    EXPECT_THAT(both.decided({0}, 0.5), IsEmpty());
    EXPECT_THAT(both.decided({0, 1}, p - 1e-6), ElementsAre(0, 1));
    EXPECT_THAT(both.decided({0, 1}, p + 1e-6), IsEmpty());
}

TEST(DecidedPairs, TwoThatFitAnotherPairOfObjectsAsWellDoNot) {
    // Objects 0 and 1, 3 m aside 2 and 3: two constellations alike, the robot in the middle between them.
    Shared both({{0, 0}, {0, 2}, {1, 1}, {1, 3}}, {1.5, -1.5, 1.5, -1.5}, 4);
    EXPECT_THAT(both.decided({0, 2}, 0.6), IsEmpty());
    // Without the second constellation's other half it is a matter of the first.
    Shared half({{0, 0}, {0, 2}, {1, 1}}, {1.5, -1.5, 1.5}, 4);
    EXPECT_THAT(half.decided({0, 2}, 0.6), ElementsAre(2, 0));
}

}  // namespace decided_pairs_test
}  // namespace slamot
