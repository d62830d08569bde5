#pragma once
// How movers move. One state for all Gaussian estimators: x = [px py vx vy ax ay], world frame, SI units.
#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Pose2.h"
#include "slamot/core/data/Stamp.h"

namespace slamot {

enum class TargetModelKind {
    cv,       ///< constant velocity; acceleration is zero with zero covariance
    ca,       ///< constant acceleration
    ct,       ///< coordinated turn at a fixed rate; acceleration is zero with zero covariance
    unicycle  ///< constant speed along the heading and a turn rate carried by the centripetal acceleration
};

/// The word for a model in configs and files.
const char* toText(TargetModelKind kind);

/// One motion model of a mover.
struct TargetModel {
    TargetModelKind kind = TargetModelKind::cv;
    /// Driving noise, standard deviation: acceleration [m/s^2] for cv, ct and unicycle (along the heading), jerk
    /// [m/s^3] for ca.
    double noise_std = 0.5;
    /// How long [s] one draw of the driving noise holds. 0: for each prediction step, as the papers have it
    /// (piecewise constant). Above 0: white noise of density noise_std^2 * noise_interval, which makes a prediction
    /// over dt equal to two over dt/2.
    double noise_interval = 0;
    double turn_rate = 0;          ///< [rad/s], ct
    double turn_rate_std = radians(10.0);    ///< [rad/s], unicycle: change of turn rate over noise_interval (or a step)

    std::string name() const { return toText(kind); }
};

/// x' = f(x) without noise. Templates for automatic differentiation; all models commute with rotations of the
/// world.
template <class S>
Eigen::Matrix<S, 6, 1> cvMotion(const Eigen::Matrix<S, 6, 1>& x, double dt) {
    Eigen::Matrix<S, 6, 1> y = x;
    y.template segment<2>(0) += S(dt) * x.template segment<2>(2);
    y.template segment<2>(4).setZero();
    return y;
}

template <class S>
Eigen::Matrix<S, 6, 1> caMotion(const Eigen::Matrix<S, 6, 1>& x, double dt) {
    Eigen::Matrix<S, 6, 1> y = x;
    y.template segment<2>(0) += S(dt) * x.template segment<2>(2) + S(0.5 * dt * dt) * x.template segment<2>(4);
    y.template segment<2>(2) += S(dt) * x.template segment<2>(4);
    return y;
}

/// sin(a)/a and (1-cos(a))/a, smooth through a = 0.
template <class S>
S sinc(const S& a) {
    using std::sin;
    if (a * a < S(1e-8)) return S(1) - a * a / S(6);
    return sin(a) / a;
}
/// d sinc(a) / da.
inline double sincDerivative(double a) {
    return std::abs(a) < 1e-4 ? -a / 3.0 : (a * std::cos(a) - std::sin(a)) / (a * a);
}
template <class S>
S versc(const S& a) {
    using std::sin;
    if (a * a < S(1e-8)) return a / S(2) - a * a * a / S(24);
    const S h = sin(a / S(2));
    return S(2) * h * h / a;
}

/// p += dt (sinc(w dt) I + versc(w dt) J) v, v <- Rot(w dt) v, a <- 0.
template <class S>
Eigen::Matrix<S, 6, 1> ctMotion(const Eigen::Matrix<S, 6, 1>& x, const S& turn_rate, double dt) {
    using std::cos;
    using std::sin;
    const S angle = turn_rate * S(dt), f = S(dt) * sinc(angle), g = S(dt) * versc(angle);
    const S c = cos(angle), s = sin(angle), vx = x(2), vy = x(3);
    Eigen::Matrix<S, 6, 1> y;
    y << x(0) + f * vx - g * vy, x(1) + g * vx + f * vy, c * vx - s * vy, s * vx + c * vy, S(0), S(0);
    return y;
}

/// Below about this speed [m/s] a unicycle's turn rate fades to zero: it has no heading to turn.
inline constexpr double unicycle_speed_floor = 0.05;

/// Turn rate carried by the state: (v x a) / (|v|^2 + floor^2).
template <class S>
S unicycleTurnRate(const Eigen::Matrix<S, 6, 1>& x) {
    const S floor2 = S(unicycle_speed_floor * unicycle_speed_floor);
    return (x(2) * x(5) - x(3) * x(4)) / (x(2) * x(2) + x(3) * x(3) + floor2);
}

/// Turns at unicycleTurnRate along an exact arc; the acceleration becomes the centripetal one, w J v.
template <class S>
Eigen::Matrix<S, 6, 1> unicycleMotion(const Eigen::Matrix<S, 6, 1>& x, double dt) {
    const S w = unicycleTurnRate(x);
    Eigen::Matrix<S, 6, 1> y = ctMotion(x, w, dt);
    y(4) = -w * y(3);
    y(5) = w * y(2);
    return y;
}

/// Whether F and Q are the same for all states.
inline bool isLinear(TargetModelKind kind) {
    return kind != TargetModelKind::unicycle;
}

struct TargetPrediction {
    Vector6 mean;
    Matrix6 F;  ///< d f / d x
    Matrix6 Q;  ///< process noise
};

TargetPrediction predictTarget(const TargetModel& model, const Vector6& state, double dt);

/// Adds the keys of a model (`model`, `noise_std`, ...) to a table.
void describe(TargetModel& model, ParameterTable& table);

}  // namespace slamot
