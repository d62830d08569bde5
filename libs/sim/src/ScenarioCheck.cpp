// Whether a scenario can be simulated: every value in its range (programs fill in scenarios too, not only
// files), and what no single range can say, whether the parts fit together.
#include <algorithm>
#include <set>

#include "slamot/sim/Scenario.h"

namespace slamot::sim {
namespace {

[[noreturn]] void fail(const std::string& section, const std::string& sentence) {
    throw ConfigError("[" + section + "] " + sentence);
}

void checkRanges(const ParameterTable& table) {
    for (const Parameter& parameter : table.parameters()) {
        const std::string value = parameter.print();
        if (const auto expected = parameter.parse(value)) {
            fail(table.section(), "has " + parameter.key + " = '" + value + "': expected " + *expected);
        }
    }
}

/// Takes a copy, since tables are tied to what they can change.
void checkRanges(Scenario scenario) {
    checkRanges(describe(scenario));
    checkRanges(describe(scenario.world));
    for (MoverParameters& mover : scenario.movers) checkRanges(describe(mover));
    for (RobotParameters& robot : scenario.robots) checkRanges(describe(robot));
    for (SensorParameters& sensor : scenario.sensors) checkRanges(describe(sensor));
}

void checkWorld(const WorldParameters& world) {
    if (world.kind == WorldKind::file && world.file.empty()) {
        fail("world", "kind = file needs the key 'file', a CSV with columns id,x,y");
    }
}

void checkMover(const MoverParameters& mover) {
    const std::string section = "mover." + std::to_string(mover.id.value);
    if (mover.model == MoverModel::schedule) {
        if (mover.schedule.empty())
            fail(section, "model = schedule needs the key 'schedule', such as 0:cv 15:ca");
        if (mover.schedule.front().time != 0) {
            fail(section,
                 "schedule starts at " + shortestText(mover.schedule.front().time) + " s: expected 0");
        }
        for (std::size_t i = 1; i < mover.schedule.size(); ++i) {
            if (mover.schedule[i].time <= mover.schedule[i - 1].time) {
                fail(section, "schedule has " + shortestText(mover.schedule[i].time) + " s after " +
                                  shortestText(mover.schedule[i - 1].time) + " s: expected rising times");
            }
        }
    }
    if (mover.model == MoverModel::waypoint && mover.path.empty()) {
        fail(section, "model = waypoint needs the key 'path', such as 0,0 10,0 10,10");
    }
    if (mover.id.value >= robot_id_base) fail(section, "has an id of a million or more: those are robots");
    if (mover.min_speed > mover.max_speed) fail(section, "has min_speed above max_speed");
    if (mover.vanish <= mover.appear) fail(section, "vanishes before it appears");
}

void checkRobot(const Scenario& scenario, const RobotParameters& robot) {
    const std::string section =
        scenario.robots.size() == 1 ? "robot" : "robot." + std::to_string(robot.number);
    if (robot.controller == ControllerKind::waypoints && robot.path.empty() &&
        scenario.world.kind != WorldKind::loop) {
        fail(section, "controller = waypoints needs the key 'path', except in a loop world");
    }
    if (robot.controller == ControllerKind::pursuit) {
        const bool there =
            std::any_of(scenario.movers.begin(), scenario.movers.end(),
                        [&](const MoverParameters& mover) { return mover.id == robot.target; });
        if (!there)
            fail(section, "pursues mover " + std::to_string(robot.target.value) + ", which is not there");
        if (robot.levels.empty())
            fail(section, "controller = pursuit needs the key 'levels', such as 10:1 inf:3");
        for (std::size_t i = 1; i < robot.levels.size(); ++i) {
            if (robot.levels[i].distance <= robot.levels[i - 1].distance) {
                fail(section, "has levels out of order: expected rising distances");
            }
        }
    }
}

void checkSensor(const Scenario& scenario, const SensorParameters& sensor) {
    const std::string section = "sensor." + sensor.label;
    if (sensor.label.empty()) fail(section, "has no label: expected a name after 'sensor.'");
    if (sensor.min_range >= sensor.max_range) fail(section, "has min_range not below max_range");
    if (sensor.phase >= sensor.every_n_steps) {
        fail(section, "has phase " + std::to_string(sensor.phase) +
                          ": expected less than every_n_steps = " + std::to_string(sensor.every_n_steps));
    }
    if (sensor.role == SensorRole::mixed && sensor.identities == IdentityRule::written) {
        fail(section,
             "has role mixed and identities written, but landmarks and movers share numbers: expected hidden "
             "or auto");
    }
    for (const int number : sensor.robots) {
        const bool there = std::any_of(scenario.robots.begin(), scenario.robots.end(),
                                       [&](const RobotParameters& robot) { return robot.number == number; });
        if (!there) fail(section, "is on robot " + std::to_string(number) + ", which is not there");
    }
}

}  // namespace

void requirePossible(const Scenario& scenario) {
    if (scenario.robots.empty()) throw ConfigError("the scenario has no robot: expected a section [robot]");
    for (const RobotParameters& robot : scenario.robots) {
        if (robot.motion.model == RobotMotionModel::increment) {
            fail("robot", "has motion increment: expected steered, differential or arc");
        }
    }
    checkRanges(scenario);
    checkWorld(scenario.world);
    std::set<std::int64_t> movers;
    for (const MoverParameters& mover : scenario.movers) {
        checkMover(mover);
        if (!movers.insert(mover.id.value).second)
            fail("mover." + std::to_string(mover.id.value), "is there twice");
    }
    std::set<int> robots;
    for (const RobotParameters& robot : scenario.robots) {
        checkRobot(scenario, robot);
        if (!robots.insert(robot.number).second)
            fail("robot." + std::to_string(robot.number), "is there twice");
    }
    std::set<std::string> labels;
    for (const SensorParameters& sensor : scenario.sensors) {
        checkSensor(scenario, sensor);
        if (!labels.insert(sensor.label).second) fail("sensor." + sensor.label, "is there twice");
    }
}

}  // namespace slamot::sim
