#pragma once
// The range-bearing sensor. z = [range bearing] of a point p seen from a sensor mounted at T_robot_sensor = s on a
// robot at x = [x y theta]:
//   rel = p - (x.xy + Rot(theta) s.xy),  range = |rel|,  bearing = atan2(rel) - theta - s.theta.
// Paper 1, eq. 4-5, with the corrections of its eq. 38-45.
#include <Eigen/Core>

#include "slamot/core/data/Pose2.h"

namespace slamot {

template <class S>
Eigen::Matrix<S, 2, 1> rangeBearing(const Eigen::Matrix<S, 3, 1>& robot, const Eigen::Matrix<S, 2, 1>& point,
                                    const Pose2& sensor) {
    using std::atan2;
    using std::sqrt;
    const Eigen::Matrix<S, 2, 1> rel =
        point - robot.template head<2>() - rotation(robot(2)) * sensor.position().cast<S>();
    return {sqrt(rel.squaredNorm()), wrapAngle(S(atan2(rel.y(), rel.x()) - robot(2) - S(sensor.theta)))};
}

/// The point that would give z without noise (paper 1, eq. 8-9).
template <class S>
Eigen::Matrix<S, 2, 1> inverseRangeBearing(const Eigen::Matrix<S, 3, 1>& robot, const Eigen::Matrix<S, 2, 1>& z,
                                           const Pose2& sensor) {
    using std::cos;
    using std::sin;
    const S direction = robot(2) + S(sensor.theta) + z(1);
    return robot.template head<2>() + rotation(robot(2)) * sensor.position().cast<S>() +
           z(0) * Eigen::Matrix<S, 2, 1>(cos(direction), sin(direction));
}

/// z - h, with the bearing wrapped: the only place where measured and predicted bearings meet.
inline Vector2 rangeBearingResidual(const Vector2& measured, const Vector2& predicted) {
    return {measured.x() - predicted.x(), angleDifference(measured.y(), predicted.y())};
}

/// Prediction and Jacobians.
struct RangeBearingPrediction {
    Vector2 z;
    Eigen::Matrix<double, 2, 3> H_robot;
    Matrix2 H_point;
    /// Unit vector across the line of sight, and d rel / d robot: for second-order terms.
    Vector2 across;
    Eigen::Matrix<double, 2, 3> D_robot;
};

/// Ranges below this [m] are taken as this in the Jacobians: the bearing of a point at the sensor is undefined.
inline constexpr double range_floor = 1e-3;

RangeBearingPrediction predictRangeBearing(const Vector3& robot, const Vector2& point, const Pose2& sensor);

/// Inverse and Jacobians (paper 1, eq. 16-17): G_robot = [I2, J (p - x.xy)].
struct RangeBearingInverse {
    Vector2 point;
    Eigen::Matrix<double, 2, 3> G_robot;
    Matrix2 G_z;
};
RangeBearingInverse invertRangeBearing(const Vector3& robot, const Vector2& z, const Pose2& sensor);

}  // namespace slamot
