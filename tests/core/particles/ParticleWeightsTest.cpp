#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "slamot/core/particles/ParticleCloud.h"
#include "slamot/core/particles/ParticleWeights.h"

namespace slamot {
namespace particle_weights_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

double sum(const ParticleWeights& weights) {
    double out = 0;
    for (int i = 0; i < weights.count(); ++i) out += weights[i];
    return out;
}

TEST(ParticleWeightsTest, MultipliesAndNormalises) {
    ParticleWeights weights(3);
    EXPECT_TRUE(weights.multiply({std::log(1.0), std::log(2.0), std::log(5.0)}));
    EXPECT_NEAR(weights[0], 0.125, 1e-15);
    EXPECT_NEAR(weights[2], 0.625, 1e-15);
    // The weights before count: 0.125 2 : 0.25 2 : 0.625 0.4 = 1 : 2 : 1.
    EXPECT_TRUE(weights.multiply({std::log(2.0), std::log(2.0), std::log(0.4)}));
    EXPECT_NEAR(weights[1], 0.5, 1e-15);
    EXPECT_NEAR(weights.effectiveCount(), 1 / (0.0625 + 0.25 + 0.0625), 1e-12);
    EXPECT_EQ(weights.best(), 1);
}

TEST(ParticleWeightsTest, LikelihoodsOfAnySizeAndNone) {
    ParticleWeights weights(4);
    EXPECT_TRUE(weights.multiply({-1e6, -1e6 + std::log(3.0), -infinity, std::nan("")}));
    EXPECT_NEAR(weights[0], 0.25, 1e-9);
    EXPECT_NEAR(weights[1], 0.75, 1e-9);
    EXPECT_NEAR(weights[2] + weights[3], 0, 1e-300);
    EXPECT_NEAR(sum(weights), 1, 1e-12);

    const double before = weights[1];
    EXPECT_FALSE(weights.multiply({-infinity, std::nan(""), -infinity, -infinity}));
    EXPECT_EQ(weights[1], before);
    // What had no weight may gain some again.
    EXPECT_TRUE(weights.multiply({0, 0, 5000, 0}));
    EXPECT_NEAR(weights[2], 1, 1e-12);
}

// Moments of particles of which one has next to no weight: nothing of it is left, and what is left is
// definite.
TEST(ParticleWeightsTest, NextToNoWeightIsNone) {
    ParticleParameters parameters;
    parameters.count = 2;
    parameters.resample_below = 0;
    for (double log_factor = -200; log_factor > -760; log_factor -= 7) {
        ParticleCloud cloud(parameters, {});
        cloud.start({}, 1);
        cloud.place(0, {1, 2, 3});
        cloud.place(1, {1.013, 1.994, 3.002});
        ASSERT_TRUE(cloud.weigh({0, log_factor}));
        const Matrix3 P = cloud.robot().covariance;
        const Vector3 apart(0.013, -0.006, 0.002);
        const double w = cloud.weights()[1];
        EXPECT_EQ(w > 0, log_factor > -230) << log_factor;
        EXPECT_TRUE(w == 0 ? P.isZero(0) : (P - w * apart * apart.transpose()).norm() <= 1e-9 * P.norm())
            << log_factor;
    }
}

std::vector<int> childrenOf(const std::vector<int>& parents, int count) {
    std::vector<int> out(static_cast<std::size_t>(count), 0);
    for (const int parent : parents) ++out.at(static_cast<std::size_t>(parent));
    return out;
}

class Resamplings : public testing::TestWithParam<Resampling> {};

TEST_P(Resamplings, ChildrenAreWithinOneOfTheirShareAndRightOnAverage) {
    constexpr int n = 20, draws = 4000;
    ParticleWeights weights(n);
    std::vector<double> factors;
    for (int i = 0; i < n; ++i) factors.push_back(std::log(1.0 + i * i));
    ASSERT_TRUE(weights.multiply(factors));

    std::vector<double> mean(n, 0);
    for (int k = 0; k < draws; ++k) {
        RandomStream random(7, RandomPurpose::test, 0, static_cast<std::uint32_t>(k));
        const std::vector<int> parents = weights.resampled(GetParam(), random);
        ASSERT_EQ(parents.size(), static_cast<std::size_t>(n));
        EXPECT_TRUE(std::is_sorted(parents.begin(), parents.end()));
        const std::vector<int> children = childrenOf(parents, n);
        for (int i = 0; i < n; ++i) {
            const double share = n * weights[i];
            EXPECT_GE(children[static_cast<std::size_t>(i)], std::floor(share) - 1e-9);
            EXPECT_LE(children[static_cast<std::size_t>(i)], std::floor(share) + 1 + 1e-9);
            mean[static_cast<std::size_t>(i)] += children[static_cast<std::size_t>(i)] / double(draws);
        }
    }
    // A count that is one of two neighbours has a standard deviation of at most 1/2: 4.5 of them for the
    // mean, one false alarm in 7,000 such tests of 20 counts.
    for (int i = 0; i < n; ++i)
        EXPECT_NEAR(mean[static_cast<std::size_t>(i)], n * weights[i], 4.5 * 0.5 / std::sqrt(double(draws)));
}

TEST_P(Resamplings, OneThatHasAllTheWeightHasAllTheChildren) {
    ParticleWeights weights(5);
    ASSERT_TRUE(weights.multiply({-1e9, -1e9, 0, -1e9, -1e9}));
    RandomStream random(1, RandomPurpose::test);
    EXPECT_EQ(weights.resampled(GetParam(), random), std::vector<int>(5, 2));
}

INSTANTIATE_TEST_SUITE_P(Both, Resamplings, testing::Values(Resampling::systematic, Resampling::residual),
                         [](const auto& each) {
                             return each.param == Resampling::systematic ? "systematic" : "residual";
                         });

// Weights are equal after resampling; what is told goes on with the heaviest particle's history all the same.
TEST_P(Resamplings, TheHeaviestsHeirIsTheBest) {
    ParticleParameters parameters;
    parameters.count = 10;
    parameters.resampling = GetParam();
    parameters.resample_below = 1;
    for (int heaviest = 0; heaviest < 10; ++heaviest) {
        ParticleCloud cloud(parameters, {});
        cloud.start({}, 1);
        std::vector<double> log_likelihoods(10, 0.0);
        log_likelihoods.at(static_cast<std::size_t>(heaviest)) = 1;
        ASSERT_TRUE(cloud.weigh(log_likelihoods));
        const std::vector<int> parents = cloud.resample();
        ASSERT_EQ(parents.size(), 10u);
        const int best = cloud.weights().best();
        EXPECT_EQ(cloud.weights()[best], cloud.weights()[0]);
        EXPECT_EQ(parents.at(static_cast<std::size_t>(best)), heaviest);
    }
}

TEST(ThinnedTest, KeepsByWeightAndWithoutChance) {
    const auto expectKept = [](const std::vector<double>& weights, int most,
                               const std::vector<KeptParticle>& expected) {
        const std::vector<KeptParticle> kept = thinned(weights, most);
        ASSERT_EQ(kept.size(), expected.size());
        for (std::size_t k = 0; k < kept.size(); ++k) {
            EXPECT_EQ(kept[k].index, expected[k].index);
            EXPECT_EQ(kept[k].weight, expected[k].weight);
        }
    };
    const std::vector<double> weights{0.5, 0.25, 0.125, 0.125};
    expectKept(weights, 4, {{0, 0.5}, {1, 0.25}, {2, 0.125}, {3, 0.125}});
    // The comb's teeth are at 1/4 and 3/4, at 1/2, and at odd eighths.
    expectKept(weights, 2, {{0, 0.5}, {1, 0.5}});
    expectKept(weights, 1, {{0, 1}});
    expectKept(std::vector<double>(8, 0.125), 4, {{0, 0.25}, {2, 0.25}, {4, 0.25}, {6, 0.25}});
    expectKept({0, 0.75, 0.25, 0, 0}, 4, {{1, 0.75}, {2, 0.25}});
    expectKept({}, 3, {});
}

}  // namespace particle_weights_test
}  // namespace slamot
