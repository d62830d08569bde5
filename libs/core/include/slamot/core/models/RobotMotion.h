#pragma once
// How a robot's pose changes with its odometry. Pose x = [x y theta] in the world; every model is
// x' = f(x, u) with control u and additive noise on u. The functions are templates so that tests differentiate
// them automatically; `predictMotion` gives value and closed-form Jacobians together.
#include <Eigen/Core>

#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Odometry.h"
#include "slamot/core/data/Pose2.h"

namespace slamot {

/// Steered robot (paper 1, eq. 1). u = [v gamma], speed [m/s] and steering angle [rad], wheelbase B [m]:
/// x += v dt cos(theta+gamma), y += v dt sin(theta+gamma), theta += (v dt / B) sin(gamma).
template <class S>
Eigen::Matrix<S, 3, 1> steeredMotion(const Eigen::Matrix<S, 3, 1>& x, const Eigen::Matrix<S, 2, 1>& u, double dt,
                                     double wheelbase) {
    using std::cos;
    using std::sin;
    const S step = u(0) * S(dt), course = x(2) + u(1);
    return {x(0) + step * cos(course), x(1) + step * sin(course), x(2) + step * sin(u(1)) / S(wheelbase)};
}

/// Differential robot (papers 2 and 4). u = [v omega]: moves along the old heading, then turns:
/// x += v dt cos(theta), y += v dt sin(theta), theta += omega dt.
template <class S>
Eigen::Matrix<S, 3, 1> differentialMotion(const Eigen::Matrix<S, 3, 1>& x, const Eigen::Matrix<S, 2, 1>& u,
                                          double dt) {
    using std::cos;
    using std::sin;
    const S step = u(0) * S(dt);
    return {x(0) + step * cos(x(2)), x(1) + step * sin(x(2)), x(2) + u(1) * S(dt)};
}

/// Odometry increment along an arc (paper 5). u = [ds dl dtheta]: ds [m] along the chord, dl [m] across it (0 but
/// for noise), turn dtheta [rad]; the chord points along theta + dtheta/2.
template <class S>
Eigen::Matrix<S, 3, 1> arcMotion(const Eigen::Matrix<S, 3, 1>& x, const Eigen::Matrix<S, 3, 1>& u) {
    using std::cos;
    using std::sin;
    const S course = x(2) + u(2) * S(0.5), c = cos(course), s = sin(course);
    return {x(0) + u(0) * c - u(1) * s, x(1) + u(0) * s + u(1) * c, x(2) + u(2)};
}

/// Composition with a pose increment, T_world_new = T_world_old * T_old_new; u = [dx dy dtheta] in the old frame.
template <class S>
Eigen::Matrix<S, 3, 1> incrementMotion(const Eigen::Matrix<S, 3, 1>& x, const Eigen::Matrix<S, 3, 1>& u) {
    using std::cos;
    using std::sin;
    const S c = cos(x(2)), s = sin(x(2));
    return {x(0) + u(0) * c - u(1) * s, x(1) + u(0) * s + u(1) * c, x(2) + u(2)};
}

enum class RobotMotionModel { steered, differential, arc, increment };

/// Section `[motion]`, shared by all estimators.
struct RobotMotionParameters {
    RobotMotionModel model = RobotMotionModel::arc;
    double wheelbase = 4.0;  ///< [m], steered
    // Control noise of steered and differential models, one draw per odometry entry.
    double speed_std = 0.1;                 ///< [m/s]
    double steering_std = radians(3.0);     ///< [rad]
    double turn_rate_std = radians(3.0);    ///< [rad/s]
    // Noise of arc and increment models: random walks, so that it does not depend on the odometry's rate.
    double along_std_per_sqrt_m = 0.03;             ///< [m / sqrt(m)] along the path
    double across_std_per_sqrt_m = 0.01;            ///< [m / sqrt(m)] across it
    double heading_std_per_sqrt_m = 0.03;           ///< [rad / sqrt(m)]
    double heading_std_per_sqrt_rad = 0.14;         ///< [rad / sqrt(rad)]
    /// Increments that bring a covariance of their own use it instead of the above.
    bool use_log_covariance = true;
};

ParameterTable describe(RobotMotionParameters& parameters);

/// The control u of one step and how well it is known. Steered: [v gamma 0], differential: [v omega 0], arc and
/// increment: as their functions above have it.
struct MotionControl {
    Vector3 mean = Vector3::Zero();
    Matrix3 covariance = Matrix3::Zero();
    int size = 3;  ///< 2 where the last entry means nothing
};

/// Names the missing field when the increment lacks what the model reads, else empty.
std::string missingField(const RobotMotionParameters& parameters, const OdometryIncrement& odometry);

/// What the odometry says of the control. It must have what the model reads.
MotionControl controlOf(const RobotMotionParameters& parameters, const OdometryIncrement& odometry);

/// f(x, u) over dt [s]; heading wrapped.
Vector3 moved(const RobotMotionParameters& parameters, const Vector3& pose, const Vector3& control, double dt);

struct MotionPrediction {
    Vector3 pose;       ///< [x y theta], heading wrapped
    Matrix3 F;          ///< d f / d x
    Matrix3 Q;          ///< noise of the pose: G Q_u G^t
};

/// One step at the control's mean, with Jacobians.
MotionPrediction predictMotion(const RobotMotionParameters& parameters, const Vector3& pose,
                               const MotionControl& control, double dt);
MotionPrediction predictMotion(const RobotMotionParameters& parameters, const Vector3& pose,
                               const OdometryIncrement& odometry);

/// Steering convention of logs: body velocity (v cos gamma, v sin gamma, v sin gamma / B) of a steered robot,
/// with |gamma| < 90 deg; v may be negative; gamma = 0 at v = 0.
BodyVelocity steeredToBody(double v, double gamma, double wheelbase);
struct SteeredControl {
    double v, gamma;
};
SteeredControl bodyToSteered(const BodyVelocity& velocity);

}  // namespace slamot
