#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "../estimation/FullMatrixImm.h"
#include "../estimation/ImmScenes.h"
#include "slamot/core/particles/TargetFilter.h"
#include "support/Expect.h"
#include "support/Scenes.h"

namespace slamot {
namespace target_filter_test {

using test::near;

TargetSight sightOf(const RangeBearingDetection& detection, const Pose2& sensor = {}) {
    return {detection.z(), detection.covariance, sensor};
}

TargetSettings settingsOf(const ImmParameters& imm) {
    TargetSettings out;
    out.models = modelsOf(imm);
    out.chain = chainOf(imm);
    out.initial = initialProbabilities(imm);
    return out;
}

TargetSettings controlled(int headings) {
    TargetSettings out;
    out.drive = TargetDrive::control;
    out.control.speed = 1;
    out.control.turn_rate = 0.05;
    out.control.headings = headings;
    return out;
}

RelativeGaussian moverOf(const RangeBearingDetection& detection, double velocity_std = 3,
                         double acceleration_std = 2) {
    return moverAt(firstSight(detection, {}, Consistency::classic), velocity_std, acceleration_std);
}

/// A mover on a bent path, seen from a robot that stands at `pose`; noise that is no noise.
RangeBearingDetection detectionAt(int k, const Pose2& pose) {
    const Vector2 at(6 + 0.3 * k, 2 + 0.01 * k * k);
    RangeBearingDetection out = test::seen(pose, at, ObjectKind::mover, 1);
    out.range += 0.1 * std::sin(1.7 * k);
    out.bearing = wrapAngle(out.bearing + 0.02 * std::cos(2.3 * k));
    return out;
}

// Given its pose, a particle's filter of a mover is the textbook's IMM beside a robot that is known exactly.
TEST(TargetFilterTest, IsTheReferenceImmWhereTheRobotIsKnown) {
    for (const std::string modes :
         {"cv:cv:0.5", "cv:cv:0.1, ca:ca:1.5", "cv:cv:0.2, left:ct:0.3:20, u:unicycle:0.5:10"}) {
        const ImmParameters imm = test::immModes(modes);
        const TargetSettings settings = settingsOf(imm);
        RobotMotionParameters still;
        still.model = RobotMotionModel::increment;
        still.along_std_per_sqrt_m = still.across_std_per_sqrt_m = 0;
        still.heading_std_per_sqrt_m = still.heading_std_per_sqrt_rad = 0;
        const Pose2 pose{1, -2, 2.9};
        test::FullMatrixImm reference(imm, Consistency::classic, {pose, Matrix3::Zero()});
        reference.add(1, 6, detectionAt(0, pose), 3, 2);
        TargetFilter filter(settings, moverOf(detectionAt(0, pose)), pose.vector());
        for (int k = 1; k <= 40; ++k) {
            const double dt = k % 3 == 0 ? 0.25 : 0.1;
            reference.predict(still, test::odometry(0, dt, {}));
            filter.predict(settings, TargetStep(settings, dt));
            if (k % 4 != 0) {  // coasting now and then
                reference.update({{1, detectionAt(k, pose)}});
                filter.update(settings, pose.vector(), sightOf(detectionAt(k, pose)));
            }
            const auto combined = reference.combined();
            const TargetGaussian ours = filter.merged(settings);
            ASSERT_TRUE(near(ours.mean, combined.x.segment<6>(3), 1e-9)) << modes << " " << k;
            ASSERT_TRUE(near(ours.covariance, combined.P.block(3, 3, 6, 6), 1e-9)) << modes << " " << k;
            for (int j = 0; j < filter.probabilities().size(); ++j)
                ASSERT_NEAR(filter.probabilities()(j), reference.probability(0, j), 1e-9)
                    << modes << " " << k;
            ASSERT_TRUE(near(filter.position().mean, combined.x.segment<2>(3), 1e-9));
        }
    }
}

TEST(TargetFilterTest, LikelihoodIsThatOfTheMixture) {
    const ImmParameters imm = test::immModes("slow:cv:0.1, fast:ca:5");
    const TargetSettings settings = settingsOf(imm);
    TargetFilter filter(settings, moverOf(detectionAt(0, {})), Vector3::Zero());
    for (int k = 1; k <= 3; ++k) {
        filter.predict(settings, TargetStep(settings, 0.1));
        filter.update(settings, Vector3::Zero(), sightOf(detectionAt(k, {})));
    }
    filter.predict(settings, TargetStep(settings, 0.1));
    const RangeBearingDetection next = detectionAt(4, {});
    double density = 0;
    for (int j = 0; j < 2; ++j) {
        const TargetGaussian& mode = filter.mode(j);
        const RangeBearingPrediction h = predictRangeBearing(Vector3::Zero(), mode.mean.head<2>(), {});
        const Matrix2 S =
            h.H_point * mode.covariance.topLeftCorner<2, 2>() * h.H_point.transpose() + next.covariance;
        const Vector2 nu = rangeBearingResidual(next.z(), h.z);
        density += filter.probabilities()(j) * std::exp(-0.5 * nu.dot(S.inverse() * nu)) /
                   (2 * pi * std::sqrt(S.determinant()));
    }
    EXPECT_NEAR(filter.update(settings, Vector3::Zero(), sightOf(next)), std::log(density), 1e-10);
}

// Where uncertainty is small beside the distance, sigma points and Jacobians say the same.
TEST(TargetFilterTest, UnscentedUpdateMeetsTheLinearOneFarAway) {
    TargetSettings linear, unscented;
    unscented.transform = GaussianTransform::unscented;
    RangeBearingDetection first = test::seen({}, {300, 400}, ObjectKind::mover, 1), second = first;
    first.covariance = second.covariance = Vector2(1e-4, 1e-10).asDiagonal();
    second.range += 0.01;
    second.bearing += 1e-5;
    TargetFilter a(linear, moverOf(first), Vector3::Zero()), b(unscented, moverOf(first), Vector3::Zero());
    for (TargetFilter* filter : {&a, &b}) filter->predict(linear, TargetStep(linear, 0.001));
    const double log_a = a.update(linear, Vector3::Zero(), sightOf(second)),
                 log_b = b.update(unscented, Vector3::Zero(), sightOf(second));
    EXPECT_NEAR(log_a, log_b, 1e-5);
    // 3 mm of the prior's spread bend the range by 1e-8 m, which is 1e-5 m/s over a millisecond.
    EXPECT_TRUE(near(a.merged(linear).mean - b.merged(unscented).mean, Vector6::Zero(), 1e-5));
    EXPECT_TRUE(near(a.merged(linear).covariance, b.merged(unscented).covariance, 1e-6));
}

// --- paper 2's mover
// ---------------------------------------------------------------------------------------------------

/// Known to drive along +x with the speed that it is known to have.
RelativeGaussian drivingAlongX(const Vector2& at) {
    RelativeGaussian out = moverAt({at, Matrix2(0.01 * Matrix2::Identity())}, 0.1, 0);
    out.mean(2) = 1;
    return out;
}

// A step of eq. 16 to 18 with matrices written out.
TEST(TargetFilterTest, ControlledMoverByHand) {
    TargetSettings settings = controlled(360);
    settings.control.path = ControlledPath::printed;
    settings.control.speed_std = 0.1;
    settings.control.turn_rate_std = 0.03;
    TargetFilter filter(settings, drivingAlongX({3, 1}), Vector3::Zero());
    ASSERT_EQ(filter.probabilities().size(), 1);  // headings near 0 are one Gaussian already
    const TargetGaussian start = filter.mode(0);
    EXPECT_NEAR(start.mean(2), 0, 1e-6);
    EXPECT_NEAR(start.covariance(2, 2), 0.01, 2e-4);  // 0.1 m/s across 1 m/s

    const double dt = 0.2, heading = start.mean(2) + 0.05 * dt, c = std::cos(heading), s = std::sin(heading);
    filter.predict(settings, TargetStep(settings, dt));
    Matrix3 F, P = start.covariance.topLeftCorner<3, 3>();
    F << 1, 0, -dt * s, 0, 1, dt * c, 0, 0, 1;
    Eigen::Matrix<double, 3, 2> H_u;
    H_u << dt * c, -dt * dt * s, dt * s, dt * dt * c, 0, dt;
    P = F * P * F.transpose() + H_u * Vector2(0.01, 0.0009).asDiagonal() * H_u.transpose();
    const Vector3 x(start.mean(0) + dt * c, start.mean(1) + dt * s, heading);
    EXPECT_TRUE(near(filter.mode(0).mean.head<3>(), x, 1e-14));
    EXPECT_TRUE(near(filter.mode(0).covariance.topLeftCorner<3, 3>(), P, 1e-15));

    const RangeBearingDetection seen = test::seen({}, {3.25, 1.02}, ObjectKind::mover, 1);
    const double r = x.head<2>().norm();
    Eigen::Matrix<double, 2, 3> H;
    H << x(0) / r, x(1) / r, 0, -x(1) / (r * r), x(0) / (r * r), 0;
    const Matrix2 S = H * P * H.transpose() + seen.covariance;
    const Eigen::Matrix<double, 3, 2> K = P * H.transpose() * S.inverse();
    const Vector2 nu(seen.range - r, seen.bearing - std::atan2(x(1), x(0)));
    const double log_N = filter.update(settings, Vector3::Zero(), sightOf(seen));
    EXPECT_NEAR(log_N, -0.5 * nu.dot(S.inverse() * nu) - 0.5 * std::log(S.determinant()) - std::log(2 * pi),
                1e-12);
    EXPECT_TRUE(near(filter.mode(0).mean.head<3>(), x + K * nu, 1e-14));
    EXPECT_TRUE(
        near(filter.mode(0).covariance.topLeftCorner<3, 3>(), (Matrix3::Identity() - K * H) * P, 1e-14));
    EXPECT_TRUE(filter.mode(0).covariance.bottomRows<3>().isZero(0));

    // Told as [p v a]: 1 m/s along the heading.
    const TargetGaussian told = filter.merged(settings);
    const double theta = filter.mode(0).mean(2);
    EXPECT_TRUE(near(told.mean.segment<2>(2), Vector2(std::cos(theta), std::sin(theta)), 1e-15));
    EXPECT_TRUE(near(told.mean.tail<2>(), 0.05 * Vector2(-std::sin(theta), std::cos(theta)), 1e-15));
}

TEST(TargetFilterTest, AtFirstSightAllHeadingsAreAlikeAndThenThePathDecides) {
    const TargetSettings settings = controlled(8);
    for (const double heading : {0.0, 0.4, 2.0, -2.5}) {
        const Vector2 along(std::cos(heading), std::sin(heading));
        const auto at = [&](int k) {
            return test::seen({}, Vector2(5, 3) + 0.2 * k * along, ObjectKind::mover, 1);
        };
        TargetFilter filter(settings, moverOf(at(0)), Vector3::Zero());
        ASSERT_EQ(filter.probabilities().size(), 8);
        for (int j = 0; j < 8; ++j) EXPECT_NEAR(filter.probabilities()(j), 0.125, 1e-12);
        EXPECT_TRUE(near(filter.merged(settings).mean.segment<2>(2), Vector2::Zero(), 1e-12));
        EXPECT_TRUE(near(filter.position().mean, Vector2(5, 3), 1e-12));

        TargetSettings straight = settings;
        straight.control.turn_rate = 0;
        for (int k = 1; k <= 15; ++k) {
            filter.predict(straight, TargetStep(straight, 0.2));
            filter.update(straight, Vector3::Zero(), sightOf(at(k)));
            ASSERT_NEAR(filter.probabilities().sum(), 1, 1e-12);
        }
        EXPECT_EQ(filter.probabilities().size(), 1);
        const TargetGaussian told = filter.merged(straight);
        // Sights without noise along 3 m, beside 0.1 m: the heading is known to some 0.1 rad.
        EXPECT_TRUE(near(told.mean.segment<2>(2), along, 0.1)) << heading;
    }
}

// With headings on both sides of +-pi the mixture's heading is not 0.
TEST(TargetFilterTest, HeadingsMeetAcrossPi) {
    const TargetSettings settings = controlled(72);
    RelativeGaussian mover = drivingAlongX({3, 1});
    mover.mean(2) = -1;
    const TargetFilter filter(settings, mover, Vector3::Zero());
    ASSERT_EQ(filter.probabilities().size(), 1);
    EXPECT_NEAR(std::abs(wrapAngle(filter.mode(0).mean(2))), pi, 1e-6);
    EXPECT_NEAR(filter.mode(0).covariance(2, 2), 0.01, 5e-4);
}

TEST(TargetFilterTest, StaysDefiniteWhereDetectionsAreFarBetterThanThePrior) {
    TargetSettings settings;
    RangeBearingDetection seen = test::seen({}, {3, 4}, ObjectKind::mover, 1);
    seen.covariance = Vector2(1e-10, 1e-12).asDiagonal();
    for (const GaussianTransform transform : {GaussianTransform::linear, GaussianTransform::unscented}) {
        settings.transform = transform;
        TargetFilter filter(settings, moverOf(seen, 10, 5), Vector3::Zero());
        for (int k = 0; k < 1000; ++k) {
            filter.predict(settings, TargetStep(settings, 0.1));
            filter.update(settings, Vector3::Zero(), sightOf(seen));
        }
        const Eigen::SelfAdjointEigenSolver<Matrix6> solver(filter.merged(settings).covariance);
        EXPECT_GE(solver.eigenvalues()(0), -1e-9 * solver.eigenvalues()(5));
    }
}

}  // namespace target_filter_test
}  // namespace slamot
