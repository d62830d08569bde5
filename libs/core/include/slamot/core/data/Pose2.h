#pragma once
// Planar poses. `T_world_robot` maps coordinates in the robot's frame to the world's.
#include <Eigen/Core>

#include "slamot/core/data/Angle.h"

namespace slamot {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Matrix2 = Eigen::Matrix2d;
using Matrix3 = Eigen::Matrix3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// x, y in metres, theta in radians within (-pi, pi].
struct Pose2 {
    double x = 0, y = 0, theta = 0;

    static Pose2 fromVector(const Vector3& v) { return {v.x(), v.y(), wrapAngle(v.z())}; }
    Vector3 vector() const { return {x, y, theta}; }
    Vector2 position() const { return {x, y}; }
};

/// A pose with the covariance of [x y theta], in the same frame as the pose, errors added to the coordinates.
struct PoseGaussian {
    Pose2 mean;
    Matrix3 covariance = Matrix3::Zero();
};

/// J turns a plane vector by a quarter turn to the left: d(Rot(t) p)/dt = J Rot(t) p.
template <class Scalar = double>
Eigen::Matrix<Scalar, 2, 2> quarterTurn() {
    return (Eigen::Matrix<Scalar, 2, 2>() << Scalar(0), Scalar(-1), Scalar(1), Scalar(0)).finished();
}

template <class Scalar>
Eigen::Matrix<Scalar, 2, 2> rotation(const Scalar& theta) {
    using std::cos;
    using std::sin;
    const Scalar c = cos(theta), s = sin(theta);
    return (Eigen::Matrix<Scalar, 2, 2>() << c, -s, s, c).finished();
}

/// T_a_c = T_a_b * T_b_c.
inline Pose2 operator*(const Pose2& a, const Pose2& b) {
    const Vector2 p = a.position() + rotation(a.theta) * b.position();
    return {p.x(), p.y(), wrapAngle(a.theta + b.theta)};
}

/// p_a = T_a_b * p_b.
inline Vector2 operator*(const Pose2& a, const Vector2& p) {
    return a.position() + rotation(a.theta) * p;
}

inline Pose2 inverse(const Pose2& a) {
    const Vector2 p = rotation(-a.theta) * a.position();
    return {-p.x(), -p.y(), wrapAngle(-a.theta)};
}

}  // namespace slamot
