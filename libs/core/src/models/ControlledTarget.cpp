#include "slamot/core/models/ControlledTarget.h"

#include <cmath>

namespace slamot {
ControlledPrediction predictControlled(const ControlledTarget& p, const Vector3& x, double dt) {
    const Vector2 u(p.speed, p.turn_rate);
    const double turn = p.turn_rate * dt;
    // The step is `chord` long for each m/s, along `course`; how both answer to the turn rate.
    double chord = dt, course = x(2) + turn, d_chord = 0, d_course = dt;
    ControlledPrediction out;
    if (p.path == ControlledPath::printed) {
        out.pose = controlledMotion<double>(x, u, dt);
    } else {
        out.pose = controlledArc<double>(x, u, dt);
        chord = dt * sinc(0.5 * turn);
        course = x(2) + 0.5 * turn;
        d_chord = 0.5 * dt * dt * sincDerivative(0.5 * turn);
        d_course = 0.5 * dt;
    }
    const Vector2 along(std::cos(course), std::sin(course)), across(-along.y(), along.x());
    out.F.setIdentity();
    out.F.topRightCorner<2, 1>() = p.speed * chord * across;
    Eigen::Matrix<double, 3, 2> H_u;
    H_u.topLeftCorner<2, 1>() = chord * along;
    H_u.topRightCorner<2, 1>() = p.speed * (d_chord * along + chord * d_course * across);
    H_u.row(2) << 0, dt;
    const double draws = p.noise_interval > 0 && dt > 0 ? p.noise_interval / dt : 1;
    const Vector2 Q_u(draws * p.speed_std * p.speed_std, draws * p.turn_rate_std * p.turn_rate_std);
    out.Q = H_u * Q_u.asDiagonal() * H_u.transpose();
    return out;
}

ControlledState controlledState(const ControlledTarget& p, const Vector3& x) {
    const Vector2 along(std::cos(x(2)), std::sin(x(2))), across(-along.y(), along.x());
    const double v = p.speed, w = p.turn_rate;
    ControlledState out;
    out.mean << x.head<2>(), v * along, v * w * across;
    out.G.setZero();
    out.G.topLeftCorner<2, 2>().setIdentity();
    out.G.block<2, 1>(2, 2) = v * across;
    out.G.block<2, 1>(4, 2) = -v * w * along;
    Eigen::Matrix<double, 6, 2> G_u = Eigen::Matrix<double, 6, 2>::Zero();
    G_u.block<2, 1>(2, 0) = along;
    G_u.block<2, 1>(4, 0) = w * across;
    G_u.block<2, 1>(4, 1) = v * across;
    const Vector2 Q_u(p.speed_std * p.speed_std, p.turn_rate_std * p.turn_rate_std);
    out.Q = G_u * Q_u.asDiagonal() * G_u.transpose();
    return out;
}

ParameterTable describe(ControlledTarget& p, const std::string& section) {
    ParameterTable table(section,
                         "Where motion = control: movers [x y theta] driven by a speed and a turn rate that are known "
                         "but for noise (paper 2).");
    table.real("speed", p.speed, "m/s", Interval::nonNegative(), "Speed along the heading.")
        .real("turn_rate_deg", p.turn_rate, "deg/s", Interval::any(), "Turn rate.")
        .real("speed_std", p.speed_std, "m/s", Interval::nonNegative(), "Noise of the speed.")
        .real("turn_rate_std_deg", p.turn_rate_std, "deg/s", Interval::nonNegative(), "Noise of the turn rate.")
        .real("noise_interval", p.noise_interval, "s", Interval::nonNegative(),
              "How long one draw of the noise holds; 0: for each prediction step, which makes the noise depend on the "
              "rate of the odometry.")
        .choice("path", p.path, {{"arc", ControlledPath::arc}, {"printed", ControlledPath::printed}},
                "arc: along the exact arc; printed: straight along the heading that the step ends with (eq. 16).")
        .integer("headings", p.headings, Interval::between(1, 360),
                 "A range and a bearing show no heading: a mover starts with so many, equally spaced, until all but "
                 "those near one another are refuted. 1: one Gaussian of all headings.");
    return table;
}

}  // namespace slamot
