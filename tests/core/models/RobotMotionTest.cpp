#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "slamot/core/models/RobotMotion.h"
#include "support/AutoDiff.h"
#include "support/Expect.h"

namespace slamot {
namespace robot_motion_test {

using test::jacobian;
using test::near;

/// Closed forms and automatic differentiation evaluate the same few products: rounding only.
constexpr double rounding = 1e-13;
constexpr double B = 2.5, dt = 0.2;

const std::vector<Vector3> poses = {{0, 0, 0},          {3, -2, 1.3},        {-40, 7, pi},   {1, 1, -pi},
                                    {5, 5, pi - 1e-12}, {5, 5, -pi + 1e-12}, {0, 1, -pi / 2}};
const std::vector<std::array<double, 2>> steered_controls = {
    {2, 0}, {2, 0.3}, {-2, -0.4}, {-2, 0}, {0, 0}, {1e-9, 0.2}, {3, radians(89)}, {-3, radians(-89)}};
const std::vector<std::array<double, 2>> turning_controls = {{2, 0},  {2, 0.5},  {-1, 0.5}, {0, 0},
                                                             {0, -3}, {2, 1e-9}, {2, -1e-9}};
const std::vector<Pose2> increments = {{0.4, 0, 0},    {0.4, 0.1, 0.3}, {-0.4, 0.05, -0.2},
                                       {0, 0, 0},      {0, 0, pi},      {0.3, -0.2, -3.1},
                                       {0.4, 0, 1e-9}, {0.4, 0, -1e-9}, {1e-9, 1e-9, 0.1}};

OdometryIncrement velocityEntry(const BodyVelocity& velocity, double seconds = dt) {
    OdometryIncrement entry;
    entry.t1 = Stamp::fromSeconds(seconds);
    entry.velocity = velocity;
    entry.entry_seconds = seconds;
    return entry;
}

OdometryIncrement poseEntry(const Pose2& increment) {
    OdometryIncrement entry;
    entry.t1 = Stamp::fromSeconds(dt);
    entry.increment = increment;
    entry.entry_seconds = dt;
    return entry;
}

RobotMotionParameters parametersOf(RobotMotionModel model) {
    RobotMotionParameters p;
    p.model = model;
    p.wheelbase = B;
    return p;
}

double square(double a) {
    return a * a;
}

TEST(RobotMotionTest, SteeredJacobiansAreThoseOfTheModel) {
    const auto p = parametersOf(RobotMotionModel::steered);
    const Matrix2 Qu = Vector2(square(p.speed_std), square(p.steering_std)).asDiagonal();
    for (const Vector3& x : poses)
        for (const auto& [v, gamma] : steered_controls) {
            const auto out = predictMotion(p, x, velocityEntry(steeredToBody(v, gamma, B)));
            const Vector2 u(v, gamma);
            const auto F = jacobian<3>(
                [&](const auto& q) {
                    using S = typename std::decay_t<decltype(q)>::Scalar;
                    return steeredMotion<S>(q, u.cast<S>(), dt, B);
                },
                x);
            const auto G = jacobian<2>(
                [&](const auto& c) {
                    using S = typename std::decay_t<decltype(c)>::Scalar;
                    return steeredMotion<S>(x.cast<S>(), c, dt, B);
                },
                u);
            EXPECT_TRUE(near(out.F, F, rounding)) << x.transpose() << " u " << u.transpose();
            EXPECT_TRUE(near(out.Q, G * Qu * G.transpose(), rounding))
                << x.transpose() << " u " << u.transpose();
        }
}

TEST(RobotMotionTest, DifferentialJacobiansAreThoseOfTheModel) {
    const auto p = parametersOf(RobotMotionModel::differential);
    const Matrix2 Qu = Vector2(square(p.speed_std), square(p.turn_rate_std)).asDiagonal();
    for (const Vector3& x : poses)
        for (const auto& [v, omega] : turning_controls) {
            const auto out = predictMotion(p, x, velocityEntry({v, 0, omega}));
            const Vector2 u(v, omega);
            const auto F = jacobian<3>(
                [&](const auto& q) {
                    using S = typename std::decay_t<decltype(q)>::Scalar;
                    return differentialMotion<S>(q, u.cast<S>(), dt);
                },
                x);
            const auto G = jacobian<2>(
                [&](const auto& c) {
                    using S = typename std::decay_t<decltype(c)>::Scalar;
                    return differentialMotion<S>(x.cast<S>(), c, dt);
                },
                u);
            EXPECT_TRUE(near(out.F, F, rounding)) << x.transpose() << " u " << u.transpose();
            EXPECT_TRUE(near(out.Q, G * Qu * G.transpose(), rounding))
                << x.transpose() << " u " << u.transpose();
        }
}

/// [along across turn]: variances grow with the distance and the turn.
Matrix3 randomWalk(const RobotMotionParameters& p, double distance, double turn) {
    return Vector3(square(p.along_std_per_sqrt_m) * distance, square(p.across_std_per_sqrt_m) * distance,
                   square(p.heading_std_per_sqrt_m) * distance + square(p.heading_std_per_sqrt_rad) * turn)
        .asDiagonal();
}

TEST(RobotMotionTest, ArcJacobiansAreThoseOfTheModel) {
    const auto p = parametersOf(RobotMotionModel::arc);
    for (const Vector3& x : poses)
        for (const Pose2& d : increments) {
            const auto out = predictMotion(p, x, poseEntry(d));
            const double ds = d.x * std::cos(d.theta / 2) + d.y * std::sin(d.theta / 2);
            const Vector3 u(ds, 0, d.theta);
            const auto F = jacobian<3>(
                [&](const auto& q) {
                    using S = typename std::decay_t<decltype(q)>::Scalar;
                    return arcMotion<S>(q, u.cast<S>());
                },
                x);
            const auto G = jacobian<3>(
                [&](const auto& c) {
                    using S = typename std::decay_t<decltype(c)>::Scalar;
                    return arcMotion<S>(x.cast<S>(), c);
                },
                u);
            const Matrix3 Qu = randomWalk(p, std::abs(ds), std::abs(d.theta));
            EXPECT_TRUE(near(out.F, F, rounding)) << x.transpose() << " u " << u.transpose();
            EXPECT_TRUE(near(out.Q, G * Qu * G.transpose(), rounding))
                << x.transpose() << " u " << u.transpose();
        }
}

TEST(RobotMotionTest, IncrementJacobiansAreThoseOfTheModel) {
    const auto p = parametersOf(RobotMotionModel::increment);
    const Matrix3 log_covariance = (Matrix3() << 4, 1, 0.5, 1, 3, -0.3, 0.5, -0.3, 2).finished() * 1e-2;
    for (const Vector3& x : poses)
        for (const Pose2& d : increments) {
            OdometryIncrement entry = poseEntry(d);
            const auto G = jacobian<3>(
                [&](const auto& c) {
                    using S = typename std::decay_t<decltype(c)>::Scalar;
                    return incrementMotion<S>(x.cast<S>(), c);
                },
                d.vector());
            const auto F = jacobian<3>(
                [&](const auto& q) {
                    using S = typename std::decay_t<decltype(q)>::Scalar;
                    return incrementMotion<S>(q, d.vector().cast<S>());
                },
                x);
            const Matrix3 walk = randomWalk(p, std::hypot(d.x, d.y), std::abs(d.theta));
            const auto out = predictMotion(p, x, entry);
            EXPECT_TRUE(near(out.F, F, rounding)) << x.transpose();
            EXPECT_TRUE(near(out.Q, G * walk * G.transpose(), rounding)) << x.transpose();

            entry.covariance = log_covariance;
            EXPECT_TRUE(near(predictMotion(p, x, entry).Q, G * log_covariance * G.transpose(), rounding));
        }
}

TEST(RobotMotionTest, ArcIsCompositionForIncrementsOnAnArc) {
    const auto arc = parametersOf(RobotMotionModel::arc), plain = parametersOf(RobotMotionModel::increment);
    const Matrix3 covariance = (Matrix3() << 4, 1, 0.5, 1, 3, -0.3, 0.5, -0.3, 2).finished() * 1e-2;
    for (const Vector3& x : poses)
        for (const double turn : {0.0, 0.4, -1.2, 3.0, 1e-9})
            for (const double chord : {0.5, -0.5, 0.0}) {
                // The chord of an arc points half the turn to the side.
                OdometryIncrement entry =
                    poseEntry({chord * std::cos(turn / 2), chord * std::sin(turn / 2), turn});
                const auto a = predictMotion(arc, x, entry), b = predictMotion(plain, x, entry);
                EXPECT_TRUE(near(a.pose.head<2>(), b.pose.head<2>(), rounding));
                EXPECT_NEAR(angleDifference(a.pose.z(), b.pose.z()), 0, 1e-13);
                EXPECT_TRUE(near(a.F, b.F, rounding));
                // A covariance of the increment means the same to both.
                entry.covariance = covariance;
                EXPECT_TRUE(near(predictMotion(arc, x, entry).Q, predictMotion(plain, x, entry).Q, rounding))
                    << "turn " << turn << " chord " << chord;
            }
}

TEST(RobotMotionTest, PoseMatchesTheModelAndIsWrapped) {
    const auto p = parametersOf(RobotMotionModel::differential);
    // theta 3.1 + 1 rad/s * 0.2 s = 3.3 -> 3.3 - 2 pi; x += 2 * 0.2 cos(3.1).
    const auto out = predictMotion(p, {1, 2, 3.1}, velocityEntry({2, 0, 1}));
    EXPECT_NEAR(out.pose.x(), 1 + 0.4 * std::cos(3.1), 1e-15);
    EXPECT_NEAR(out.pose.y(), 2 + 0.4 * std::sin(3.1), 1e-15);
    EXPECT_NEAR(out.pose.z(), 3.3 - 2 * pi, 1e-14);
}

TEST(RobotMotionTest, LogCovarianceCanBeTurnedOff) {
    auto p = parametersOf(RobotMotionModel::increment);
    OdometryIncrement entry = poseEntry({0.4, 0, 0});
    const Matrix3 walk = predictMotion(p, {0, 0, 0}, entry).Q;
    entry.covariance = Matrix3::Identity();
    EXPECT_TRUE(near(predictMotion(p, {0, 0, 0}, entry).Q, Matrix3::Identity(), rounding));
    p.use_log_covariance = false;
    EXPECT_EQ(predictMotion(p, {0, 0, 0}, entry).Q, walk);
}

/// Variance after an entry cut in `pieces`: P <- F P F^t + Q over the pieces.
Matrix3 varianceInPieces(const RobotMotionParameters& p, const BodyVelocity& velocity, int pieces,
                         double seconds) {
    Vector3 x = Vector3::Zero();
    Matrix3 P = Matrix3::Zero();
    OdometryIncrement rest = velocityEntry(velocity, seconds);
    for (int i = 0; i < pieces; ++i) {
        OdometryIncrement piece = rest;
        if (i + 1 < pieces) {
            const Stamp cut = Stamp::fromSeconds(seconds * (i + 1) / pieces);
            const OdometrySplit cut_in_two = split(rest, cut);
            piece = cut_in_two.before;
            rest = cut_in_two.after;
        }
        const auto out = predictMotion(p, x, piece);
        x = out.pose;
        P = out.F * P * out.F.transpose() + out.Q;
    }
    return P;
}

TEST(RobotMotionTest, CuttingAStraightEntryKeepsTheVarianceExactly) {
    // Speed noise: (k pieces) * sigma^2 (T/k)^2 * k = sigma^2 T^2; turn noise likewise. Across the path
    // pieces add the lever of earlier turns, which a single Euler step does not know; it is of higher order
    // in T.
    const auto differential = parametersOf(RobotMotionModel::differential);
    const auto steered = parametersOf(RobotMotionModel::steered);
    for (const int pieces : {2, 4, 5}) {
        const Matrix3 d = varianceInPieces(differential, {2, 0, 0}, pieces, dt);
        EXPECT_NEAR(d(0, 0), square(differential.speed_std * dt), 1e-15);
        EXPECT_NEAR(d(2, 2), square(differential.turn_rate_std * dt), 1e-15);
        const Matrix3 s = varianceInPieces(steered, steeredToBody(2, 0, B), pieces, dt);
        EXPECT_NEAR(s(0, 0), square(steered.speed_std * dt), 1e-15);
        EXPECT_NEAR(s(2, 2), square(2 * dt / B * steered.steering_std), 1e-15);
    }
}

TEST(RobotMotionTest, CuttingATurningEntryKeepsTheVarianceToFirstOrder) {
    const auto p = parametersOf(RobotMotionModel::steered);
    const auto relativeChange = [&](double seconds) {
        const BodyVelocity u = steeredToBody(2, 0.4, B);
        const Matrix3 whole = varianceInPieces(p, u, 1, seconds), cut = varianceInPieces(p, u, 4, seconds);
        return (cut - whole).norm() / whole.norm();
    };
    // The change vanishes with the length of the entry: linearly, so a quarter of it leaves at most about a
    // quarter.
    EXPECT_LT(relativeChange(0.1), 0.1);
    EXPECT_LT(relativeChange(0.025), 0.3 * relativeChange(0.1));
    // Without the scale of the control variance four pieces would lose three quarters of it.
    EXPECT_GT(varianceInPieces(p, steeredToBody(2, 0.4, B), 4, 0.1).trace(),
              0.9 * varianceInPieces(p, steeredToBody(2, 0.4, B), 1, 0.1).trace());
}

TEST(RobotMotionTest, SteeringConventionIsInvertible) {
    for (const double v : {2.0, 0.01, -0.01, -5.0})
        for (double degrees_gamma = -89; degrees_gamma <= 89; degrees_gamma += 0.5) {
            const double gamma = radians(degrees_gamma);
            const SteeredControl back = bodyToSteered(steeredToBody(v, gamma, B));
            EXPECT_NEAR(back.v, v, 1e-14 * std::abs(v)) << degrees_gamma;
            EXPECT_NEAR(back.gamma, gamma, 1e-14) << degrees_gamma;
        }
    for (const double gamma : {-1.0, 0.0, 1.0}) {
        const SteeredControl back = bodyToSteered(steeredToBody(0, gamma, B));
        EXPECT_EQ(back.v, 0);
        EXPECT_EQ(back.gamma, 0);
    }
    // v = -2, gamma = 30 deg, B = 2.5: (-2 cos 30, -2 sin 30, -2 sin 30 / 2.5) = (-1.732.., -1, -0.4).
    const BodyVelocity body = steeredToBody(-2, radians(30), B);
    EXPECT_NEAR(body.vx, -std::sqrt(3.0), 1e-15);
    EXPECT_NEAR(body.vy, -1, 1e-15);
    EXPECT_NEAR(body.omega, -0.4, 1e-15);
}

TEST(RobotMotionTest, NamesTheFieldALogLacks) {
    const OdometryIncrement none = poseEntry({1, 0, 0});
    EXPECT_EQ(missingField(parametersOf(RobotMotionModel::steered), none), "velocity");
    EXPECT_EQ(missingField(parametersOf(RobotMotionModel::differential), none), "velocity");
    EXPECT_EQ(missingField(parametersOf(RobotMotionModel::arc), none), "");
    EXPECT_EQ(missingField(parametersOf(RobotMotionModel::increment), none), "");
    EXPECT_EQ(missingField(parametersOf(RobotMotionModel::steered), velocityEntry({})), "");
}

}  // namespace robot_motion_test
}  // namespace slamot
