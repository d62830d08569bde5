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

/// f at the control and its Jacobians.
struct Step {
    Vector3 pose;
    Matrix3 F, G;  ///< d f / d x, d f / d u
};

Step steeredStep(const Vector3& x, const Vector3& u, double dt, double wheelbase) {
    const double step = u(0) * dt, course = x.z() + u(1);
    const double c = std::cos(course), s = std::sin(course);

    Step out;
    out.pose = steeredMotion<double>(x, u.head<2>(), dt, wheelbase);
    out.F << 1, 0, -step * s, 0, 1, step * c, 0, 0, 1;  // paper 1, eq. 29
    out.G << dt * c, -step * s, 0, dt * s, step * c, 0, dt * std::sin(u(1)) / wheelbase,
        step * std::cos(u(1)) / wheelbase, 0;  // paper 1, eq. 30
    return out;
}

Step differentialStep(const Vector3& x, const Vector3& u, double dt) {
    const double c = std::cos(x.z()), s = std::sin(x.z());

    Step out;
    out.pose = differentialMotion<double>(x, u.head<2>(), dt);
    out.F << 1, 0, -u(0) * dt * s, 0, 1, u(0) * dt * c, 0, 0, 1;
    out.G << dt * c, 0, 0, dt * s, 0, 0, 0, dt, 0;
    return out;
}

Step arcStep(const Vector3& x, const Vector3& u) {
    const double course = x.z() + 0.5 * u(2), c = std::cos(course), s = std::sin(course);
    const double turn_x = -u(0) * s - u(1) * c, turn_y = u(0) * c - u(1) * s;

    Step out;
    out.pose = arcMotion<double>(x, u);
    out.F << 1, 0, turn_x, 0, 1, turn_y, 0, 0, 1;
    out.G << c, -s, 0.5 * turn_x, s, c, 0.5 * turn_y, 0, 0, 1;
    return out;
}

Step incrementStep(const Vector3& x, const Vector3& u) {
    const double c = std::cos(x.z()), s = std::sin(x.z());

    Step out;
    out.pose = incrementMotion<double>(x, u);
    out.F << 1, 0, -u(0) * s - u(1) * c, 0, 1, u(0) * c - u(1) * s, 0, 0, 1;
    out.G << c, -s, 0, s, c, 0, 0, 0, 1;
    return out;
}

Step stepOf(const RobotMotionParameters& p, const Vector3& x, const Vector3& u, double dt) {
    switch (p.model) {
        case RobotMotionModel::steered: return steeredStep(x, u, dt, p.wheelbase);
        case RobotMotionModel::differential: return differentialStep(x, u, dt);
        case RobotMotionModel::arc: return arcStep(x, u);
        default: return incrementStep(x, u);
    }
}

/// Covariance of a pose increment [along across turn] as random walks over the distance and the turn.
Matrix3 randomWalk(const RobotMotionParameters& p, double distance, double turn) {
    const auto square = [](double a) { return a * a; };
    return Vector3(square(p.along_std_per_sqrt_m) * distance, square(p.across_std_per_sqrt_m) * distance,
                   square(p.heading_std_per_sqrt_m) * distance + square(p.heading_std_per_sqrt_rad) * turn)
        .asDiagonal();
}

MotionControl velocityControl(const RobotMotionParameters& p, const OdometryIncrement& odometry) {
    MotionControl u;
    u.size = 2;
    Vector3 deviation = Vector3::Zero();
    if (p.model == RobotMotionModel::steered) {
        const SteeredControl control = bodyToSteered(*odometry.velocity);
        u.mean.head<2>() << control.v, control.gamma;
        deviation.head<2>() << p.speed_std, p.steering_std;
    } else {
        u.mean.head<2>() << odometry.velocity->vx, odometry.velocity->omega;
        deviation.head<2>() << p.speed_std, p.turn_rate_std;
    }
    u.covariance.diagonal() = controlVarianceScale(odometry) * deviation.array().square().matrix();
    return u;
}

MotionControl arcControl(const RobotMotionParameters& p, const OdometryIncrement& odometry) {
    const Pose2& d = odometry.increment;
    // The chord's component along theta + dtheta/2; what lies across it no rolling robot can do.
    const double half = 0.5 * d.theta, ds = d.x * std::cos(half) + d.y * std::sin(half);
    MotionControl u{{ds, 0.0, d.theta}, randomWalk(p, std::abs(ds), std::abs(d.theta)), 3};
    if (odometry.covariance && p.use_log_covariance) {
        // d u / d increment: the chord's own direction turns with half the turn.
        const double dl = d.y * std::cos(half) - d.x * std::sin(half);
        Matrix3 to_chord = Matrix3::Identity();
        to_chord.topLeftCorner<2, 2>() = rotation(-half);
        to_chord.topRightCorner<2, 1>() << 0.5 * dl, -0.5 * ds;
        u.covariance = to_chord * *odometry.covariance * to_chord.transpose();
    }
    return u;
}

MotionControl incrementControl(const RobotMotionParameters& p, const OdometryIncrement& odometry) {
    const Pose2& d = odometry.increment;
    return {d.vector(),
            odometry.covariance && p.use_log_covariance
                ? *odometry.covariance
                : randomWalk(p, std::hypot(d.x, d.y), std::abs(d.theta)),
            3};
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

MotionControl controlOf(const RobotMotionParameters& p, const OdometryIncrement& odometry) {
    switch (p.model) {
        case RobotMotionModel::arc: return arcControl(p, odometry);
        case RobotMotionModel::increment: return incrementControl(p, odometry);
        default: return velocityControl(p, odometry);
    }
}

Vector3 moved(const RobotMotionParameters& p, const Vector3& pose, const Vector3& u, double dt) {
    Vector3 out = pose;
    switch (p.model) {
        case RobotMotionModel::steered:
            out = steeredMotion<double>(pose, u.head<2>(), dt, p.wheelbase);
            break;
        case RobotMotionModel::differential: out = differentialMotion<double>(pose, u.head<2>(), dt); break;
        case RobotMotionModel::arc: out = arcMotion<double>(pose, u); break;
        case RobotMotionModel::increment: out = incrementMotion<double>(pose, u); break;
    }
    out.z() = wrapAngle(out.z());
    return out;
}

MotionPrediction predictMotion(const RobotMotionParameters& p, const Vector3& pose, const MotionControl& control,
                               double dt) {
    Step step = stepOf(p, pose, control.mean, dt);
    step.pose.z() = wrapAngle(step.pose.z());
    return {step.pose, step.F, step.G * control.covariance * step.G.transpose()};
}

MotionPrediction predictMotion(const RobotMotionParameters& p, const Vector3& pose,
                               const OdometryIncrement& odometry) {
    return predictMotion(p, pose, controlOf(p, odometry), odometry.seconds());
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
