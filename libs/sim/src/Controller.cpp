#include "slamot/sim/Controller.h"

#include <algorithm>
#include <cmath>

namespace slamot::sim {

double steeringTowards(const Pose2& robot, const Vector2& goal, double max_steering) {
    const Vector2 rel = goal - robot.position();
    const double bearing = angleDifference(std::atan2(rel.y(), rel.x()), robot.theta);
    return std::clamp(bearing, -max_steering, max_steering);
}

Steering pursue(const Pose2& robot, const Vector2& target, const std::vector<SpeedLevel>& levels,
                double max_steering) {
    const double distance = (target - robot.position()).norm();
    const auto level = std::find_if(levels.begin(), levels.end(),
                                    [&](const SpeedLevel& l) { return distance < l.distance; });
    return {level == levels.end() ? levels.back().speed : level->speed,
            steeringTowards(robot, target, max_steering)};
}

Controller::Controller(const RobotParameters& robot, const World& world)
    : parameters_(robot),
      path_(robot.path.empty() ? world.centre_line : robot.path, robot.start, robot.loops,
            robot.reach_distance) {}

/// A robot without a steered wheel turns as one with this wheelbase would.
Vector2 Controller::fromSteering(const Steering& steering) const {
    if (parameters_.motion.model == RobotMotionModel::steered) return {steering.speed, steering.angle};
    return {steering.speed, steering.speed * std::sin(steering.angle) / parameters_.motion.wheelbase};
}

Vector2 Controller::command(const Pose2& robot, const std::optional<Vector2>& target) {
    const RobotParameters& p = parameters_;
    if (p.controller == ControllerKind::constant) {
        return {p.speed, p.motion.model == RobotMotionModel::steered ? p.steering : p.turn_rate};
    }
    if (p.controller == ControllerKind::pursuit) {
        return target ? fromSteering(pursue(robot, *target, p.levels, p.max_steering)) : Vector2::Zero();
    }
    const std::optional<Vector2> goal = path_.next(robot.position());
    return goal ? fromSteering({p.speed, steeringTowards(robot, *goal, p.max_steering)}) : Vector2::Zero();
}

}  // namespace slamot::sim
