#include "conformance/Conformance.h"
#include "support/Expect.h"
#include "support/Scenes.h"

namespace slamot {
namespace ufastslam_test {

conformance::Options sampled() {
    conformance::Options options;
    options.plugin = "ufastslam";
    options.kind = conformance::Kind::sampled;
    options.nees_exemption = "particles die out: what the filter has forgotten it takes for certain";
    return options;
}

// Sigma points of range 2 m and bearing 0 with deviations 0.1 m and 0.02 rad: alpha sqrt(2) of them away,
// weights 1 / (2 alpha^2 2). The bearing's points lie 2 (1 - cos(0.9 sqrt(2) 0.02)) nearer.
TEST(UfastslamTest, FirstSightByHand) {
    const auto estimator = conformance::createSubject(sampled());
    estimator->initialize(Config::fromText("[ufastslam]\nparticles = 1\n"));
    estimator->start({});
    estimator->update(test::detectionsAt(0, {test::seen({}, {2, 0}, ObjectKind::landmark, 0)}));
    const double reach = 0.9 * std::sqrt(2.0), weight = 0.5 / (reach * reach);
    const double nearer = 2 * (1 - std::cos(reach * 0.02)), shift = -2 * weight * nearer;
    const double centre = 1 - 1 / 0.81 + 1 - 0.81 + 2;
    const LandmarkEstimate landmark = estimator->landmarks().at(0);
    EXPECT_TRUE(test::near(landmark.mean, Vector2(2 + shift, 0), 1e-14));
    const double variance_x = centre * shift * shift +
                              weight * (std::pow(reach * 0.1 - shift, 2) + std::pow(-reach * 0.1 - shift, 2) +
                                        2 * std::pow(-nearer - shift, 2));
    EXPECT_NEAR(landmark.covariance(0, 0), variance_x, 1e-15);
    EXPECT_NEAR(landmark.covariance(1, 1), 2 * weight * std::pow(2 * std::sin(reach * 0.02), 2), 1e-15);
}

}  // namespace ufastslam_test
}  // namespace slamot

SLAMOT_CONFORMANCE_SUITE(ufastslam, slamot::ufastslam_test::sampled());
