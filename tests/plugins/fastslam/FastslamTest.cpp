#include "conformance/Conformance.h"
#include "support/Expect.h"
#include "support/Scenes.h"

namespace slamot {
namespace fastslam_test {

conformance::Options version(const std::string& number) {
    conformance::Options options;
    options.plugin = "fastslam";
    options.kind = conformance::Kind::sampled;
    options.config = "[fastslam]\nversion = " + number + "\n";
    options.nees_exemption = "particles die out: what the filter has forgotten it takes for certain";
    return options;
}

std::shared_ptr<Estimator> oneParticle(const std::string& number) {
    const auto estimator = conformance::createSubject(version(number));
    estimator->initialize(Config::fromText("[fastslam]\nversion = " + number + "\nparticles = 1\n"));
    return estimator;
}

// One particle at a known pose is one Kalman filter for each landmark.
TEST(FastslamTest, OneParticleThatStandsStillByHand) {
    for (const std::string number : {"1", "2"}) {
        const auto estimator = oneParticle(number);
        estimator->start({});
        // First sight at (2, 0): P = diag(0.01, 2^2 * 0.0004).
        estimator->update(test::detectionsAt(0, {test::seen({}, {2, 0}, ObjectKind::landmark, 0)}));
        LandmarkEstimate landmark = estimator->landmarks().at(0);
        EXPECT_TRUE(test::near(landmark.mean, Vector2(2, 0), 1e-14));
        EXPECT_TRUE(test::near(landmark.covariance, Matrix2(Vector2(0.01, 0.0016).asDiagonal()), 1e-14));
        // Again, 0.1 m farther: S = diag(0.02, 0.0008), half of the gain each.
        const auto report =
            estimator->update(test::detectionsAt(0, {test::seen({}, {2.1, 0}, ObjectKind::landmark, 0)}));
        EXPECT_NEAR(report.innovations.at(0).nis, 0.01 / 0.02, 1e-12);
        landmark = estimator->landmarks().at(0);
        EXPECT_TRUE(test::near(landmark.mean, Vector2(2.05, 0), 1e-14));
        EXPECT_TRUE(test::near(landmark.covariance, Matrix2(Vector2(0.005, 0.0008).asDiagonal()), 1e-14));
        EXPECT_TRUE(estimator->robot().covariance.isZero(0));
    }
}

}  // namespace fastslam_test
}  // namespace slamot

SLAMOT_CONFORMANCE_SUITE(fastslam, slamot::fastslam_test::version("2"));
SLAMOT_CONFORMANCE_SUITE(fastslam_1, slamot::fastslam_test::version("1"));
