#include "slamot/core/estimation/TargetMixture.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace target_mixture_test {

using test::near;

std::vector<TargetGaussian> modes(int count) {
    RandomStream random(5, RandomPurpose::test);
    std::vector<TargetGaussian> out;
    for (int i = 0; i < count; ++i)
        out.push_back({test::randomVector(random, 6), test::randomCovariance(random, 6)});
    return out;
}

// Second moments about 0 add up with the weights.
TEST(TargetMixtureTest, MomentsOfTheMixture) {
    const std::vector<TargetGaussian> parts = modes(3);
    const Eigen::Vector3d w(0.2, 0.5, 0.3);
    const TargetGaussian both = mixture(w, parts);
    Vector6 mean = Vector6::Zero();
    Matrix6 second = Matrix6::Zero();
    for (int i = 0; i < 3; ++i) {
        const TargetGaussian& part = parts[static_cast<std::size_t>(i)];
        mean += w(i) * part.mean;
        second += w(i) * (part.covariance + part.mean * part.mean.transpose());
    }
    EXPECT_TRUE(near(both.mean, mean, 1e-14));
    EXPECT_TRUE(near(both.covariance, second - mean * mean.transpose(), 1e-13));
}

TEST(TargetMixtureTest, MixingByHand) {
    const std::vector<TargetGaussian> parts = modes(2);
    const Eigen::Matrix2d p = (Eigen::Matrix2d() << 0.9, 0.1, 0.4, 0.6).finished();
    const MixedModes mixed = mixedModes(p, Eigen::Vector2d(0.25, 0.75), parts);
    // c = (0.25 * 0.9 + 0.75 * 0.4, 0.25 * 0.1 + 0.75 * 0.6).
    EXPECT_TRUE(near(mixed.probabilities, Eigen::Vector2d(0.525, 0.475), 1e-15));
    for (int j = 0; j < 2; ++j) {
        const Eigen::Vector2d w = Eigen::Vector2d(0.25 * p(0, j), 0.75 * p(1, j)) / mixed.probabilities(j);
        const TargetGaussian expected = mixture(w, parts);
        EXPECT_TRUE(near(mixed.modes[static_cast<std::size_t>(j)].mean, expected.mean, 1e-15));
        EXPECT_TRUE(near(mixed.modes[static_cast<std::size_t>(j)].covariance, expected.covariance, 1e-14));
    }
    // A mode that cannot be: the mixture as it was, and nothing is divided by 0.
    const Eigen::Matrix2d away = (Eigen::Matrix2d() << 1, 0, 1, 0).finished();
    const MixedModes left = mixedModes(away, Eigen::Vector2d(0.25, 0.75), parts);
    EXPECT_EQ(left.probabilities(1), 0);
    EXPECT_TRUE(left.modes[1].mean.allFinite());
}

}  // namespace target_mixture_test
}  // namespace slamot
