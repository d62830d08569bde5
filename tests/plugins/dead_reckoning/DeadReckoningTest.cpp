#include "conformance/Conformance.h"
#include "support/Expect.h"

namespace slamot {
namespace dead_reckoning_test {

std::shared_ptr<Estimator> deadReckoning(const std::string& config) {
    conformance::Options options;
    options.plugin = "dead_reckoning";
    auto estimator = conformance::createSubject(options);
    estimator->initialize(Config::fromText(config));
    return estimator;
}

TEST(DeadReckoningTest, OneStepByHand) {
    const auto estimator = deadReckoning(
        "[motion]\nmodel = differential\nspeed_std = 0.1\nturn_rate_std_deg = 10\n"
        "[dead_reckoning]\nnoise_scale = 2\n");
    Start start;
    start.pose.mean = {1, 2, pi / 2};
    start.pose.covariance(2, 2) = 0.04;
    estimator->start(start);

    OdometryIncrement odometry;
    odometry.t0 = start.stamp;
    odometry.t1 = later(start.stamp, 0.1);
    odometry.velocity = BodyVelocity{2, 0, 0.5};
    odometry.entry_seconds = 0.1;
    estimator->predict(odometry);

    // 0.2 m along the old heading, +y; then a turn of 0.05.
    const PoseGaussian robot = estimator->robot();
    EXPECT_TRUE(test::near(robot.mean.vector(), Vector3(1, 2.2, pi / 2 + 0.05), 1e-15));
    // dx/dtheta = -0.2, so x gets 0.2^2 * 0.04 = 0.0016 and its covariance with theta is -0.2 * 0.04 =
    // -0.008. Noise, doubled: y gets 2 (0.1 m/s * 0.1 s)^2 = 2e-4, theta 2 (10 deg/s * 0.1 s)^2.
    Matrix3 P = Matrix3::Zero();
    P(0, 0) = 0.0016;
    P(0, 2) = P(2, 0) = -0.008;
    P(1, 1) = 2e-4;
    P(2, 2) = 0.04 + 2 * radians(1) * radians(1);
    EXPECT_TRUE(test::near(robot.covariance, P, 1e-15));
}

TEST(DeadReckoningTest, DetectionsAreCountedAndNotUsed) {
    const auto estimator = deadReckoning("");
    estimator->start({});
    DetectionSet set;
    auto& seen = std::get<RangeBearingSet>(set.measurements);
    seen.sensors.emplace_back();
    seen.detections.resize(2);
    seen.detections[0].range = seen.detections[1].range = 5;
    const UpdateReport report = estimator->update(set);
    ASSERT_EQ(report.innovations.size(), 2u);
    EXPECT_EQ(report.innovations[1].outcome, Outcome::ignored);
    EXPECT_EQ(estimator->estimate().health.detections_ignored, 2);
    EXPECT_EQ(estimator->robot().mean.vector(), Vector3(0, 0, 0));
}

}  // namespace dead_reckoning_test
}  // namespace slamot

SLAMOT_CONFORMANCE_SUITE(dead_reckoning, slamot::conformance::Options{});
