#include <cmath>

#include "conformance/Conformance.h"
#include "slamot/core/random/RandomStream.h"
#include "support/Expect.h"

namespace slamot {
namespace mrpt_kf_slam_test {

std::shared_ptr<Estimator> make(const std::string& plugin) {
    conformance::Options options;
    options.plugin = plugin;
    auto estimator = conformance::createSubject(options);
    estimator->initialize(Config::fromText(
        plugin == "ekf_slamot"
            ? "[ekf_slamot]\nconsistency = classic\n[ekf_slamot.outliers]\ntreatment = accept\n"
            : ""));
    return estimator;
}

/// Landmarks at a circle's corners, seen from `robot` with noise. Floats, as MRPT keeps them.
DetectionSet look(const Pose2& robot, Stamp stamp, RandomStream& random) {
    DetectionSet set;
    set.stamp = stamp;
    auto& seen = std::get<RangeBearingSet>(set.measurements);
    seen.sensors.emplace_back();
    seen.sensors[0].pose = {0.25, 0.5, 0.125};
    for (int i = 0; i < 8; ++i) {
        const Vector2 p(9 * std::cos(i), 9 * std::sin(i));
        const Vector2 local = inverse(robot * seen.sensors[0].pose) * p;
        RangeBearingDetection detection;
        detection.range = static_cast<float>(local.norm() + random.normal(0, 0.25));
        detection.bearing = static_cast<float>(std::atan2(local.y(), local.x()) + random.normal(0, 0.03125));
        detection.covariance = Vector2(0.0625, 0.03125 * 0.03125).asDiagonal();
        detection.kind = ObjectKind::landmark;
        detection.source = SourceId{i};
        seen.detections.push_back(detection);
    }
    return set;
}

// MRPT's filter and the classic core of ekf_slamot are the same mathematics, so two programs that share no
// line of code must agree: to rounding, over a drive that starts somewhere and moves before it first looks.
TEST(MrptKfSlamTest, IsTheClassicEkf) {
    const auto peer = make("mrpt_kf_slam"), ekf = make("ekf_slamot");
    Start start;
    start.pose.mean = {1, -2, 3};
    start.pose.covariance = Vector3(0.01, 0.02, 0.005).asDiagonal();
    peer->start(start);
    ekf->start(start);
    RandomStream random(7, RandomPurpose::test);
    Pose2 robot = start.pose.mean;
    Stamp now = start.stamp;
    for (int step = 0; step < 60; ++step) {
        OdometryIncrement odometry;
        odometry.t0 = now;
        odometry.t1 = now = later(now, 0.1);
        odometry.entry_seconds = 0.1;
        odometry.increment = {0.3, 0, 0.07};
        robot = robot * odometry.increment;
        for (const auto& estimator : {peer, ekf}) estimator->predict(odometry);
        ASSERT_TRUE(test::near(peer->robot().mean.vector(), ekf->robot().mean.vector(), 1e-9)) << step;
        if (step % 3 != 2) continue;
        const DetectionSet set = look(robot, now, random);
        for (const auto& estimator : {peer, ekf}) estimator->update(set);
        // MRPT's noise is a float and its gain comes from an inverse: 1e-9 of values of order one.
        ASSERT_TRUE(test::near(peer->robot().mean.vector(), ekf->robot().mean.vector(), 1e-9)) << step;
        ASSERT_TRUE(test::near(peer->robot().covariance, ekf->robot().covariance, 1e-9)) << step;
    }
    const auto theirs = peer->landmarks(), ours = ekf->landmarks();
    ASSERT_EQ(theirs.size(), 8u);
    for (std::size_t i = 0; i < theirs.size(); ++i) {
        EXPECT_EQ(theirs[i].source, ours[i].source);
        EXPECT_EQ(theirs[i].seen, 20);
        EXPECT_TRUE(test::near(theirs[i].mean, ours[i].mean, 1e-9)) << i;
        EXPECT_TRUE(test::near(theirs[i].covariance, ours[i].covariance, 1e-9)) << i;
    }
}

TEST(MrptKfSlamTest, TheSameLandmarkTwiceInAScanCountsOnce) {
    const auto peer = make("mrpt_kf_slam");
    peer->start({});
    RandomStream random(7, RandomPurpose::test);
    DetectionSet set = look({}, {}, random);
    auto& seen = std::get<RangeBearingSet>(set.measurements).detections;
    seen[1].source = seen[0].source;
    const UpdateReport report = peer->update(set);
    EXPECT_EQ(report.innovations[0].outcome, Outcome::initiated);
    EXPECT_EQ(report.innovations[1].outcome, Outcome::ignored);
    EXPECT_EQ(peer->landmarks().size(), 7u);
}

}  // namespace mrpt_kf_slam_test
}  // namespace slamot

slamot::conformance::Options mrptKfSlam() {
    slamot::conformance::Options options;
    options.nees_exemption =
        "The textbook EKF: its linearisation takes the heading of the whole map for something it can learn.";
    return options;
}

SLAMOT_CONFORMANCE_SUITE(mrpt_kf_slam, mrptKfSlam());
