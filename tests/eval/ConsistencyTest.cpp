#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "Builders.h"
#include "slamot/core/random/RandomStream.h"
#include "slamot/eval/Consistency.h"

namespace slamot::eval {
namespace consistency_test {

TEST(Nees, ByHand) {
    // P = [4 2; 2 2], P^-1 = 1/4 [2 -2; -2 4], e = (2, 1): (8 - 8 + 4) / 4 = 1.
    Matrix2 P;
    P << 4, 2, 2, 2;
    const SquaredError n = nees(Vector2(2, 1), P);
    EXPECT_NEAR(n.value, 1, 1e-14);
    EXPECT_EQ(n.dimension, 2);
}

TEST(Nees, IsNotDividedByTheDimension) {
    const SquaredError n = nees(Vector3(1, 2, 3), Matrix3::Identity());
    EXPECT_NEAR(n.value, 14, 1e-13);
    EXPECT_EQ(n.dimension, 3);
}

TEST(Nees, LeavesOutWhatIsKnownExactly) {
    // y without variance: only x^2 / 4 + theta^2 / 0.01 = 1 + 4.
    const SquaredError n = nees(Vector3(2, 9, 0.2), Vector3(4, 0, 0.01).asDiagonal().toDenseMatrix());
    EXPECT_NEAR(n.value, 5, 1e-13);
    EXPECT_EQ(n.dimension, 2);
    EXPECT_EQ(nees(Vector3(1, 1, 1), Matrix3::Zero()).dimension, 0);
}

TEST(Nees, LeavesOutACombinationKnownExactly) {
    // x and y are one variable: P = s^2 [1 1; 1 1] with s = 2. Along (1, 1)/sqrt(2) the variance is 2 s^2 = 8
    // and the error of (3, 1) is 4 / sqrt(2): 8 / 8 = 1.
    const SquaredError n = nees(Vector2(3, 1), Matrix2::Constant(4));
    EXPECT_NEAR(n.value, 1, 1e-13);
    EXPECT_EQ(n.dimension, 1);
}

TEST(Nees, UnitsDoNotWeigh) {
    // The same case in metres and radians or in micrometres and radians.
    Matrix2 P;
    P << 1e-12, 5e-7, 5e-7, 1;
    const SquaredError n = nees(Vector2(1e-6, 1), P);
    // Scaled: correlation 0.5, e = (1, 1): 2 (1 - 0.5) / (1 - 0.25) = 4/3.
    EXPECT_NEAR(n.value, 4.0 / 3, 1e-12);
    EXPECT_EQ(n.dimension, 2);
}

TEST(Nees, ADirectionOfRoundOffDoesNotCount) {
    // Along (1, 1) / sqrt(2) the variance is 2 - 1e-11, along (1, -1) / sqrt(2) it is 1e-11: 5e-12 of the
    // other, less than the 1e-9 that estimators are held to. Only the first counts: e = (1e-3, -1e-3) has
    // nothing along it.
    Matrix2 P;
    P << 1, 1 - 1e-11, 1 - 1e-11, 1;
    const SquaredError n = nees(Vector2(1e-3, -1e-3), P);
    EXPECT_EQ(n.dimension, 1);
    EXPECT_NEAR(n.value, 0, 1e-12);
    // At 1e-6 it is a variance: 2e-6 / 1e-6 = 2.
    P << 1, 1 - 1e-6, 1 - 1e-6, 1;
    EXPECT_NEAR(nees(Vector2(1e-3, -1e-3), P).value, 2, 1e-8);
}

TEST(ChiSquare, AgreesWithPrintedTables) {
    // Tables of the chi-square distribution, to the digits printed there.
    const Band three = chiSquareBand(0.95, 3);
    EXPECT_NEAR(three.low, 0.216, 5e-4);
    EXPECT_NEAR(three.high, 9.348, 5e-4);
    // Mean of 50 runs of 2 dimensions: Bar-Shalom's example, [74.2, 129.6] / 50 = [1.48, 2.59].
    const Band fifty = chiSquareBand(0.95, 100, 50);
    EXPECT_NEAR(fifty.low, 1.484, 1e-3);
    EXPECT_NEAR(fifty.high, 2.591, 1e-3);
}

TEST(NeesSummary, ByHand) {
    // Two dimensions: band [0.0506, 7.378], quantile 5.991. One dimension: band [0.00098, 5.024],
    // quantile 3.841.
    const NeesSeries series{
        {at(0), {0, 0}}, {at(1), {1, 2}}, {at(2), {6.5, 2}}, {at(3), {8, 2}}, {at(4), {4.5, 1}}};
    const auto s = summariseNees(series, 0.95);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->steps, 4);
    EXPECT_EQ(s->without_variance, 1);
    EXPECT_EQ(s->reduced, 1);
    EXPECT_DOUBLE_EQ(s->mean_dimension, 7.0 / 4);
    EXPECT_DOUBLE_EQ(s->average, 20.0 / 4);
    EXPECT_DOUBLE_EQ(s->median, 5.5);
    EXPECT_DOUBLE_EQ(s->inside, 3.0 / 4);
    EXPECT_DOUBLE_EQ(s->coverage, 1.0 / 4);
    EXPECT_NEAR(s->band.high, 7.378, 5e-4);
}

TEST(NeesSummary, ZeroCovarianceIsUnknown) {
    const auto s = summariseNees({{at(0), {0, 0}}, {at(1), {0, 0}}}, 0.95);
    EXPECT_FALSE(s);
    EXPECT_THAT(s.whyAbsent(), testing::HasSubstr("zero, which means it is not known"));
}

TEST(ConsistencyOverRuns, ByHand) {
    // Two runs, two dimensions. Band of the mean of 2: chi-square of 4 degrees over 2, [0.484, 11.143] / 2.
    // Step 0: (1 + 3) / 2 = 2 inside. Step 1: (9 + 4) / 2 = 6.5 above 5.57. Step 2: (0.1 + 0.2) / 2 below
    // 0.242.
    const NeesSeries one{{at(0), {1, 2}}, {at(1), {9, 2}}, {at(2), {0.1, 2}}};
    const NeesSeries two{{at(0), {3, 2}}, {at(1), {4, 2}}, {at(2), {0.2, 2}}};
    const auto c = consistencyOverRuns({one, two}, 0.95);
    ASSERT_TRUE(c);
    EXPECT_EQ(c->runs, 2);
    ASSERT_EQ(c->steps.size(), 3u);
    EXPECT_DOUBLE_EQ(c->steps[0].mean, 2);
    EXPECT_DOUBLE_EQ(c->steps[1].mean, 6.5);
    EXPECT_NEAR(c->steps[0].band.low, 0.484 / 2, 5e-4);
    EXPECT_NEAR(c->steps[0].band.high, 11.143 / 2, 5e-4);
    EXPECT_DOUBLE_EQ(c->inside, 1.0 / 3);
    EXPECT_DOUBLE_EQ(c->above, 1.0 / 3);
    EXPECT_DOUBLE_EQ(c->below, 1.0 / 3);
    EXPECT_DOUBLE_EQ(c->average, 17.3 / 6);
    EXPECT_DOUBLE_EQ(c->mean_dimension, 2);
}

TEST(ConsistencyOverRuns, ARunWithoutAStepDoesNotCountThere) {
    const NeesSeries one{{at(0), {0, 0}}, {at(1), {2, 3}}}, two{{at(1), {4, 3}}, {at(2), {5, 3}}};
    const auto c = consistencyOverRuns({one, two}, 0.95);
    ASSERT_TRUE(c);
    ASSERT_EQ(c->steps.size(), 2u);
    EXPECT_EQ(c->steps[0].runs, 2);
    EXPECT_EQ(c->steps[1].runs, 1);
    EXPECT_NEAR(c->steps[1].band.high, 9.348, 5e-4);
}

TEST(ConsistencyOverRuns, RightCovariancesAreInside) {
    // 400 independent steps of 20 runs with errors really drawn from P: the number inside is binomial(400,
    // 0.95), standard deviation 4.4 of 400: four of them are 0.044.
    const Matrix3 L = (Matrix3() << 2, 0, 0, 1, 0.5, 0, -0.3, 0.1, 0.05).finished();
    std::vector<NeesSeries> runs;
    for (std::uint32_t run = 0; run < 20; ++run) {
        RandomStream random(11, RandomPurpose::test, run);
        NeesSeries series;
        for (int k = 0; k < 400; ++k) {
            const Vector3 e = L * Vector3(random.normal(), random.normal(), random.normal());
            series.push_back({at(k), nees(e, Matrix3(L * L.transpose()))});
        }
        runs.push_back(series);
    }
    const auto c = consistencyOverRuns(runs, 0.95);
    ASSERT_TRUE(c);
    EXPECT_NEAR(c->inside, 0.95, 0.044);
    // Mean of 8000 chi-square(3): standard deviation sqrt(6 / 8000) = 0.027; four of them.
    EXPECT_NEAR(c->average, 3, 0.11);
}

}  // namespace consistency_test
}  // namespace slamot::eval
