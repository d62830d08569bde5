#include "slamot/core/models/TargetMotion.h"

#include <cmath>

namespace slamot {
namespace {

using AxisNoise = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

/// Noise of the chain of integrators [p v] or [p v a], driven at its last derivative, for one axis.
/// interval 0: one draw over the step, g g^t q^2 with g = (dt^n/n!, ..., dt); else white noise of density
/// q^2 * interval.
AxisNoise chainNoise(int order, double q, double interval, double dt) {
    AxisNoise noise(order, order);
    const auto power = [](double x, int n) { return std::pow(x, n) / std::tgamma(n + 1.0); };
    for (int i = 0; i < order; ++i)
        for (int j = 0; j < order; ++j) {
            // Derivative i of the chain answers to the noise through n - i integrations.
            const int a = order - i, b = order - j;
            noise(i, j) = interval <= 0
                              ? q * q * power(dt, a) * power(dt, b)
                              : q * q * interval * std::pow(dt, a + b - 1) / ((a + b - 1) * std::tgamma(a) * std::tgamma(b));
        }
    return noise;
}

/// The same noise on both axes of [p v a], for the first `order` derivatives.
Matrix6 isotropicNoise(int order, const TargetModel& model, double dt) {
    const AxisNoise axis = chainNoise(order, model.noise_std, model.noise_interval, dt);
    Matrix6 Q = Matrix6::Zero();
    for (int i = 0; i < order; ++i)
        for (int j = 0; j < order; ++j) Q.block<2, 2>(2 * i, 2 * j) = axis(i, j) * Matrix2::Identity();
    return Q;
}

Matrix6 transitionCv(double dt) {
    Matrix6 F = Matrix6::Zero();
    F.topLeftCorner<4, 4>().setIdentity();
    F.block<2, 2>(0, 2) = dt * Matrix2::Identity();
    return F;
}

Matrix6 transitionCa(double dt) {
    Matrix6 F = Matrix6::Identity();
    F.block<2, 2>(0, 2) = F.block<2, 2>(2, 4) = dt * Matrix2::Identity();
    F.block<2, 2>(0, 4) = 0.5 * dt * dt * Matrix2::Identity();
    return F;
}

Matrix6 transitionCt(double turn_rate, double dt) {
    const double angle = turn_rate * dt;
    Matrix6 F = Matrix6::Zero();
    F.block<2, 2>(0, 0).setIdentity();
    F.block<2, 2>(0, 2) = dt * (sinc(angle) * Matrix2::Identity() + versc(angle) * quarterTurn());
    F.block<2, 2>(2, 2) = rotation(angle);
    return F;
}

/// d unicycleMotion / dx: the arc at the state's own turn rate w, plus how w answers to v and a.
Matrix6 transitionUnicycle(const Vector6& x, const Vector6& moved, double dt) {
    const Vector2 v = x.segment<2>(2), a = x.segment<2>(4), v_moved = moved.segment<2>(2);
    const double w = unicycleTurnRate(x), angle = w * dt;
    const double speed2 = v.squaredNorm() + unicycle_speed_floor * unicycle_speed_floor;
    const Matrix2 J = quarterTurn();

    Eigen::Matrix<double, 1, 6> dw = Eigen::Matrix<double, 1, 6>::Zero();
    dw.segment<2>(2) = (-(J * a).transpose() - 2.0 * w * v.transpose()) / speed2;
    dw.segment<2>(4) = (J * v).transpose() / speed2;

    Matrix6 F = transitionCt(w, dt);
    // d/dw of dt (sinc I + versc J) v: the mean over the arc of s J Rot(w s) v.
    const bool is_small = std::abs(angle) < 1e-4;
    const double s = std::sin(angle), h = std::sin(0.5 * angle), d_sinc = sincDerivative(angle);
    // 1 - cos as 2 sin^2(half): the difference loses half its digits at small angles.
    const double d_versc = is_small ? 0.5 - angle * angle / 8.0 : (angle * s - 2.0 * h * h) / (angle * angle);
    F.topRows<2>() += dt * dt * ((d_sinc * Matrix2::Identity() + d_versc * J) * v) * dw;
    F.middleRows<2>(2) += dt * (J * v_moved) * dw;
    F.bottomRows<2>() = w * J * F.middleRows<2>(2) + (J * v_moved) * dw;
    return F;
}

/// Speed noise along the heading; turn-rate noise through the centripetal acceleration, J v dw.
Matrix6 unicycleNoise(const TargetModel& model, const Vector6& moved, double dt) {
    const Vector2 v = moved.segment<2>(2);
    const double speed = v.norm();
    const Vector2 heading = speed > 0 ? Vector2(v / speed) : Vector2::UnitX();
    const AxisNoise along = chainNoise(2, model.noise_std, model.noise_interval, dt);
    Matrix6 Q = Matrix6::Zero();
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) Q.block<2, 2>(2 * i, 2 * j) = along(i, j) * heading * heading.transpose();
    const double variance = model.turn_rate_std * model.turn_rate_std *
                            (model.noise_interval > 0 ? dt / model.noise_interval : 1.0);
    const Vector2 normal = quarterTurn() * v;
    Q.bottomRightCorner<2, 2>() = variance * normal * normal.transpose();
    // A target that stands still may start in any direction.
    const double floor2 = unicycle_speed_floor * unicycle_speed_floor;
    const double standing = floor2 / (speed * speed + floor2);
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            Q.block<2, 2>(2 * i, 2 * j) +=
                standing * along(i, j) * (Matrix2::Identity() - heading * heading.transpose());
    return Q;
}

}  // namespace

const char* toText(TargetModelKind kind) {
    switch (kind) {
        case TargetModelKind::cv: return "cv";
        case TargetModelKind::ca: return "ca";
        case TargetModelKind::ct: return "ct";
        case TargetModelKind::unicycle: return "unicycle";
    }
    return "cv";
}

TargetPrediction predictTarget(const TargetModel& model, const Vector6& x, double dt) {
    TargetPrediction out;
    switch (model.kind) {
        case TargetModelKind::cv:
            out = {cvMotion(x, dt), transitionCv(dt), isotropicNoise(2, model, dt)};
            break;
        case TargetModelKind::ca:
            out = {caMotion(x, dt), transitionCa(dt), isotropicNoise(3, model, dt)};
            break;
        case TargetModelKind::ct:
            out = {ctMotion(x, model.turn_rate, dt), transitionCt(model.turn_rate, dt),
                   isotropicNoise(2, model, dt)};
            break;
        case TargetModelKind::unicycle:
            out.mean = unicycleMotion(x, dt);
            out.F = transitionUnicycle(x, out.mean, dt);
            out.Q = unicycleNoise(model, out.mean, dt);
            break;
    }
    return out;
}

void describe(TargetModel& model, ParameterTable& table) {
    table
        .choice("model", model.kind,
                {{"cv", TargetModelKind::cv},
                 {"ca", TargetModelKind::ca},
                 {"ct", TargetModelKind::ct},
                 {"unicycle", TargetModelKind::unicycle}},
                "Motion of movers: constant velocity, constant acceleration, turn at a fixed rate, unicycle.")
        .real("noise_std", model.noise_std, "m/s^2 (ca: m/s^3)", Interval::nonNegative(),
              "Driving noise: acceleration for cv, ct and unicycle, jerk for ca.")
        .real("noise_interval", model.noise_interval, "s", Interval::nonNegative(),
              "How long one draw of the driving noise holds; 0: for each prediction step, which makes the noise "
              "depend on the rate of the odometry.")
        .real("turn_rate_deg", model.turn_rate, "deg/s", Interval::any(), "Turn rate of ct.")
        .real("turn_rate_std_deg", model.turn_rate_std, "deg/s", Interval::nonNegative(),
              "Change of the unicycle's turn rate over noise_interval (or a step).");
}

}  // namespace slamot
