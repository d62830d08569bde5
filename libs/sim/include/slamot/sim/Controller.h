#pragma once
// What robots are told to do. Controllers see the truth: they stand for a driver who sees the scene, not for
// the estimator under test.
#include <optional>
#include <vector>

#include "slamot/sim/PathFollower.h"
#include "slamot/sim/Scenario.h"
#include "slamot/sim/World.h"

namespace slamot::sim {

/// Speed [m/s] and steering angle [rad].
struct Steering {
    double speed = 0, angle = 0;
};

/// Steering towards `goal`, limited to +-max_steering; the robot moves along heading + angle (paper 1, eq.
/// 1).
double steeringTowards(const Pose2& robot, const Vector2& goal, double max_steering);

/// Paper 1's law: speed by distance to the target, steering towards it.
Steering pursue(const Pose2& robot, const Vector2& target, const std::vector<SpeedLevel>& levels,
                double max_steering);

/// A commanded body motion, as the robot's own model takes it: u = [v gamma] steered, [v omega] otherwise.
class Controller {
  public:
    Controller(const RobotParameters& robot, const World& world);

    /// `target` is where the pursued mover is, if it is there.
    Vector2 command(const Pose2& robot, const std::optional<Vector2>& target);

  private:
    Vector2 fromSteering(const Steering& steering) const;

    RobotParameters parameters_;
    PathFollower path_;
};

}  // namespace slamot::sim
