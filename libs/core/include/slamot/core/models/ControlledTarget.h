#pragma once
// Paper 2's mover: a pose [x y theta] that is driven by a speed and a turn rate, u = [v w], which are known but for
// noise of covariance Q_u (eq. 16 and 17).
#include <Eigen/Core>

#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Pose2.h"
#include "slamot/core/models/TargetMotion.h"

namespace slamot {

/// Eq. 16: x += v dt cos(theta'), y += v dt sin(theta'), theta' = theta + w dt: the heading at the end of the step.
template <class S>
Eigen::Matrix<S, 3, 1> controlledMotion(const Eigen::Matrix<S, 3, 1>& x, const Eigen::Matrix<S, 2, 1>& u, double dt) {
    using std::cos;
    using std::sin;
    const S heading = x(2) + u(1) * S(dt), step = u(0) * S(dt);
    return {x(0) + step * cos(heading), x(1) + step * sin(heading), heading};
}

/// The same along the exact arc: the chord has length v dt sinc(w dt / 2) and the direction theta + w dt / 2.
template <class S>
Eigen::Matrix<S, 3, 1> controlledArc(const Eigen::Matrix<S, 3, 1>& x, const Eigen::Matrix<S, 2, 1>& u, double dt) {
    using std::cos;
    using std::sin;
    const S turn = u(1) * S(dt), course = x(2) + S(0.5) * turn, step = u(0) * S(dt) * sinc(S(S(0.5) * turn));
    return {x(0) + step * cos(course), x(1) + step * sin(course), x(2) + turn};
}

enum class ControlledPath {
    printed,  ///< eq. 16
    arc       ///< the exact arc
};

/// Table `[name.control]`.
struct ControlledTarget {
    double speed = 1;                        ///< [m/s]
    double turn_rate = 0;                    ///< [rad/s]
    double speed_std = 0.1;                  ///< [m/s]
    double turn_rate_std = radians(2.0);     ///< [rad/s]
    double noise_interval = 0;               ///< [s], TargetModel's
    ControlledPath path = ControlledPath::arc;
    int headings = 8;                        ///< equally likely ones at first sight
};

ParameterTable describe(ControlledTarget& parameters, const std::string& section);

struct ControlledPrediction {
    Vector3 pose;  ///< heading not wrapped
    Matrix3 F;     ///< d g / d x
    Matrix3 Q;     ///< H_u Q_u H_u^t
};
ControlledPrediction predictControlled(const ControlledTarget& parameters, const Vector3& pose, double dt);

/// As [p v a]: v along the heading, a across it, with what noise of the control adds to them over dt [s].
struct ControlledState {
    Vector6 mean;
    Eigen::Matrix<double, 6, 3> G;  ///< d / d pose
    Matrix6 Q;                      ///< of v and a alone
};
ControlledState controlledState(const ControlledTarget& parameters, const Vector3& pose);

}  // namespace slamot
