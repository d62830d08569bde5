#pragma once
#include <cstdint>
#include <vector>

#include "slamot/rawlog/Conventions.h"
#include "slamot/sim/Mover.h"
#include "slamot/sim/Scenario.h"
#include "slamot/sim/World.h"

namespace slamot::sim {

struct RobotRun {
    std::vector<Pose2> poses;               ///< true T_world_robot at steps 0..steps
    std::vector<OdometryReading> odometry;  ///< what was commanded; starts at (0, 0, 0)
};

RobotRun simulateRobot(const Scenario& scenario, const RobotParameters& robot, const World& world,
                       const std::vector<Trajectory>& movers, std::uint64_t seed);

/// A robot as its team-mates see it: a mover with id robot_id_base + number.
Trajectory asMover(const Scenario& scenario, const RobotParameters& robot, const RobotRun& run);

}  // namespace slamot::sim
