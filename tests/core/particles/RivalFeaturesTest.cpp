#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "slamot/core/particles/RivalFeatures.h"
#include "slamot/core/random/RandomStream.h"
#include "support/Expect.h"

namespace slamot {
namespace rival_features_test {

/// The same by going through all that may have happened: each feature is detected as none or one of the
/// sights, no sight is both's, and something is detected.
double byEnumeration(double first, double second, const std::vector<RivalSight>& sights) {
    const int n = static_cast<int>(sights.size());
    const auto at = [&](int s) { return sights[static_cast<std::size_t>(s)]; };
    double two = 0, one = 0;
    for (int a = -1; a < n; ++a)
        for (int b = -1; b < n; ++b) {
            if (a >= 0 && a == b) continue;
            two += (a < 0 ? 1 - first : at(a).first) * (b < 0 ? 1 - second : at(b).second);
        }
    const double largest = std::max(first, second);
    for (int s = -1; s < n; ++s) one += s < 0 ? 1 - largest : at(s).one;
    return std::log(one / largest) - std::log(two / (first + second - first * second));
}

TEST(RivalFeaturesTest, AgreesWithEnumerationWhicheverIsCalledFirst) {
    RandomStream random(1, RandomPurpose::test);
    for (int trial = 0; trial < 200; ++trial) {
        const double first = random.uniform(0.05, 0.95), second = random.uniform(0.05, 0.95);
        std::vector<RivalSight> sights, swapped;
        for (int s = 0; s < trial % 4; ++s) {
            const RivalSight sight{random.uniform(0, 20), random.uniform(0, 20), random.uniform(0, 20)};
            sights.push_back(sight);
            swapped.push_back({sight.second, sight.first, sight.one});
        }
        const double got = logOneAgainstTwo(first, second, sights);
        EXPECT_NEAR(got, byEnumeration(first, second, sights), 1e-10);
        EXPECT_NEAR(got, logOneAgainstTwo(second, first, swapped), 1e-10);
    }
}

// One detection that fits both alike speaks for one; two, one for each, for two, and the more so the surer
// detections are.
TEST(RivalFeaturesTest, OneDetectionSpeaksForOneAndTwoForTwo) {
    double before_one = 0, before_two = 0;
    for (const double p : {0.5, 0.7, 0.9}) {
        const double one = logOneAgainstTwo(p, p, {{50, 50, 50}});
        const double two = logOneAgainstTwo(p, p, {{50, 0.01, 25}, {0.01, 50, 25}});
        EXPECT_GT(one, before_one);
        EXPECT_LT(two, before_two);
        before_one = one;
        before_two = two;
    }
}

// Two estimates of one thing that agree are better than either; where they contradict, both are covered.
TEST(RivalFeaturesTest, FusedCoversWhatContradicts) {
    const GaussianPoint a{{1, 2}, 0.04 * Matrix2::Identity()}, same = a;
    GaussianPoint b = a;
    EXPECT_TRUE(test::near(fused(a, same).covariance, Matrix2(0.02 * Matrix2::Identity()), 1e-14));
    EXPECT_TRUE(test::near(fused(a, same).mean, a.mean, 1e-14));
    b.mean.x() += 2;
    const GaussianPoint both = fused(a, b);
    EXPECT_TRUE(test::near(both.mean, Vector2(2, 2), 1e-12));
    // Half of 2^2 / 0.08 times the covariance of two that agree.
    EXPECT_NEAR(both.covariance(0, 0), 25 * 0.02, 1e-12);
    EXPECT_GT(std::sqrt(both.covariance(0, 0)), 0.7);
    EXPECT_TRUE(test::near(fused(b, a).mean, both.mean, 1e-12));
}

}  // namespace rival_features_test
}  // namespace slamot
