#pragma once
// Small scenarios for the tests of slamot::sim.
#include <string>

#include "slamot/sim/Scenario.h"

namespace slamot::sim {

/// A robot that stands at the origin, noise-free, looking along x; no world, movers or sensors.
inline Scenario standingRobot(int steps) {
    Scenario scenario;
    scenario.dt = 0.1;
    scenario.steps = steps;
    scenario.world.landmarks = 0;
    RobotParameters robot;
    robot.speed = 0;
    robot.motion.speed_std = robot.motion.steering_std = 0;
    scenario.robots.push_back(robot);
    return scenario;
}

inline SensorParameters sensorOf(SensorRole role, const std::string& label) {
    SensorParameters sensor;
    sensor.role = role;
    sensor.label = label;
    return sensor;
}

/// A mover that goes straight on without noise.
inline MoverParameters straightMover(int id, const Vector2& position, const Vector2& velocity) {
    MoverParameters mover;
    mover.id = SourceId{id};
    mover.cv_acceleration_std = 0;
    mover.position = position;
    mover.velocity = velocity;
    return mover;
}

}  // namespace slamot::sim
