#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

#include "slamot/core/estimation/DenseJointBank.h"
#include "slamot/core/estimation/RangeBearingUpdate.h"
#include "slamot/core/models/RangeBearing.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace range_bearing_update_test {

using test::near;

const Matrix2 R = (Matrix2() << 0.01, 0.001, 0.001, 0.0025).finished();

/// Robot at (1, 2, 0.5) with a landmark at (7, 10), 10 m away, correlated.
DenseJointBank correlatedState() {
    const Matrix3 robot = (Matrix3() << 0.4, 0.1, 0.02, 0.1, 0.3, -0.03, 0.02, -0.03, 0.01).finished();
    DenseJointBank state({1, 2, 0.5}, robot, Consistency::classic);
    const Eigen::Matrix<double, 2, 3> G = (Eigen::Matrix<double, 2, 3>() << 1, 0, -8, 0, 1, 6).finished();
    state.augment(BlockKind::landmark, {Vector2(7, 10), G, (Matrix2() << 0.5, 0.2, 0.2, 0.4).finished()});
    return state;
}

RangeBearingDetection detectionOf(double range, double bearing) {
    RangeBearingDetection detection;
    detection.range = range;
    detection.bearing = bearing;
    detection.covariance = R;
    return detection;
}

TEST(RangeBearingUpdateTest, ClassicIsTheModelsLinearisation) {
    const DenseJointBank bank = correlatedState();
    const JointView& state = bank.mode(0);
    const Pose2 sensor{0.5, -0.2, 0.3};
    const auto h = predictRangeBearing({1, 2, 0.5}, {7, 10}, sensor);
    const auto out =
        linearise(state, 1, detectionOf(h.z.x() + 0.3, h.z.y() - 0.1), sensor, Consistency::classic);
    EXPECT_TRUE(near(out.measurement.residual, Vector2(0.3, -0.1), 1e-14));
    EXPECT_EQ(out.measurement.R, R);
    ASSERT_EQ(out.measurement.term_count, 2);
    EXPECT_EQ(out.measurement.terms[0].block, robot_block);
    EXPECT_EQ(out.measurement.terms[1].block, 1);
    EXPECT_TRUE(near(out.measurement.terms[0].H, h.H_robot, 0));
    EXPECT_TRUE(near(out.measurement.terms[1].H, h.H_point, 0));
    Eigen::Matrix<double, 2, 5> H;
    H << h.H_robot, h.H_point;
    const Matrix2 S = H * state.jointCovariance({0, 1}) * H.transpose() + R;
    EXPECT_TRUE(near(out.S, S, 1e-14));
    EXPECT_NEAR(out.nis, Vector2(0.3, -0.1).dot(S.inverse() * Vector2(0.3, -0.1)), 1e-13);
}

TEST(RangeBearingUpdateTest, SecondOrderTermsAreThoseOfTheFormula) {
    // Innovation of range -= P_lat/(2d), its variance += (P_lat/d)^2/2, P_lat the variance across the line of
    // sight of landmark minus sensor; the lever arm turns with the heading.
    const DenseJointBank bank = correlatedState();
    const JointView& state = bank.mode(0);
    const Pose2 sensor{0.5, -0.2, 0.3};
    const auto classic = linearise(state, 1, detectionOf(9, 0.3), sensor, Consistency::classic);
    const auto invariant = linearise(state, 1, detectionOf(9, 0.3), sensor, Consistency::invariant);

    const Vector2 lever = rotation(0.5) * sensor.position(), rel = Vector2(6, 8) - lever;
    const double d = rel.norm();
    const Vector2 t = Vector2(-rel.y(), rel.x()) / d;
    Eigen::Matrix<double, 2, 5> D;  // d rel / d [robot, landmark]
    D << -Matrix2::Identity(), Vector2(lever.y(), -lever.x()), Matrix2::Identity();
    const double P_lat = t.dot(D * state.jointCovariance({0, 1}) * D.transpose() * t);
    EXPECT_GT(P_lat, 0.1);  // or there would be nothing to see

    EXPECT_NEAR(invariant.measurement.residual.x(), classic.measurement.residual.x() - P_lat / (2 * d),
                1e-13);
    EXPECT_EQ(invariant.measurement.residual.y(), classic.measurement.residual.y());
    Matrix2 extra = Matrix2::Zero();
    extra(0, 0) = P_lat * P_lat / (2 * d * d);
    EXPECT_TRUE(near(invariant.measurement.R, R + extra, 1e-14));
    EXPECT_TRUE(near(invariant.S, classic.S + extra, 1e-14));
}

TEST(RangeBearingUpdateTest, SecondOrderTermsMatchSampledRanges) {
    // Sensor at the robot, 2 m away, 0.2 m of uncertainty: mean and variance of the true range by sampling.
    DenseJointBank bank({0, 0, 0}, Vector3(0.02, 0.02, 0).asDiagonal(), Consistency::classic);
    bank.augment(BlockKind::landmark,
                 {Vector2(2, 0), Eigen::MatrixXd::Zero(2, 3), 0.02 * Matrix2::Identity()});
    const JointView& state = bank.mode(0);
    const auto out = linearise(state, 1, detectionOf(2, 0), {}, Consistency::invariant);

    RandomStream random(9, RandomPurpose::test);
    const int n = 1000000;
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
        // Landmark minus robot: variance 0.04 along and across.
        const double error = std::hypot(2 + 0.2 * random.normal(), 0.2 * random.normal()) - 2;
        sum += error;
        squares += error * error;
    }
    const double mean = sum / n, variance = squares / n - mean * mean;
    // residual = 2 - 2 - bias. The sample's mean deviates by 0.2/1000; the neglected fourth order, about
    // 3 P_lat^2 / (8 d^3) = 8e-5, is below that. P_lat / 2d = 0.01.
    EXPECT_NEAR(-out.measurement.residual.x(), mean, 5 * 2e-4);
    EXPECT_NEAR(-out.measurement.residual.x(), 0.01, 1e-15);
    // H P H^t = 0.04, + (0.04/2)^2/2 = 2e-4. Its own deviation 0.04 sqrt(2)/1000 = 5.7e-5, 5 of them plus
    // what the coupling of along and across adds in the same order (P_lat P_along / d^2 = 4e-4, left to H by
    // design).
    EXPECT_NEAR(out.S(0, 0) - R(0, 0), 0.0402, 1e-15);
    EXPECT_NEAR(out.S(0, 0) - R(0, 0), variance, 5 * 5.7e-5 + 4.1e-4);
}

TEST(RangeBearingUpdateTest, BearingsMeetOnTheShortWay) {
    // The landmark lies straight behind, at +pi; seen at -pi + 0.1 the innovation is 0.1 and not 0.1 - 2 pi.
    DenseJointBank bank({0, 0, 0}, 0.01 * Matrix3::Identity(), Consistency::classic);
    bank.augment(BlockKind::landmark,
                 {Vector2(-5, 0), Eigen::MatrixXd::Zero(2, 3), 0.01 * Matrix2::Identity()});
    const JointView& state = bank.mode(0);
    for (const double offset : {0.1, -0.1}) {
        const double bearing = wrapAngle(pi + offset);
        const auto out = linearise(state, 1, detectionOf(5, bearing), {}, Consistency::classic);
        EXPECT_NEAR(out.measurement.residual.y(), offset, 1e-14);
    }
}

TEST(RangeBearingUpdateTest, WhatIsExpectedTakesAnyDetection) {
    // One sight serves all detections: each as if linearised alone, whatever came before it.
    const DenseJointBank bank = correlatedState();
    const JointView& state = bank.mode(0);
    const Pose2 sensor{0.5, -0.2, 0.3};
    for (const Consistency consistency : {Consistency::classic, Consistency::invariant}) {
        const ExpectedSight sight = expectedSight(state, 1, sensor, consistency);
        for (const auto& [range, bearing, scale] :
             {std::make_tuple(9.0, 0.3, 1.0), std::make_tuple(12.0, -3.1, 4.0),
              std::make_tuple(0.5, 3.1, 0.1)}) {
            RangeBearingDetection detection = detectionOf(range, bearing);
            detection.covariance *= scale;
            const Linearisation with = sight.with(detection),
                                alone = linearise(state, 1, detection, sensor, consistency);
            EXPECT_EQ(with.measurement.residual, alone.measurement.residual);
            EXPECT_EQ(with.measurement.R, alone.measurement.R);
            EXPECT_EQ(with.S, alone.S);
            EXPECT_EQ(with.nis, alone.nis);
            // By what the sight says: z - expected, and its covariance with the detection's.
            const Vector2 nu = rangeBearingResidual(detection.z(), sight.detection.z);
            EXPECT_EQ(with.measurement.residual, nu);
            EXPECT_TRUE(near(with.S, sight.detection.covariance + detection.covariance, 1e-14));
            EXPECT_NEAR(with.nis, nu.dot(with.S.inverse() * nu), 1e-10 * with.nis);
            // H P H^t + R by the measurement's own terms is S.
            Eigen::Matrix<double, 2, 5> H;
            H << with.measurement.terms[0].H, with.measurement.terms[1].H;
            EXPECT_TRUE(
                near(H * state.jointCovariance({0, 1}) * H.transpose() + with.measurement.R, with.S, 1e-13));
        }
    }
}

TEST(RangeBearingUpdateTest, RefusesAnIndefiniteS) {
    const DenseJointBank bank = correlatedState();
    const JointView& state = bank.mode(0);
    RangeBearingDetection detection = detectionOf(10, 0);
    detection.covariance = -100 * Matrix2::Identity();
    EXPECT_THROW(linearise(state, 1, detection, {}, Consistency::classic), std::domain_error);
}

}  // namespace range_bearing_update_test
}  // namespace slamot
