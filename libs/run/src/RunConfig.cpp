#include "slamot/run/RunConfig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "slamot/core/random/Clutter.h"

namespace slamot::run {
namespace {

const std::vector<std::pair<std::string, SensorRole>> role_names = {{"landmarks", SensorRole::landmarks},
                                                                    {"movers", SensorRole::movers},
                                                                    {"mixed", SensorRole::mixed},
                                                                    {"lidar", SensorRole::lidar},
                                                                    {"ignore", SensorRole::ignore}};
const std::string noise_prefix = "noise.";

ParameterTable describeNoise(NoiseOverride& noise, const std::string& section, const std::string& about) {
    ParameterTable table(section, about);
    table
        .optionalReal("range_std", noise.range_std, "m", Interval::positive(),
                      "Standard deviation of ranges; auto: what the log claims.")
        .optionalReal("range_std_per_m", noise.range_std_per_m, "m/m", Interval::nonNegative(),
                      "Added to range_std for every metre of range.")
        .optionalReal("bearing_std_deg", noise.bearing_std, "deg", Interval::positive(),
                      "Standard deviation of bearings; auto: what the log claims.");
    return table;
}

const std::string start_expected = "zero | truth | x,y,theta_deg";

Parameter startPose(StartParameters& start) {
    return {"pose", "m, m, deg", start_expected, "Where the robot starts; truth takes it from the log's truth folder.",
            [&start](const std::string& text) -> std::optional<std::string> {
                if (text == "zero" || text == "truth") {
                    start.kind = text == "zero" ? StartPose::zero : StartPose::truth;
                    return std::nullopt;
                }
                std::vector<double> numbers;
                ParameterTable table("start", "");
                table.reals("pose", numbers, "", Interval::any(), "");
                if (table.find("pose")->parse(text) || numbers.size() != 3 ||
                    !std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); }))
                    return start_expected;
                start.kind = StartPose::given;
                start.pose = {numbers[0], numbers[1], wrapAngle(radians(numbers[2]))};
                return std::nullopt;
            },
            [&start] {
                if (start.kind == StartPose::zero) return std::string("zero");
                if (start.kind == StartPose::truth) return std::string("truth");
                return fmt::format("{},{},{}", shortestText(start.pose.x), shortestText(start.pose.y),
                                   shortestText(degrees(start.pose.theta)));
            }};
}

Parameter clutterSeed(ClutterParameters& clutter) {
    const std::string expected = "a whole number from 0 to 18446744073709551615 or 'auto'";
    return {"seed",
            "-",
            expected,
            "Key of these draws; auto: that of the run. Studies set it to the world's.",
            [&clutter, expected](const std::string& text) -> std::optional<std::string> {
                std::uint64_t seed = 0;
                ParameterTable table("clutter", "");
                table.seed("seed", seed, "");
                if (text == "auto")
                    clutter.seed.reset();
                else if (table.find("seed")->parse(text))
                    return expected;
                else
                    clutter.seed = seed;
                return std::nullopt;
            },
            [&clutter] { return clutter.seed ? std::to_string(*clutter.seed) : std::string("auto"); }};
}

ParameterTable describeClutter(ClutterParameters& clutter) {
    ParameterTable table(
        "clutter", "What is done to the log's range-bearing observations, to see how an estimator bears it.");
    table
        .real("per_scan", clutter.per_scan, "-", {0, max_clutter_per_scan},
              "Mean number of false detections added to each, uniform in range and bearing; the sensor needs "
              "a largest "
              "range.")
        .real("detection_probability", clutter.detection_probability, "-", Interval::probability(),
              "Each detection of the log is kept with this probability.")
        .custom(clutterSeed(clutter));
    return table;
}

SensorRoles readSensors(const Config& config) {
    SensorRoles roles;
    for (const auto& [label, entry] : config.section("sensors")) {
        SensorRole role{};
        ParameterTable table("sensors", "");
        table.choice(label, role, role_names, "");
        if (const auto expected = table.find(label)->parse(entry.value))
            throw ConfigError(fmt::format("{}: {} = '{}' in [sensors], expected {}", entry.origin, label, entry.value,
                                          *expected));
        roles.by_label[label] = role;
    }
    return roles;
}

std::string pluginOf(const std::string& section) {
    return section.substr(0, section.find('.'));
}

/// Sections that belong to plugins this run does not use are checked against them, so that one file can hold the
/// settings of several estimators without a slip going unseen.
std::vector<std::string> checkOtherPlugins(const Config& config, const std::vector<std::string>& known,
                                           const PluginRegistry& registry) {
    std::vector<std::string> sections;
    const auto take = [&](std::vector<ParameterTable> tables) {
        for (const ParameterTable& table : tables) {
            if (pluginOf(table.section()) == table.section() &&
                std::find(known.begin(), known.end(), table.section()) != known.end())
                continue;
            load(table, config);
            sections.push_back(table.section());
        }
    };
    for (const PluginInfo& plugin : registry.plugins()) {
        const auto names = config.sectionNames();
        const bool wanted = std::any_of(names.begin(), names.end(), [&](const std::string& section) {
            return pluginOf(section) == plugin.name &&
                   std::find(known.begin(), known.end(), section) == known.end();
        });
        if (!wanted) continue;
        if (plugin.kind == "estimator")
            take(registry.createEstimator(plugin.name)->parameterTables());
        else
            take(registry.createDetector(plugin.name)->parameterTables());
    }
    return sections;
}

}  // namespace

std::optional<SensorRole> SensorRoles::of(const std::string& label) const {
    if (const auto found = by_label.find(label); found != by_label.end()) return found->second;
    if (label.empty()) return SensorRole::landmarks;
    for (const auto& [name, role] : role_names)
        if (name == label && role != SensorRole::ignore) return role;
    return std::nullopt;
}

std::vector<ParameterTable> describe(RunConfig& c) {
    ParameterTable run("run", "What is run.");
    run.text("estimator", c.estimator, "Estimator plugin; `slamot plugins` lists them.")
        .text("detector", c.detector, "Detector plugin for lidar scans, or none.")
        .text("odometry", c.odometry, "Label of the odometry to use; auto where the log has only one.")
        .seed("seed", c.seed, "Key of all random draws of the estimator.")
        .real("max_odometry_gap", c.max_odometry_gap, "s", Interval::positive(),
              "Longer odometry intervals are bridged and counted; detections later than this after the last odometry "
              "are dropped.");

    ParameterTable identities("identities", "Which identities of the log the estimator may know.");
    const std::vector<std::pair<std::string, Identities>> words = {{"log", Identities::log},
                                                                   {"hidden", Identities::hidden}};
    identities.choice("landmarks", c.landmark_identities, words, "Identities of landmarks.")
        .choice("movers", c.mover_identities, words, "Identities of movers.");

    ParameterTable start("start", "What is known before the first step.");
    start.custom(startPose(c.start))
        .real("position_std", c.start.position_std, "m", Interval::nonNegative(), "Of x and of y.")
        .real("heading_std_deg", c.start.heading_std, "deg", Interval::nonNegative(), "Of the heading.");

    ParameterTable output("output", "Files beside trajectory.csv, tracks.csv, landmarks.csv and summary.json.");
    output
        .real("interval", c.output.interval, "s", Interval::nonNegative(),
              "Shortest time between rows of trajectory and tracks; stamps with detections always get a row.")
        .flag("innovations", c.output.innovations, "innovations.csv.")
        .flag("landmarks_history", c.output.landmarks_history, "landmarks_history.csv.")
        .flag("tentative", c.output.tentative, "tentative.csv: what may turn out to be a landmark, as it goes.")
        .flag("particles", c.output.particles, "particles.csv, of estimators that have particles.")
        .integer("most_particles", c.output.most_particles, Interval::between(1, 100000),
                 "Of more particles at a stamp, so many are written, chosen by weight.")
        .flag("steps", c.output.steps, "steps.csv.")
        .flag("correlation", c.output.correlation, "correlation.bin.")
        .flag("map", c.output.map, "map.landmarks.gz.")
        .flag("scene", c.output.scene, "scene.3Dscene.")
        .flag("rawlog", c.output.rawlog, "estimate.rawlog.")
        .flag("figure", c.output.figure, "overview.svg and overview.png.")
        .flag("report", c.output.report, "report.html, a page of plots.");

    return {run,
            slamot::describe(c.log),
            identities,
            describeNoise(
                c.noise, "noise",
                "Noise of range-bearing sensors, where it shall not be what the log claims; [noise.<label>] "
                "does so for one sensor."),
            describeClutter(c.clutter),
            start,
            output};
}

AssembledRun assembleRun(const Config& config, const PluginRegistry& registry) {
    AssembledRun assembled;
    RunConfig& c = assembled.config;
    std::vector<std::string> known = {"sensors"};
    for (const ParameterTable& table : describe(c)) {
        load(table, config);
        known.push_back(table.section());
    }
    c.sensors = readSensors(config);
    for (const std::string& section : config.sectionNames())
        if (section.rfind(noise_prefix, 0) == 0) {
            load(describeNoise(c.noise_by_label[section.substr(noise_prefix.size())], section, ""), config);
            known.push_back(section);
        }

    assembled.estimator = registry.createEstimator(c.estimator);
    for (const ParameterTable& table : assembled.estimator->parameterTables()) known.push_back(table.section());
    if (c.detector != "none") {
        assembled.detector = registry.createDetector(c.detector);
        for (const ParameterTable& table : assembled.detector->parameterTables()) known.push_back(table.section());
    }
    const ParameterTable evaluation = eval::describe(assembled.evaluation);
    load(evaluation, config);
    known.push_back(evaluation.section());
    for (const std::string& section : checkOtherPlugins(config, known, registry)) known.push_back(section);
    requireKnownSections(config, known);

    assembled.estimator->initialize(config);
    if (assembled.detector) assembled.detector->initialize(config);
    assembled.canonical_config = config.canonicalText();
    return assembled;
}

std::string fullConfigText(const std::string& plugin, const PluginRegistry& registry) {
    const bool is_detector = std::any_of(registry.plugins().begin(), registry.plugins().end(), [&](const PluginInfo& p) {
        return p.name == plugin && p.kind == "detector";
    });
    RunConfig defaults;
    std::vector<ParameterTable> tables;
    std::shared_ptr<Estimator> estimator;
    std::shared_ptr<Detector> detector;
    if (is_detector) {
        defaults.detector = plugin;
        detector = registry.createDetector(plugin);
        tables = detector->parameterTables();
    } else {
        defaults.estimator = plugin;
        estimator = registry.createEstimator(plugin);
        tables = estimator->parameterTables();
    }

    std::string text = fmt::format(
        "# Every setting of {0}, at its default. Made by `slamot config {0}`.\n"
        "# Use: slamot run {0}.ini LOG.rawlog -o OUT\n",
        plugin);
    for (const ParameterTable& table : describe(defaults)) {
        text += "\n" + toIni(table);
        if (table.section() == "identities")
            text +=
                "\n# What each sensor label's observations are: landmarks | movers | mixed | lidar | ignore. Labels of\n"
                "# these names need no line; an empty label counts as landmarks.\n[sensors]\n";
    }
    eval::EvaluationOptions evaluation;
    text += "\n" + toIni(eval::describe(evaluation));
    for (const ParameterTable& table : tables) text += "\n" + toIni(table);
    return text;
}

}  // namespace slamot::run
