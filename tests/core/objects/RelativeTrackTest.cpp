#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <vector>

#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/models/RangeBearing.h"
#include "slamot/core/objects/RelativeTrack.h"
#include "slamot/core/random/RandomStream.h"
#include "support/AutoDiff.h"
#include "support/Expect.h"

namespace slamot {
namespace relative_track_test {

using test::jacobian;
using test::near;

/// Closed forms and automatic differentiation evaluate the same few products: rounding only.
constexpr double rounding = 1e-13;
const Matrix2 R = (Matrix2() << 0.01, 1e-4, 1e-4, 4e-4).finished();

RangeBearingDetection detectionOf(const Vector2& z, const Matrix2& noise = R) {
    RangeBearingDetection detection;
    detection.range = z.x();
    detection.bearing = wrapAngle(z.y());
    detection.covariance = noise;
    return detection;
}

TEST(RelativeTrackTest, AMoveHasTheJacobiansOfTheModel) {
    const Matrix3 Q = (Matrix3() << 4, 1, 0.5, 1, 3, -0.3, 0.5, -0.3, 2).finished() * 1e-2;
    const Matrix6 A = (Matrix6::Random() + 2 * Matrix6::Identity()) * 0.1, P = A * A.transpose();
    const Vector6 x = (Vector6() << 3, -2, 1.5, 0.7, -0.4, 0.2).finished();
    for (const Pose2& move :
         {Pose2{0.4, 0.1, 0.3}, Pose2{-0.4, 0, pi}, Pose2{0, 0, -3.1}, Pose2{1, 2, 1e-9}}) {
        const auto after = [](const auto& object, const auto& u) {
            using S = typename std::decay_t<decltype(object)>::Scalar;
            Eigen::Matrix<S, 6, 1> y = object;
            y.template head<2>() -= u.template head<2>();
            for (int k = 0; k < 6; k += 2)
                y.template segment<2>(k) = (rotation(S(-u(2))) * y.template segment<2>(k)).eval();
            return y;
        };
        const auto F = jacobian<6>(
            [&](const auto& object) {
                using S = typename std::decay_t<decltype(object)>::Scalar;
                return after(object, Eigen::Matrix<S, 3, 1>(move.vector().cast<S>()));
            },
            x);
        const auto G = jacobian<3>(
            [&](const auto& u) {
                using S = typename std::decay_t<decltype(u)>::Scalar;
                return after(Eigen::Matrix<S, 6, 1>(x.cast<S>()), u);
            },
            move.vector());
        const RelativeGaussian mover = afterMove({x, P}, {move, Q});
        EXPECT_TRUE(near(mover.mean, after(x, move.vector()), rounding));
        EXPECT_TRUE(near(mover.covariance, F * P * F.transpose() + G * Q * G.transpose(), rounding));
        const RelativeGaussian point =
            afterMove({Vector2(x.head<2>()), Matrix2(P.topLeftCorner<2, 2>())}, {move, Q});
        EXPECT_TRUE(near(point.mean, mover.mean.head<2>(), rounding));
        EXPECT_TRUE(near(point.covariance, mover.covariance.topLeftCorner<2, 2>(), rounding));
    }
}

TEST(RelativeTrackTest, AStepIsTheMotionModelFromTheOrigin) {
    RobotMotionParameters motion;
    motion.model = RobotMotionModel::increment;
    OdometryIncrement odometry;
    odometry.t1 = Stamp::fromSeconds(0.25);
    odometry.increment = {0.5, -0.1, 0.2};
    odometry.covariance = Vector3(0.1, 0.2, 0.3).asDiagonal();
    const RelativeStep step = relativeStep(motion, odometry);
    EXPECT_TRUE(near(step.move.mean.vector(), odometry.increment.vector(), rounding));
    EXPECT_TRUE(near(step.move.covariance, *odometry.covariance, rounding));
    EXPECT_DOUBLE_EQ(step.dt, 0.25);
}

/// A path that turns right round, and what is seen on it: the object's place by step, and the same noise for
/// all.
struct Scene {
    Pose2 robot{4, -3, 2.5};
    const PoseGaussian move{{0.3, 0.02, 0.4}, Matrix3::Zero()};
    const Pose2 sensor{0.4, -0.2, 2.0};
    static constexpr double dt = 0.2;

    Vector2 see(int step) const {
        const Vector2 object(7 + 0.2 * step, 1 - 0.05 * step);
        RandomStream random(5, RandomPurpose::test, 0, static_cast<std::uint32_t>(step));
        return rangeBearing<double>(robot.vector(), object, sensor) +
               Vector2(random.normal(0, 0.1), random.normal(0, 0.02));
    }
};

/// EKF in the world, from a robot whose pose is known; textbook form with an inverse.
void worldUpdate(Eigen::VectorXd& x, Eigen::MatrixXd& P, const Scene& scene, const Vector2& z) {
    const auto h = predictRangeBearing(scene.robot.vector(), x.head<2>(), scene.sensor);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2, x.size());
    H.leftCols<2>() = h.H_point;
    const Matrix2 S = H * P * H.transpose() + R;
    const Eigen::MatrixXd K = P * H.transpose() * S.inverse();
    x += K * rangeBearingResidual(z, h.z);
    P -= K * S * K.transpose();
}

void expectAgreesWithTheWorld(RelativeTrack track, const TargetModel* model, Scene scene) {
    const auto current = [&]() -> const RelativeGaussian& {
        return model ? track.asMover() : track.asLandmark();
    };
    const NewBlock first = inWorld(current(), scene.robot.vector());
    Eigen::VectorXd x = first.mean;
    Eigen::MatrixXd P = first.own;
    for (int step = 1; step <= 40; ++step) {
        scene.robot = scene.robot * scene.move.mean;
        if (model) {
            const TargetPrediction motion = predictTarget(*model, x, Scene::dt);
            x = motion.mean;
            P = motion.F * P * motion.F.transpose() + motion.Q;
        }
        const Vector2 z = scene.see(step);
        worldUpdate(x, P, scene, z);
        track.predict({scene.move, Scene::dt}, model ? *model : TargetModel{}, {});
        track.update(detectionOf(z), scene.sensor);
        // Forty steps of rounding, of numbers up to 20; the textbook form loses some digits.
        const NewBlock now = inWorld(current(), scene.robot.vector());
        ASSERT_TRUE(near(now.mean, x, 1e-9)) << "step " << step;
        ASSERT_TRUE(near(now.own, P, 1e-9)) << "step " << step;
    }
}

TEST(RelativeTrackTest, AgreesWithAFilterInTheWorldOnAKnownPath) {
    const Scene scene;
    const RelativeGaussian point = firstSight(detectionOf(scene.see(0)), scene.sensor, Consistency::classic);
    {
        SCOPED_TRACE("still");
        expectAgreesWithTheWorld(RelativeTrack::still(point), nullptr, scene);
    }
    for (const TargetModelKind kind :
         {TargetModelKind::cv, TargetModelKind::ca, TargetModelKind::ct, TargetModelKind::unicycle}) {
        SCOPED_TRACE(toText(kind));
        TargetModel model{kind, 0.5, 0.1};
        model.turn_rate = 0.2;
        expectAgreesWithTheWorld(RelativeTrack::moving(point, 3, 2), &model, scene);
    }
}

TEST(RelativeTrackTest, ASpinningRobotSeesTheSame) {
    const TargetModel model{TargetModelKind::cv, 0.5, 0.1};
    const double turn = 2 * pi / 16;
    for (int k = 0; k < 24; ++k) {
        // Bearings from all around, so that they cross +-pi at every step of the spin.
        const double bearing = radians(15.0 * k);
        const auto seen = [&](int step, double heading) {
            RandomStream random(7, RandomPurpose::test, 0, static_cast<std::uint32_t>(step));
            return detectionOf(
                {8 + random.normal(0, 0.1), bearing + random.normal(0, 0.02) + 0.02 * step - heading});
        };
        const auto started = [&] {
            return RelativeTrack::unknown(firstSight(seen(0, 0), {}, Consistency::invariant), {});
        };
        RelativeTrack spinning = started(), resting = started();
        for (int step = 1; step <= 32; ++step) {
            spinning.predict({{{0, 0, turn}, Matrix3::Zero()}, 0.1}, model, {});
            resting.predict({{{0, 0, 0}, Matrix3::Zero()}, 0.1}, model, {});
            const auto a = seen(step, turn * step), b = seen(step, 0);
            // Rounding of thirty steps, of angles up to 30 rad.
            ASSERT_NEAR(spinning.match(a, {}).nis, resting.match(b, {}).nis, 1e-9);
            ASSERT_NEAR(spinning.match(a, {}).log_likelihood, resting.match(b, {}).log_likelihood, 1e-9);
            ASSERT_TRUE(near(spinning.expected({}).covariance, resting.expected({}).covariance, 1e-10));
            ASSERT_LE(std::abs(spinning.expected({}).z.y()), pi);
            spinning.update(a, {});
            resting.update(b, {});
            ASSERT_NEAR(spinning.movingProbability(), resting.movingProbability(), 1e-9);
        }
        const Vector3 after_two_turns = Vector3::Zero();
        EXPECT_TRUE(near(inWorld(spinning.asMover(), after_two_turns).mean, resting.asMover().mean, 1e-9));
    }
}

const RelativeGaussian ahead{Vector2(10, 0), Vector2(0.04, 0.09).asDiagonal()};
const PoseGaussian no_move{{}, Matrix3::Zero()};

TEST(RelativeTrackTest, MotionsMixByHand) {
    // Rates of 1 per second both ways: a quarter changes in ln(2)/2 s. No noise, velocity variance 4.
    MotionChange change;
    change.moving_probability = 0.5;
    change.start_every = change.stop_every = 1;
    change.velocity_std = 2;
    const double dt = 0.5 * std::log(2.0), dt2 = dt * dt;
    const TargetModel model{TargetModelKind::cv, 0, 0};
    RelativeTrack track = RelativeTrack::unknown(ahead, change);
    // First: still 0.04; moving 0.04 + 4 dt^2, with covariance 4 dt to its velocity.
    track.predict({no_move, dt}, model, change);
    EXPECT_NEAR(track.asLandmark().covariance(0, 0), 0.04, rounding);
    EXPECT_NEAR(track.asMover().covariance(0, 0), 0.04 + 4 * dt2, rounding);
    // Second: still 3/4 * 0.04 + 1/4 (0.04 + 4 dt^2); moving mixed to 0.04 + 3 dt^2, 3 dt, 4, then moved on.
    track.predict({no_move, dt}, model, change);
    EXPECT_NEAR(track.movingProbability(), 0.5, rounding);
    EXPECT_NEAR(track.asLandmark().covariance(0, 0), 0.04 + dt2, rounding);
    EXPECT_NEAR(track.asMover().covariance(0, 0), 0.04 + 13 * dt2, rounding);
    EXPECT_NEAR(track.asMover().covariance(0, 2), 7 * dt, rounding);
    EXPECT_NEAR(track.asMover().covariance(2, 2), 4, rounding);
}

TEST(RelativeTrackTest, MixingSpreadsByHowFarTheMeansLieApart) {
    MotionChange change;
    change.moving_probability = 0.5;
    const TargetModel model{TargetModelKind::cv, 0, 0};
    RelativeTrack track = RelativeTrack::unknown(ahead, change);
    track.predict({no_move, 0.5}, model, change);
    track.update(detectionOf({11, 0.02}, Vector2(0.02, 1e-3).asDiagonal()), {});
    const RelativeGaussian s = track.asLandmark(), m = track.asMover();
    ASSERT_GT(m.mean.x() - s.mean.x(), 0.2);
    const double p = track.movingProbability(), rate = 1.0 / 60 + 1.0 / 10;
    const double settled = 1 - std::exp(-rate * 0.5), start = settled / 60 / rate, stop = settled / 10 / rate;
    const double still = (1 - p) * (1 - start) + p * stop, w = p * stop / still;
    track.predict({no_move, 0.5}, model, change);
    EXPECT_NEAR(track.movingProbability(), 1 - still, rounding);
    // Second moments about 0, less the square of the mean.
    const Vector2 mean = w * m.mean.head<2>() + (1 - w) * s.mean;
    const Matrix2 second =
        w * (m.covariance.topLeftCorner<2, 2>() + m.mean.head<2>() * m.mean.head<2>().transpose()) +
        (1 - w) * (s.covariance + s.mean * s.mean.transpose());
    EXPECT_TRUE(near(track.asLandmark().mean, mean, rounding));
    // Squares of 10 m cancel.
    EXPECT_TRUE(near(track.asLandmark().covariance, second - mean * mean.transpose(), 1e-12));
}

double logNormal(double residual, double variance) {
    return -0.5 * (residual * residual / variance + std::log(2 * pi * variance));
}

TEST(RelativeTrackTest, ADetectionIsWeighedByHand) {
    MotionChange change;
    change.moving_probability = 0.25;
    change.start_every = change.stop_every = std::numeric_limits<double>::infinity();
    change.velocity_std = 2;
    RelativeTrack track = RelativeTrack::unknown(ahead, change);
    track.predict({no_move, 0.5}, {TargetModelKind::cv, 0, 0}, change);
    EXPECT_EQ(track.movingProbability(), 0.25);
    // Straight ahead range is x and bearing y / 10. Position variances: still 0.04, 0.09; moving 1 m^2 more.
    const auto detection = detectionOf({11, 0.05}, Vector2(0.02, 1e-3).asDiagonal());
    const double still = logNormal(1, 0.04 + 0.02) + logNormal(0.05, 0.0009 + 1e-3);
    const double moving = logNormal(1, 1.04 + 0.02) + logNormal(0.05, 0.0109 + 1e-3);
    const double both = 0.75 * std::exp(still) + 0.25 * std::exp(moving);
    const auto match = track.match(detection, {});
    EXPECT_NEAR(match.log_likelihood, std::log(both), 1e-12);
    // Moments: 3/4 and 1/4 of the variances; both means are the same.
    const double range = 0.04 + 0.25 + 0.02, bearing = 0.0009 + 0.0025 + 1e-3;
    EXPECT_NEAR(match.nis, 1 / range + 0.05 * 0.05 / bearing, 1e-12);
    EXPECT_TRUE(near(track.expected({}).covariance, Matrix2(Vector2(0.29, 0.0034).asDiagonal()), rounding));
    track.update(detection, {});
    EXPECT_NEAR(track.movingProbability(), 0.25 * std::exp(moving) / both, 1e-12);
    EXPECT_NEAR(track.asLandmark().mean.x(), 10 + 0.04 / 0.06, 1e-12);
    EXPECT_NEAR(track.asMover().mean.x(), 10 + 1.04 / 1.06, 1e-12);
    EXPECT_NEAR(track.asMover().mean(2), 2.0 / 1.06, 1e-12);  // covariance 4 * 0.5 to the velocity
}

TEST(RelativeTrackTest, WhatIsKnownStaysKnown) {
    const TargetModel model{TargetModelKind::cv, 0.5, 0.1};
    RelativeTrack still = RelativeTrack::still(ahead), mover = RelativeTrack::moving(ahead, 3, 0);
    for (int i = 1; i <= 20; ++i) {
        const auto detection = detectionOf({10 + 0.3 * i, 0});
        for (RelativeTrack* track : {&still, &mover}) {
            track->predict({no_move, 0.1}, model, {});
            track->update(detection, {});
        }
    }
    EXPECT_EQ(still.movingProbability(), 0);
    EXPECT_EQ(mover.movingProbability(), 1);
    EXPECT_NEAR(mover.asMover().mean(2), 3, 0.2);  // it is seen to move by 3 m/s, without noise
}

TEST(RelativeTrackTest, NoEvidenceSettlesTheMotionForEver) {
    const TargetModel model{TargetModelKind::cv, 0.5, 0.1};
    RelativeTrack track = RelativeTrack::unknown(ahead, {});
    for (int i = 1; i <= 50; ++i) {
        track.predict({no_move, 0.1}, model, {});
        track.update(detectionOf({10 + 1.0 * i, 0}), {});
        ASSERT_LT(track.movingProbability(), 1);
    }
    EXPECT_GT(track.movingProbability(), 0.999);
}

}  // namespace relative_track_test
}  // namespace slamot
