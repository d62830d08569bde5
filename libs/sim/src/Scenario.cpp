#include "slamot/sim/Scenario.h"

#include <algorithm>

#include "ScenarioText.h"

namespace slamot::sim {
namespace {

constexpr const char* robot_prefix = "robot.";
constexpr const char* mover_prefix = "mover.";
constexpr const char* sensor_prefix = "sensor.";

/// What follows `prefix` in the names of the sections that start with it.
std::vector<std::string> namesAfter(const Config& config, const std::string& prefix) {
    std::vector<std::string> names;
    for (const std::string& section : config.sectionNames()) {
        if (section.rfind(prefix, 0) == 0) names.push_back(section.substr(prefix.size()));
    }
    return names;
}

std::vector<int> numbersAfter(const Config& config, const std::string& prefix) {
    std::vector<int> numbers;
    for (const std::string& name : namesAfter(config, prefix)) {
        const std::optional<int> number = smallNumberFromText(name);
        if (!number || std::to_string(*number) != name) {
            throw ConfigError(config.origin(prefix + name) + ": section [" + prefix + name +
                              "]: expected a whole " + "number from 0 to 999999 after '" + prefix + "'");
        }
        numbers.push_back(*number);
    }
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

/// `table` with its keys read from `section`.
ParameterTable forSection(const ParameterTable& table, const std::string& section) {
    ParameterTable renamed(section, table.about());
    for (const Parameter& parameter : table.parameters()) renamed.custom(parameter);
    return renamed;
}

SensorParameters sensorNamed(const std::string& label) {
    SensorParameters sensor;
    sensor.label = label;
    if (label == "landmarks") sensor.role = SensorRole::landmarks;
    if (label == "movers") sensor.role = SensorRole::movers;
    return sensor;
}

}  // namespace

Scenario loadScenario(const Config& config) {
    requireKnownSections(config, {"scenario", "world", "robot"}, {robot_prefix, mover_prefix, sensor_prefix});
    Scenario scenario;
    load(describe(scenario), config);
    load(describe(scenario.world), config);
    if (!scenario.world.file.empty() && scenario.world.file.front() != '/') {
        scenario.world.file = config.folder() + "/" + scenario.world.file;
    }
    for (const int number : numbersAfter(config, mover_prefix)) {
        MoverParameters mover;
        mover.id = SourceId{number};
        load(describe(mover), config);
        scenario.movers.push_back(mover);
    }
    const std::vector<int> robots = numbersAfter(config, robot_prefix);
    if (config.has("robot")) {
        if (!robots.empty()) {
            throw ConfigError(config.origin("robot") + ": both [robot] and [robot." +
                              std::to_string(robots.front()) + "] are there: expected one of the two forms");
        }
        load(describe(scenario.robots.emplace_back()), config);
    }
    for (const int number : robots) {
        RobotParameters& robot = scenario.robots.emplace_back();
        robot.number = number;
        load(forSection(describe(robot), robot_prefix + std::to_string(number)), config);
    }
    for (const std::string& label : namesAfter(config, sensor_prefix)) {
        SensorParameters& sensor = scenario.sensors.emplace_back(sensorNamed(label));
        load(describe(sensor), config);
    }
    requirePossible(scenario);
    return scenario;
}

}  // namespace slamot::sim
