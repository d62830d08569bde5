#include "slamot/core/models/RobotMotion.h"

#include <cmath>

namespace slamot {
namespace {

/// One draw of control noise holds over a whole odometry entry; a piece of it carries the share that makes the
/// variances of the pieces add up to the entry's.
double controlVarianceScale(const OdometryIncrement& odometry) {
    const double dt = odometry.seconds();
    return odometry.entry_seconds > dt && dt > 0 ? odometry.entry_seconds / dt : 1.0;
}

MotionPrediction predictSteered(const RobotMotionParameters& p, const Vector3& x, const OdometryIncrement& odometry) {
    const SteeredControl control = bodyToSteered(*odometry.velocity);
    const double dt = odometry.seconds(), step = control.v * dt, course = x.z() + control.gamma;
    const double c = std::cos(course), s = std::sin(course);

    MotionPrediction out;
    out.pose = steeredMotion<double>(x, {control.v, control.gamma}, dt, p.wheelbase);
    out.F << 1, 0, -step * s, 0, 1, step * c, 0, 0, 1;  // paper 1, eq. 29
    Eigen::Matrix<double, 3, 2> G;                      // paper 1, eq. 30
    G << dt * c, -step * s, dt * s, step * c, dt * std::sin(control.gamma) / p.wheelbase,
        step * std::cos(control.gamma) / p.wheelbase;
    const Vector2 q(p.speed_std * p.speed_std, p.steering_std * p.steering_std);
    out.Q = controlVarianceScale(odometry) * (G * q.asDiagonal() * G.transpose());
    return out;
}

MotionPrediction predictDifferential(const RobotMotionParameters& p, const Vector3& x,
                                     const OdometryIncrement& odometry) {
    const double v = odometry.velocity->vx, w = odometry.velocity->omega, dt = odometry.seconds();
    const double c = std::cos(x.z()), s = std::sin(x.z());

    MotionPrediction out;
    out.pose = differentialMotion<double>(x, {v, w}, dt);
    out.F << 1, 0, -v * dt * s, 0, 1, v * dt * c, 0, 0, 1;
    Eigen::Matrix<double, 3, 2> G;
    G << dt * c, 0, dt * s, 0, 0, dt;
    const Vector2 q(p.speed_std * p.speed_std, p.turn_rate_std * p.turn_rate_std);
    out.Q = controlVarianceScale(odometry) * (G * q.asDiagonal() * G.transpose());
    return out;
}

/// Covariance of a pose increment [along across turn] as random walks over the distance and the turn.
Matrix3 randomWalk(const RobotMotionParameters& p, double distance, double turn) {
    const auto square = [](double a) { return a * a; };
    return Vector3(square(p.along_std_per_sqrt_m) * distance, square(p.across_std_per_sqrt_m) * distance,
                   square(p.heading_std_per_sqrt_m) * distance + square(p.heading_std_per_sqrt_rad) * turn)
        .asDiagonal();
}

MotionPrediction predictArc(const RobotMotionParameters& p, const Vector3& x, const OdometryIncrement& odometry) {
    const Pose2& d = odometry.increment;
    // The chord's component along theta + dtheta/2; what lies across it no rolling robot can do.
    const double half = 0.5 * d.theta, ds = d.x * std::cos(half) + d.y * std::sin(half);
    const double course = x.z() + half, c = std::cos(course), s = std::sin(course);

    MotionPrediction out;
    out.pose = arcMotion<double>(x, {ds, 0.0, d.theta});
    out.F << 1, 0, -ds * s, 0, 1, ds * c, 0, 0, 1;
    Matrix3 G;
    G << c, -s, -0.5 * ds * s, s, c, 0.5 * ds * c, 0, 0, 1;
    Matrix3 Qu = randomWalk(p, std::abs(ds), std::abs(d.theta));
    if (odometry.covariance && p.use_log_covariance) {
        // d u / d increment: the chord's own direction turns with half the turn.
        const double dl = d.y * std::cos(half) - d.x * std::sin(half);
        Matrix3 to_chord = Matrix3::Identity();
        to_chord.topLeftCorner<2, 2>() = rotation(-half);
        to_chord.topRightCorner<2, 1>() << 0.5 * dl, -0.5 * ds;
        Qu = to_chord * *odometry.covariance * to_chord.transpose();
    }
    out.Q = G * Qu * G.transpose();
    return out;
}

MotionPrediction predictIncrement(const RobotMotionParameters& p, const Vector3& x,
                                  const OdometryIncrement& odometry) {
    const Pose2& d = odometry.increment;
    const double c = std::cos(x.z()), s = std::sin(x.z());

    MotionPrediction out;
    out.pose = incrementMotion<double>(x, d.vector());
    out.F << 1, 0, -d.x * s - d.y * c, 0, 1, d.x * c - d.y * s, 0, 0, 1;
    Matrix3 G;
    G << c, -s, 0, s, c, 0, 0, 0, 1;
    const Matrix3 Qu = odometry.covariance && p.use_log_covariance
                           ? *odometry.covariance
                           : randomWalk(p, std::hypot(d.x, d.y), std::abs(d.theta));
    out.Q = G * Qu * G.transpose();
    return out;
}

}  // namespace

ParameterTable describe(RobotMotionParameters& p) {
    ParameterTable table("motion", "How the robot moves and how far its odometry is trusted; shared by all estimators.");
    table
        .choice("model", p.model,
                {{"steered", RobotMotionModel::steered},
                 {"differential", RobotMotionModel::differential},
                 {"arc", RobotMotionModel::arc},
                 {"increment", RobotMotionModel::increment}},
                "steered and differential read the log's velocities, arc and increment its pose changes.")
        .real("wheelbase", p.wheelbase, "m", Interval::positive(), "Axle distance of the steered model.")
        .real("speed_std", p.speed_std, "m/s", Interval::nonNegative(),
              "Noise of the speed, one draw per odometry entry (steered, differential).")
        .real("steering_std_deg", p.steering_std, "deg", Interval::nonNegative(),
              "Noise of the steering angle, one draw per odometry entry (steered).")
        .real("turn_rate_std_deg", p.turn_rate_std, "deg/s", Interval::nonNegative(),
              "Noise of the turn rate, one draw per odometry entry (differential).")
        .real("along_std_per_sqrt_m", p.along_std_per_sqrt_m, "m/sqrt(m)", Interval::nonNegative(),
              "Random walk along the path, per root of the distance (arc, increment).")
        .real("across_std_per_sqrt_m", p.across_std_per_sqrt_m, "m/sqrt(m)", Interval::nonNegative(),
              "Random walk across the path, per root of the distance (arc, increment).")
        .real("heading_std_per_sqrt_m", p.heading_std_per_sqrt_m, "rad/sqrt(m)", Interval::nonNegative(),
              "Random walk of the heading, per root of the distance (arc, increment).")
        .real("heading_std_per_sqrt_rad", p.heading_std_per_sqrt_rad, "rad/sqrt(rad)", Interval::nonNegative(),
              "Random walk of the heading, per root of the turn (arc, increment).")
        .flag("use_log_covariance", p.use_log_covariance,
              "Where the log gives a covariance with a pose change, use it instead of the random walks.");
    return table;
}

std::string missingField(const RobotMotionParameters& p, const OdometryIncrement& odometry) {
    const bool reads_velocity = p.model == RobotMotionModel::steered || p.model == RobotMotionModel::differential;
    return reads_velocity && !odometry.velocity ? "velocity" : "";
}

MotionPrediction predictMotion(const RobotMotionParameters& p, const Vector3& pose,
                               const OdometryIncrement& odometry) {
    MotionPrediction out;
    switch (p.model) {
        case RobotMotionModel::steered: out = predictSteered(p, pose, odometry); break;
        case RobotMotionModel::differential: out = predictDifferential(p, pose, odometry); break;
        case RobotMotionModel::arc: out = predictArc(p, pose, odometry); break;
        case RobotMotionModel::increment: out = predictIncrement(p, pose, odometry); break;
    }
    out.pose.z() = wrapAngle(out.pose.z());
    return out;
}

BodyVelocity steeredToBody(double v, double gamma, double wheelbase) {
    return {v * std::cos(gamma), v * std::sin(gamma), v * std::sin(gamma) / wheelbase};
}

SteeredControl bodyToSteered(const BodyVelocity& velocity) {
    const double speed = std::hypot(velocity.vx, velocity.vy);
    if (speed == 0) return {0, 0};
    // |gamma| < 90 deg, so the sign of vx is the sign of v.
    const double sign = velocity.vx < 0 ? -1.0 : 1.0;
    return {sign * speed, std::atan2(sign * velocity.vy, sign * velocity.vx)};
}

}  // namespace slamot
