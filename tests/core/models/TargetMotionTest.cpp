#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "slamot/core/models/TargetMotion.h"
#include "support/AutoDiff.h"
#include "support/Expect.h"

namespace slamot {
namespace target_motion_test {

using test::jacobian;
using test::near;

Vector6 state(double px, double py, double vx, double vy, double ax, double ay) {
    return (Vector6() << px, py, vx, vy, ax, ay).finished();
}

/// Ordinary, standing, all but standing, straight, turning hardly (angles around the switch to series, 1e-4),
/// turning hard.
const std::vector<Vector6> states = {
    state(1, -2, 3, 1, 0.2, -0.4),  state(5, 5, 0, 0, 0, 0),        state(5, 5, 0, 0, 0.3, -0.2),
    state(0, 0, 1e-9, -1e-9, 0, 0), state(0, 0, 1e-3, 2e-3, 1, -1), state(0, 0, -2, 0, 0, 0),
    state(3, 1, 2, 0, 0, 2e-9),     state(3, 1, 2, 0, 0, -2e-9),    state(3, 1, 1, 0, 0, 0.99e-3),
    state(3, 1, 1, 0, 0, 1.1e-3),   state(3, 1, 1, 0, 0, -1.1e-3),  state(-50, 90, 0.5, -1, 3, 3)};
const std::vector<double> steps = {0.1, 1.0};

TargetModel modelOf(TargetModelKind kind, double turn_rate = 0) {
    TargetModel model;
    model.kind = kind;
    model.turn_rate = turn_rate;
    return model;
}

/// All kinds, ct at several rates.
std::vector<TargetModel> allModels() {
    std::vector<TargetModel> models;
    for (const auto kind : {TargetModelKind::cv, TargetModelKind::ca, TargetModelKind::unicycle})
        models.push_back(modelOf(kind));
    for (const double w : {0.0, 1e-9, -1e-9, 0.99e-4, 1.1e-4, -1e-3, 0.5, -2.0})
        models.push_back(modelOf(TargetModelKind::ct, w));
    return models;
}

template <class S>
Eigen::Matrix<S, 6, 1> motionOf(const TargetModel& model, const Eigen::Matrix<S, 6, 1>& x, double dt) {
    switch (model.kind) {
        case TargetModelKind::cv:
            return cvMotion(x, dt);
        case TargetModelKind::ca:
            return caMotion(x, dt);
        case TargetModelKind::ct:
            return ctMotion(x, S(model.turn_rate), dt);
        case TargetModelKind::unicycle:
            return unicycleMotion(x, dt);
    }
    return x;
}

TEST(TargetMotionTest, JacobiansAreThoseOfTheModels) {
    for (const TargetModel& model : allModels())
        for (const Vector6& x : states)
            for (const double dt : steps) {
                const auto out = predictTarget(model, x, dt);
                const auto F = jacobian<6>(
                    [&](const auto& q) {
                        using S = typename std::decay_t<decltype(q)>::Scalar;
                        return motionOf<S>(model, q, dt);
                    },
                    x);
                EXPECT_TRUE(near(out.mean, motionOf<double>(model, x, dt), 1e-15));
                // Derivatives of sin(a)/a lose four digits where a is just above 1e-4.
                EXPECT_TRUE(near(out.F, F, 1e-11)) << model.name() << " " << x.transpose() << " dt " << dt;
            }
}

Matrix6 turn(double angle) {
    Matrix6 R = Matrix6::Zero();
    for (int i = 0; i < 6; i += 2) R.block<2, 2>(i, i) = rotation(angle);
    return R;
}

TEST(TargetMotionTest, AllModelsCommuteWithRotation) {
    for (const TargetModel& model : allModels())
        for (const Vector6& x : states)
            for (const double angle : {0.7, -2.0, pi / 2, 3.1}) {
                const Matrix6 R = turn(angle);
                const auto plain = predictTarget(model, x, 0.5), turned = predictTarget(model, R * x, 0.5);
                EXPECT_TRUE(near(turned.mean, R * plain.mean, 1e-13)) << model.name() << " " << x.transpose();
                EXPECT_TRUE(near(turned.F, R * plain.F * R.transpose(), 1e-11))
                    << model.name() << " " << x.transpose();
                EXPECT_TRUE(near(turned.Q, R * plain.Q * R.transpose(), 1e-13))
                    << model.name() << " " << x.transpose();
            }
}

TEST(TargetMotionTest, NoisePerStepIsThatOfThePapers) {
    // q^2 g g^t on each axis, g = (dt^2/2, dt) for cv, (dt^3/6, dt^2/2, dt) for ca
    // (tests/data/golden/paper1).
    const double dt = 0.15, q = 1.8;
    const Vector3 g_cv(dt * dt / 2, dt, 0), g_ca(dt * dt * dt / 6, dt * dt / 2, dt);
    for (const auto& [kind, g] : {std::pair{TargetModelKind::cv, g_cv}, std::pair{TargetModelKind::ct, g_cv},
                                  std::pair{TargetModelKind::ca, g_ca}}) {
        TargetModel model = modelOf(kind);
        model.noise_std = q;
        const Matrix6 Q = predictTarget(model, states[0], dt).Q;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                EXPECT_TRUE(
                    near(Q.block<2, 2>(2 * i, 2 * j), q * q * g(i) * g(j) * Matrix2::Identity(), 1e-15))
                    << model.name();
    }
}

TEST(TargetMotionTest, NoiseWithAnIntervalComposes) {
    const double dt = 0.6;
    for (const auto kind : {TargetModelKind::cv, TargetModelKind::ca}) {
        TargetModel model = modelOf(kind);
        model.noise_interval = 0.25;
        const auto whole = predictTarget(model, states[0], dt),
                   half = predictTarget(model, states[0], dt / 2);
        EXPECT_TRUE(near(half.F * half.Q * half.F.transpose() + half.Q, whole.Q, 1e-15)) << model.name();
        // Velocity (cv) or acceleration (ca) is a random walk of density q^2 * interval.
        const int last = kind == TargetModelKind::cv ? 2 : 4;
        EXPECT_NEAR(whole.Q(last, last), 0.5 * 0.5 * 0.25 * dt, 1e-15) << model.name();
    }
}

TEST(TargetMotionTest, ModelsWithoutAccelerationForgetIt) {
    for (const auto kind : {TargetModelKind::cv, TargetModelKind::ct}) {
        const auto out = predictTarget(modelOf(kind, 0.3), state(0, 0, 1, 2, 3, 4), 0.5);
        EXPECT_TRUE(out.mean.tail<2>().isZero(0));
        EXPECT_TRUE(out.F.rightCols<2>().isZero(0) && out.F.bottomRows<2>().isZero(0));
        EXPECT_TRUE(out.Q.rightCols<2>().isZero(0) && out.Q.bottomRows<2>().isZero(0));
    }
}

TEST(TargetMotionTest, HandComputedSteps) {
    // ca: p = 1 + 2*2 + 3*2^2/2 = 11, v = 2 + 3*2 = 8.
    EXPECT_TRUE(near(predictTarget(modelOf(TargetModelKind::ca), state(1, 0, 2, 0, 3, 0), 2).mean,
                     state(11, 0, 8, 0, 3, 0), 1e-15));
    // ct at pi/2 rad/s for 1 s with speed 1 along x: a quarter circle of radius 2/pi to the left.
    EXPECT_TRUE(near(predictTarget(modelOf(TargetModelKind::ct, pi / 2), state(0, 0, 1, 0, 9, 9), 1).mean,
                     state(2 / pi, 2 / pi, 0, 1, 0, 0), 1e-15));
    // unicycle: speed 2, centripetal acceleration 1 to the left, w = (2*1)/(4 + 0.0025); it stays
    // centripetal.
    const double w = 2 / 4.0025;
    const auto out = predictTarget(modelOf(TargetModelKind::unicycle), state(0, 0, 2, 0, 0, 1), 1).mean;
    EXPECT_TRUE(near(out,
                     state(2 * std::sin(w) / w, 2 * (1 - std::cos(w)) / w, 2 * std::cos(w), 2 * std::sin(w),
                           -w * 2 * std::sin(w), w * 2 * std::cos(w)),
                     1e-14));
}

TEST(TargetMotionTest, UnicycleNoiseLiesAlongTheHeading) {
    TargetModel model = modelOf(TargetModelKind::unicycle);
    model.turn_rate_std = 0.1;
    // Straight along x at 100 m/s, where the standing part, (0.05/100)^2, is below 3e-7 of the whole.
    const Matrix6 Q = predictTarget(model, state(0, 0, 100, 0, 0, 0), 1).Q;
    const double q2 = model.noise_std * model.noise_std;
    EXPECT_NEAR(Q(2, 2), q2, 1e-12);
    EXPECT_LT(Q(3, 3), 3e-7 * q2);
    // Turn-rate noise shows as centripetal acceleration: (0.1 * 100)^2 across, nothing along.
    EXPECT_NEAR(Q(5, 5), 100, 1e-10);
    EXPECT_NEAR(Q(4, 4), 0, 1e-10);
}

}  // namespace target_motion_test
}  // namespace slamot
