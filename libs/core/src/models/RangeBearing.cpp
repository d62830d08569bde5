#include "slamot/core/models/RangeBearing.h"

#include <algorithm>
#include <cmath>

namespace slamot {

RangeBearingPrediction predictRangeBearing(const Vector3& robot, const Vector2& point, const Pose2& sensor) {
    const Vector2 lever = rotation(robot.z()) * sensor.position();
    const Vector2 rel = point - robot.head<2>() - lever;
    const double range = rel.norm(), r = std::max(range, range_floor);

    RangeBearingPrediction out;
    out.z = {range, wrapAngle(std::atan2(rel.y(), rel.x()) - robot.z() - sensor.theta)};
    const Vector2 along = range > 0 ? Vector2(rel / range) : Vector2::UnitX();
    out.across = quarterTurn() * along;
    out.D_robot << -Matrix2::Identity(), -(quarterTurn() * lever);
    out.H_point << along.transpose(), out.across.transpose() / r;
    out.H_robot = out.H_point * out.D_robot;
    out.H_robot(1, 2) -= 1.0;
    return out;
}

RangeBearingInverse invertRangeBearing(const Vector3& robot, const Vector2& z, const Pose2& sensor) {
    const double direction = robot.z() + sensor.theta + z.y();
    const Vector2 along(std::cos(direction), std::sin(direction)), across(-along.y(), along.x());

    RangeBearingInverse out;
    const Vector2 from_robot = rotation(robot.z()) * sensor.position() + z.x() * along;
    out.point = robot.head<2>() + from_robot;
    out.G_robot << Matrix2::Identity(), quarterTurn() * from_robot;
    out.G_z << along, z.x() * across;
    return out;
}

}  // namespace slamot
