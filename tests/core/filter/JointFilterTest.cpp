#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "slamot/core/filter/JointFilter.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"
#include "support/Scenes.h"

namespace slamot {
namespace joint_filter_test {

using test::detectionsAt;
using test::near;
using test::odometry;
using test::seen;

constexpr auto landmark = ObjectKind::landmark;
constexpr auto mover = ObjectKind::mover;

/// A filter that begins at the origin at time 0, sure of it.
JointFilter started(const JointFilterParameters& parameters = {}) {
    JointFilter filter(parameters, {});
    filter.start({}, {});
    return filter;
}

std::vector<Outcome> outcomes(const UpdateReport& report) {
    std::vector<Outcome> out;
    for (const Innovation& innovation : report.innovations) out.push_back(innovation.outcome);
    return out;
}

RangeBearingDetection shifted(RangeBearingDetection detection, double range_error) {
    detection.range += range_error;
    return detection;
}

TEST(JointFilterTest, ObjectsStartAtFirstSight) {
    JointFilter filter = started();
    const auto report =
        filter.update(detectionsAt(0, {seen({}, {5, 0}, landmark, 7), seen({}, {0, -3}, mover, 7)}));
    EXPECT_EQ(outcomes(report), (std::vector<Outcome>{Outcome::initiated, Outcome::initiated}));
    EXPECT_TRUE(std::isnan(report.innovations[0].nis));
    const auto landmarks = filter.landmarks();
    const auto tracks = filter.tracks();
    ASSERT_EQ(landmarks.size(), 1u);
    ASSERT_EQ(tracks.size(), 1u);
    EXPECT_EQ(report.innovations[0].landmark, landmarks[0].id);
    EXPECT_EQ(report.innovations[1].track, tracks[0].id);
    EXPECT_EQ(landmarks[0].source.value, 7);
    EXPECT_EQ(landmarks[0].seen, 1);
    // 5 m ahead, bearing deviation 0.02: range shortened by 1 - 0.0004/2; variances 0.01 + (5*0.0004)^2/2 and
    // (0.02 * 4.999)^2.
    EXPECT_TRUE(near(landmarks[0].mean, Vector2(4.999, 0), 1e-14));
    EXPECT_TRUE(near(landmarks[0].covariance,
                     Matrix2(Vector2(0.01 + 2e-6, 0.0004 * 4.999 * 4.999).asDiagonal()), 1e-14));
    EXPECT_TRUE(near(tracks[0].mean.head<2>(), Vector2(0, -3 * 0.9998), 1e-14));
    EXPECT_TRUE(tracks[0].mean.tail<4>().isZero(0));
    EXPECT_TRUE(near(tracks[0].covariance.diagonal().tail<4>(), Eigen::Vector4d(9, 9, 4, 4), 1e-14));
}

TEST(JointFilterTest, WithKnownAssociationAloneDetectionsWithoutIdentityAreIgnored) {
    JointFilterParameters parameters;
    parameters.association.landmarks = LandmarkAssociation::known;
    parameters.association.movers = MoverAssociation::known;
    JointFilter filter = started(parameters);
    const auto report = filter.update(
        detectionsAt(0, {seen({}, {5, 0}, landmark, -1), seen({}, {5, 0}, ObjectKind::unknown, 3),
                         seen({}, {1, 1}, mover, -1)}));
    EXPECT_EQ(outcomes(report), std::vector<Outcome>(3, Outcome::ignored));
    EXPECT_TRUE(filter.landmarks().empty() && filter.tracks().empty());
    EXPECT_EQ(filter.state().dimension(), 3);
    EXPECT_EQ(report.innovations[2].detection, 2);
    EXPECT_TRUE(filter.update(detectionsAt(0, {})).innovations.empty());
}

TEST(JointFilterTest, ANewObjectTwiceInABatchStartsOnce) {
    JointFilter filter = started();
    const auto once = seen({}, {5, 0}, landmark, 1);
    const auto report = filter.update(
        detectionsAt(0, {once, shifted(once, 0.2), seen({}, {0, 3}, mover, 1), seen({}, {0, 3}, mover, 1)}));
    EXPECT_EQ(outcomes(report), (std::vector<Outcome>{Outcome::initiated, Outcome::ignored,
                                                      Outcome::initiated, Outcome::ignored}));
    EXPECT_EQ(filter.state().dimension(), 3 + 6 + 2);
    // Known by then, both of the next batch are used.
    const auto again = filter.update(detectionsAt(0, {once, once}));
    EXPECT_EQ(outcomes(again), std::vector<Outcome>(2, Outcome::updated));
    EXPECT_EQ(filter.landmarks().at(0).seen, 3);
}

/// State after a landmark 10 m ahead, seen twice well, is seen `error` metres too far.
struct OutlierCase {
    UpdateReport report;
    LandmarkEstimate before, after;
};
OutlierCase outlierCase(OutlierTreatment treatment, double error) {
    JointFilterParameters parameters;
    parameters.outliers = treatment;
    JointFilter filter = started(parameters);
    const auto good = seen({}, {10, 0}, landmark, 1);
    filter.update(detectionsAt(0, {good}));
    filter.update(detectionsAt(0, {good}));
    filter.predict(odometry(0, 1, {}));
    OutlierCase out;
    out.before = filter.landmarks().at(0);
    out.report = filter.update(detectionsAt(1, {shifted(good, error)}));
    out.after = filter.landmarks().at(0);
    return out;
}

TEST(JointFilterTest, OutliersAreRejectedInflatedOrAccepted) {
    // S is about 0.01 + 0.005: an error of 1 m has NIS of about 66, the gate -2 ln 0.001 = 13.8.
    const auto accepted = outlierCase(OutlierTreatment::accept, 1);
    const auto inflated = outlierCase(OutlierTreatment::inflate, 1);
    const auto rejected = outlierCase(OutlierTreatment::reject, 1);
    EXPECT_EQ(outcomes(accepted.report), std::vector{Outcome::updated});
    EXPECT_EQ(outcomes(inflated.report), std::vector{Outcome::inflated});
    EXPECT_EQ(outcomes(rejected.report), std::vector{Outcome::rejected});
    for (const auto& a : {accepted, inflated, rejected}) {
        EXPECT_NEAR(a.report.innovations[0].nis, accepted.report.innovations[0].nis, 1e-12);
        EXPECT_NEAR(a.report.innovations[0].nis, 66, 3);
    }
    EXPECT_EQ(rejected.after.mean, rejected.before.mean);
    EXPECT_EQ(rejected.after.covariance, rejected.before.covariance);
    EXPECT_EQ(rejected.after.seen, 2);
    EXPECT_EQ(rejected.after.last_seen, Stamp{});
    EXPECT_EQ(inflated.after.seen, 3);
    EXPECT_EQ(inflated.after.last_seen, Stamp::fromSeconds(1));

    // Along the line of sight everything is scalar (robot known): K = P / (P + R), R times (nis / gate)^2.
    // The second-order terms are below 1e-5 here.
    const double P = accepted.before.covariance(0, 0), nis = accepted.report.innovations[0].nis;
    const double gate = -2 * std::log(0.001), factor = std::pow(nis / gate, 2);
    const double moved = accepted.after.mean.x() - accepted.before.mean.x();
    const double moved_less = inflated.after.mean.x() - inflated.before.mean.x();
    EXPECT_NEAR(moved, P / (P + 0.01), 0.01);
    EXPECT_NEAR(moved_less / moved, (P + 0.01) / (P + 0.01 * factor), 1e-4);
}

TEST(JointFilterTest, TheGateIsAProbability) {
    JointFilterParameters parameters;
    parameters.outliers = OutlierTreatment::reject;
    // NIS of about 66 has a tail of exp(-33) = 4.7e-15.
    for (const auto& [probability, outcome] : {std::pair{0.999, Outcome::rejected},
                                               {1 - 1e-14, Outcome::rejected},
                                               {1 - 1e-15, Outcome::updated}}) {
        parameters.gate_probability = probability;
        JointFilter filter = started(parameters);
        const auto good = seen({}, {10, 0}, landmark, 1);
        filter.update(detectionsAt(0, {good}));
        filter.update(detectionsAt(0, {good}));
        EXPECT_EQ(outcomes(filter.update(detectionsAt(0, {shifted(good, 1)}))), std::vector{outcome})
            << probability;
    }
}

TEST(JointFilterTest, TracksEndWhenUnseenForLonger) {
    JointFilterParameters parameters;
    parameters.target_max_unseen = 1.0;
    JointFilter filter = started(parameters);
    filter.update(detectionsAt(0, {seen({}, {5, 0}, mover, 1), seen({}, {0, 5}, landmark, 1)}));
    filter.predict(odometry(0, 1.0, {}));
    EXPECT_EQ(filter.tracks().size(), 1u);  // exactly as long as allowed
    OdometryIncrement tick = odometry(1, 1, {});
    tick.t1 = {tick.t0.ticks + 1};
    filter.predict(tick);
    EXPECT_TRUE(filter.tracks().empty());
    EXPECT_EQ(filter.state().dimension(), 5);
    EXPECT_EQ(filter.landmarks().size(), 1u);
    // Seen again it is a new track with a new number.
    DetectionSet again = detectionsAt(0, {seen({}, {5, 0}, mover, 1)});
    again.stamp = tick.t1;
    EXPECT_EQ(outcomes(filter.update(again)), std::vector{Outcome::initiated});
    EXPECT_EQ(filter.tracks().at(0).id.value, 1);

    parameters.target_max_unseen = std::numeric_limits<double>::infinity();
    JointFilter patient = started(parameters);
    patient.update(detectionsAt(0, {seen({}, {5, 0}, mover, 1)}));
    patient.predict(odometry(0, 1000, {}));
    EXPECT_EQ(patient.tracks().size(), 1u);
}

TEST(JointFilterTest, ARejectedDetectionDoesNotKeepATrackAlive) {
    JointFilterParameters parameters;
    parameters.outliers = OutlierTreatment::reject;
    parameters.target_max_unseen = 1.0;
    parameters.target_velocity_std = parameters.target_acceleration_std = 1e-3;
    JointFilter filter = started(parameters);
    filter.update(detectionsAt(0, {seen({}, {5, 0}, mover, 1)}));
    filter.predict(odometry(0, 0.9, {}));
    EXPECT_EQ(outcomes(filter.update(detectionsAt(0.9, {seen({}, {50, 0}, mover, 1)}))),
              std::vector{Outcome::rejected});
    filter.predict(odometry(0.9, 1.5, {}));
    EXPECT_TRUE(filter.tracks().empty());
}

TEST(JointFilterTest, TheScheduleSwitchesAtTheTick) {
    JointFilterParameters parameters;
    ModelChange change;
    change.after = 1.0;
    change.kind = TargetModelKind::ca;
    parameters.target_schedule = {change};
    for (const auto& [begin, is_ca] :
         {std::pair{9'999'999L, false}, {10'000'000L, true}, {10'000'001L, true}}) {
        JointFilter filter(parameters, {});
        const Stamp start{17'000'000'000'000'000};
        filter.start(start, {});
        DetectionSet first = detectionsAt(0, {seen({}, {5, 0}, mover, 1)});
        first.stamp = {start.ticks + begin};
        filter.update(first);
        OdometryIncrement entry = odometry(0, 0, {});
        entry.t0 = first.stamp;
        entry.t1 = {first.stamp.ticks + 1'000'000};
        filter.predict(entry);
        // Constant velocity forgets the acceleration, constant acceleration keeps its prior of 2 m/s^2.
        const double variance = filter.tracks().at(0).covariance(4, 4);
        EXPECT_EQ(variance > 0, is_ca) << begin;
    }
}

/// A loop among landmarks all around and a mover, with noise from keyed draws, seen from `start`.
struct LoopResult {
    PoseGaussian robot;
    std::vector<LandmarkEstimate> landmarks;
    std::vector<TrackEstimate> tracks;
};
LoopResult noisyLoop(Consistency consistency, double start_heading) {
    JointFilterParameters parameters;
    parameters.consistency = consistency;
    JointFilter filter(parameters, {});
    const Pose2 world{10, -20, start_heading};
    const Matrix3 in_start =
        (Matrix3() << 0.02, 0.005, 0.001, 0.005, 0.01, 0.002, 0.001, 0.002, 0.003).finished();
    Matrix3 turn = Matrix3::Identity();
    turn.topLeftCorner<2, 2>() = rotation(start_heading);
    filter.start({}, {world, turn * in_start * turn.transpose()});
    RandomStream random(21, RandomPurpose::test);
    Pose2 truth;  // in the frame of the start
    for (int k = 1; k <= 60; ++k) {
        const Pose2 step{0.3, 0, 0.11};
        truth = truth * step;
        filter.predict(test::odometry(
            0.1 * (k - 1), 0.1 * k,
            {step.x + 0.01 * random.normal(), 0.002 * random.normal(), step.theta + 0.01 * random.normal()}));
        std::vector<RangeBearingDetection> detections;
        for (int i = 0; i < 8; ++i) {
            const Vector2 point = Vector2(0, 2.7) + 6.0 * Vector2(std::cos(0.8 * i), std::sin(0.8 * i));
            detections.push_back(seen(truth, point, landmark, i));
        }
        detections.push_back(seen(truth, Vector2(-8 + 0.15 * k, 1), mover, 0));
        for (RangeBearingDetection& d : detections) {
            d.range += 0.1 * random.normal();
            d.bearing = wrapAngle(d.bearing + 0.02 * random.normal());
        }
        filter.update(detectionsAt(0.1 * k, detections));
    }
    return {filter.robot(), filter.landmarks(), filter.tracks()};
}

class JointFilterRotation : public testing::TestWithParam<Consistency> {};

TEST_P(JointFilterRotation, TheWorldTurnsWithTheStart) {
    // Bearings reach all around, so turning the start moves headings and lines of sight across +-pi; nothing
    // but the frame may change. 60 steps of rounding at coordinates of about 20: 1e-9 is ample and still sees
    // any error.
    const LoopResult plain = noisyLoop(GetParam(), 0);
    const Vector2 origin(10, -20);
    for (int i = 1; i < 12; ++i) {
        const double angle = 2 * pi * i / 12;
        const LoopResult turned = noisyLoop(GetParam(), angle);
        const Matrix2 Rot = rotation(angle);
        const auto moved = [&](const Vector2& p) { return Vector2(origin + Rot * (p - origin)); };
        EXPECT_TRUE(near(turned.robot.mean.position(), moved(plain.robot.mean.position()), 1e-9)) << angle;
        EXPECT_NEAR(angleDifference(turned.robot.mean.theta, plain.robot.mean.theta + angle), 0, 1e-9)
            << angle;
        Matrix3 turn = Matrix3::Identity();
        turn.topLeftCorner<2, 2>() = Rot;
        EXPECT_TRUE(near(turned.robot.covariance, turn * plain.robot.covariance * turn.transpose(), 1e-9));
        ASSERT_EQ(turned.landmarks.size(), 8u);
        for (int k = 0; k < 8; ++k) {
            EXPECT_TRUE(near(turned.landmarks[k].mean, moved(plain.landmarks[k].mean), 1e-9)) << angle;
            EXPECT_TRUE(near(turned.landmarks[k].covariance,
                             Rot * plain.landmarks[k].covariance * Rot.transpose(), 1e-9));
        }
        ASSERT_EQ(turned.tracks.size(), 1u);
        Matrix6 Rot6 = Matrix6::Zero();
        for (int k = 0; k < 6; k += 2) Rot6.block<2, 2>(k, k) = Rot;
        EXPECT_TRUE(near(turned.tracks[0].mean.head<2>(), moved(plain.tracks[0].mean.head<2>()), 1e-9));
        EXPECT_TRUE(near(turned.tracks[0].mean.tail<4>(),
                         Rot6.topLeftCorner<4, 4>() * plain.tracks[0].mean.tail<4>(), 1e-9));
        EXPECT_TRUE(
            near(turned.tracks[0].covariance, Rot6 * plain.tracks[0].covariance * Rot6.transpose(), 1e-9));
    }
}

INSTANTIATE_TEST_SUITE_P(Both, JointFilterRotation,
                         testing::Values(Consistency::classic, Consistency::invariant), [](const auto& each) {
                             return each.param == Consistency::classic ? "classic" : "invariant";
                         });

TEST(JointFilterTest, TwoSensorsWithDifferentOffsetsInOneSet) {
    // One looks ahead from the front, one back from the rear; both see the same landmark where it is.
    const Pose2 front{1, 0.2, 0.1}, rear{-1.5, 0, pi};
    const std::vector<Pose2> sensors{front, rear};
    const Pose2 robot{2, 1, 0.7};
    const Vector2 point(6, -3);
    JointFilterParameters parameters;
    parameters.consistency =
        Consistency::classic;  // no second-order shift: noise-free detections fit exactly
    JointFilter filter(parameters, {});
    filter.start({}, {robot, Matrix3::Zero()});
    filter.update(detectionsAt(
        0, {seen(robot, point, landmark, 1, front, 0), seen(robot, Vector2(0, 9), landmark, 2, rear, 1)},
        sensors));
    EXPECT_TRUE(near(filter.landmarks().at(0).mean, point, 1e-14));
    EXPECT_TRUE(near(filter.landmarks().at(1).mean, Vector2(0, 9), 1e-14));
    const auto report = filter.update(detectionsAt(
        0, {seen(robot, point, landmark, 1, rear, 1), seen(robot, point, landmark, 1, front, 0)}, sensors));
    for (const Innovation& innovation : report.innovations) {
        EXPECT_EQ(innovation.outcome, Outcome::updated);
        EXPECT_TRUE(near(innovation.residual, Vector2(0, 0), 1e-13));
    }
    EXPECT_TRUE(near(filter.landmarks().at(0).mean, point, 1e-13));
}

TEST(JointFilterTest, JointCovarianceListsRobotTracksLandmarks) {
    JointFilter filter = started();
    filter.predict(odometry(0, 1, {1, 0, 0.1}));
    filter.update(detectionsAt(
        1, {seen({}, {5, 0}, landmark, 4), seen({}, {0, 3}, mover, 5), seen({}, {-5, 1}, landmark, 6)}));
    const JointCovariance joint = filter.jointCovariance();
    ASSERT_EQ(joint.matrix.rows(), 3 + 6 + 4);
    EXPECT_TRUE(near(joint.matrix.topLeftCorner<3, 3>(), filter.robot().covariance, 0));
    EXPECT_TRUE(near(joint.matrix.block<6, 6>(3, 3), filter.tracks().at(0).covariance, 0));
    EXPECT_TRUE(near(joint.matrix.block<2, 2>(9, 9), filter.landmarks().at(0).covariance, 0));
    EXPECT_TRUE(near(joint.matrix.bottomRightCorner<2, 2>(), filter.landmarks().at(1).covariance, 0));
    EXPECT_EQ(joint.landmarks.at(1), filter.landmarks().at(1).id);
    // Asked for by id, in any order, without those that are not there.
    const auto some = filter.landmarks({{1}, {99}, {0}, {-1}});
    ASSERT_EQ(some.size(), 2u);
    EXPECT_EQ(some[0].id.value, 1);
    EXPECT_EQ(some[1].id.value, 0);
}

TEST(JointFilterTest, StartForgetsEverything) {
    JointFilter filter = started();
    filter.update(detectionsAt(0, {seen({}, {5, 0}, landmark, 4), seen({}, {0, 3}, mover, 5)}));
    filter.start(Stamp::fromSeconds(7), {{1, 2, 3}, Matrix3::Identity()});
    EXPECT_TRUE(filter.landmarks().empty() && filter.tracks().empty());
    EXPECT_EQ(filter.state().dimension(), 3);
    EXPECT_TRUE(near(filter.robot().mean.vector(), Vector3(1, 2, 3), 0));
    filter.update(detectionsAt(7, {seen({}, {5, 0}, landmark, 4)}));
    EXPECT_EQ(filter.landmarks().at(0).id.value, 0);
}

TEST(JointFilterParametersTest, ScheduleIsReadAndWritten) {
    JointFilterParameters parameters;
    const auto tables = describe(parameters, "ekf", "");
    const Parameter* schedule = nullptr;
    for (const auto& table : tables)
        if (table.section() == "ekf.target") schedule = table.find("schedule");
    ASSERT_TRUE(schedule);
    EXPECT_EQ(schedule->print(), "none");
    EXPECT_FALSE(schedule->parse("15:ca:1.8, 20.5 : cv"));
    ASSERT_EQ(parameters.target_schedule.size(), 2u);
    EXPECT_EQ(parameters.target_schedule[0].after, 15);
    EXPECT_EQ(parameters.target_schedule[0].kind, TargetModelKind::ca);
    EXPECT_EQ(parameters.target_schedule[0].noise_std, 1.8);
    EXPECT_EQ(parameters.target_schedule[1].after, 20.5);
    EXPECT_EQ(schedule->print(), "15:ca:1.8, 20.5:cv:0.5");
    for (const char* bad : {"15", "15:xx", "x:ca", "-1:ca", "15:ca:-1", "15:ca:1:2", "15:ca, 15:cv",
                            "15:ca,, 16:cv", "15:ca,", "nan:ca", "inf:ca"})
        EXPECT_TRUE(schedule->parse(bad)) << bad;
    EXPECT_EQ(parameters.target_schedule.size(), 2u);
    EXPECT_FALSE(schedule->parse("none"));
    EXPECT_TRUE(parameters.target_schedule.empty());
}

}  // namespace joint_filter_test
}  // namespace slamot
