#include <fmt/format.h>

#include "Command.h"
#include "LogGuard.h"
#include "slamot/core/plugin/PluginRegistry.h"
#include "slamot/rawlog/RawlogWriter.h"

namespace slamot::app {
namespace {

struct Options {
    std::string log;
    bool json = false;
};

void printSensors(const LogSummary& summary) {
    fmt::print("{:30} {:12} {:>8} {:>9} {:>8} {:>8}\n", "class", "label", "count", "rate [Hz]", "detect.", "with id");
    for (const SensorSummary& s : summary.sensors) {
        const double span = secondsBetween(s.first, s.last);
        const std::string rate = span > 0 ? fmt::format("{:.2f}", static_cast<double>(s.count - 1) / span) : "-";
        const bool detects = s.detections > 0;
        fmt::print("{:30} {:12} {:>8} {:>9} {:>8} {:>8}\n", s.class_name, "'" + s.label + "'", s.count, rate,
                   detects ? std::to_string(s.detections) : "", detects ? std::to_string(s.identified) : "");
        if (!s.has_noise) fmt::print("  claims no noise: runs need [noise.{}]\n", s.label);
    }
}

/// What estimators need, against what the log has.
void printUses(const LogSummary& summary) {
    bool odometry = false, velocities = false, detections = false, lidar = false;
    bool identities = false;
    for (const SensorSummary& s : summary.sensors) {
        odometry |= s.class_name.find("Odometry") != std::string::npos ||
                    s.class_name.find("RobotMovement2D") != std::string::npos;
        velocities |= s.has_velocities;
        detections |= s.detections > 0;
        identities |= s.identified > 0;
        lidar |= s.class_name.find("Scan") != std::string::npos || s.class_name.find("PointCloud") != std::string::npos;
    }
    fmt::print("odometry: {}\n", !odometry   ? "none: no estimator can run"
                                 : velocities ? "yes, with velocities: every [motion] model"
                                              : "yes, without velocities: [motion] model = arc or increment");
    fmt::print("range-bearing detections: {}\n", detections ? "yes"
                                                 : lidar    ? "none; the lidar needs a detector plugin"
                                                            : "none");
    if (!odometry) return;
    const PluginRegistry registry = PluginRegistry::discover();
    for (const PluginInfo& plugin : registry.plugins()) {
        if (plugin.kind != "estimator") continue;
        const bool needs = registry.createEstimator(plugin.name)->usesDetections();
        fmt::print("  {:16} {}\n", plugin.name,
                   !needs || identities ? "can use it"
                   : detections         ? "can use it if it does without identities: the log has none"
                                        : "needs detections");
    }
}

int info(const Options& options, const Verbosity&) {
    const LogParameters parameters;
    const LogSummary summary = guardedSummary(options.log, parameters);
    if (options.json) {
        fmt::print("{}\n", toJson(summary));
    } else {
        fmt::print("{}: {} ({} objects)\n", options.log,
                   summary.format == LogFormat::observations ? "observations only" : "action-frame pairs", summary.objects);
        if (summary.timed_by_step) fmt::print("stamps cannot be used: time is the step number times [log] step\n");
        const Checksum checksum = checkChecksum(options.log);
        fmt::print("checksum: {}\n", checksum == Checksum::matches ? "matches" : "no checksum beside the log");
        printSensors(summary);
        for (const auto& [key, count] : summary.drops.rows())
            fmt::print("would be dropped: {} of '{}' ({})\n", count, key.first, key.second);
        printUses(summary);
    }
    if (summary.end == LogEnd::clean) return exit_success;
    fmt::print(stderr, "slamot: {}; the log is truncated\n", summary.end_message);
    return exit_bad_input;
}

}  // namespace

void addInfo(CLI::App& app, Action& chosen) {
    auto* command = app.add_subcommand("info",
                                       "What is in a log, what would be dropped and why, which estimators can use "
                                       "it.\nExample: slamot info demo.rawlog");
    auto options = std::make_shared<Options>();
    command->add_option("log", options->log, "Rawlog")->required();
    command->add_flag("--json", options->json, "As JSON");
    command->callback([&chosen, options] { chosen = [options](const Verbosity& v) { return info(*options, v); }; });
}

}  // namespace slamot::app
