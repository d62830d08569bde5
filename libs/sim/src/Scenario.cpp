#include "slamot/sim/Scenario.h"

#include <algorithm>
#include <cmath>

#include "ScenarioText.h"
#include "slamot/rawlog/CsvTable.h"

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

/// A file that the scenario names, seen from the scenario's folder.
std::string located(const std::string& file, const Config& config) {
    return file.empty() || file.front() == '/' ? file : config.folder() + "/" + file;
}

std::vector<Vector2> pathFrom(const std::string& file) {
    CsvReader table(file);
    const int x = table.column("x"), y = table.column("y");
    std::vector<Vector2> path;
    while (table.next()) {
        path.emplace_back(table.number(x), table.number(y));
        if (!std::isfinite(path.back().x())) table.fail(x, "a finite number");
        if (!std::isfinite(path.back().y())) table.fail(y, "a finite number");
    }
    if (path.empty()) throw ConfigError(file + " has no points: expected rows of x,y");
    return path;
}

/// Reads the path of a robot or mover where it stands in a file of its own.
template <class Parameters>
void readPathFile(Parameters& parameters, const std::string& section, const Config& config) {
    if (parameters.path_file.empty()) return;
    if (!parameters.path.empty()) {
        throw ConfigError(config.section(section).at("path_file").origin + ": [" + section +
                          "] has both 'path' and 'path_file': expected one of the two");
    }
    parameters.path_file = located(parameters.path_file, config);
    parameters.path = pathFrom(parameters.path_file);
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
    scenario.world.file = located(scenario.world.file, config);
    for (const int number : numbersAfter(config, mover_prefix)) {
        MoverParameters mover;
        mover.id = SourceId{number};
        load(describe(mover), config);
        readPathFile(mover, mover_prefix + std::to_string(number), config);
        scenario.movers.push_back(mover);
    }
    const std::vector<int> robots = numbersAfter(config, robot_prefix);
    if (config.has("robot")) {
        if (!robots.empty()) {
            throw ConfigError(config.origin("robot") + ": both [robot] and [robot." +
                              std::to_string(robots.front()) + "] are there: expected one of the two forms");
        }
        RobotParameters& robot = scenario.robots.emplace_back();
        load(describe(robot), config);
        readPathFile(robot, "robot", config);
    }
    for (const int number : robots) {
        RobotParameters& robot = scenario.robots.emplace_back();
        robot.number = number;
        const std::string section = robot_prefix + std::to_string(number);
        load(forSection(describe(robot), section), config);
        readPathFile(robot, section, config);
    }
    for (const std::string& label : namesAfter(config, sensor_prefix)) {
        SensorParameters& sensor = scenario.sensors.emplace_back(sensorNamed(label));
        load(describe(sensor), config);
    }
    requirePossible(scenario);
    return scenario;
}

std::vector<std::string> filesOf(const Scenario& scenario) {
    std::vector<std::string> files;
    const auto add = [&](const std::string& file) {
        if (!file.empty()) files.push_back(file);
    };
    add(scenario.world.file);
    for (const MoverParameters& mover : scenario.movers) add(mover.path_file);
    for (const RobotParameters& robot : scenario.robots) add(robot.path_file);
    return files;
}

}  // namespace slamot::sim
