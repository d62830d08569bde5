#pragma once
// Everything a run's config file says outside the plugins' own sections. One schema, used by `run`, `config`,
// studies and teams.
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "slamot/core/config/Config.h"
#include "slamot/core/plugin/PluginRegistry.h"
#include "slamot/eval/Options.h"
#include "slamot/rawlog/RawlogReader.h"
#include "slamot/run/Clutter.h"

namespace slamot::run {

/// What a sensor label's observations are.
enum class SensorRole { landmarks, movers, mixed, lidar, ignore };

/// Section `[sensors]`: keys are labels. `landmarks`, `movers` and `mixed` mean what they say unless set, an empty
/// label counts as landmarks, scans as lidar; observations of any other label need a line here to be used.
struct SensorRoles {
    std::map<std::string, SensorRole> by_label;
    /// Of a range-bearing sensor.
    std::optional<SensorRole> of(const std::string& label) const;
};

/// `[noise]` for all range-bearing sensors, `[noise.<label>]` for one: replaces what the log claims.
struct NoiseOverride {
    std::optional<double> range_std;      ///< [m]
    std::optional<double> range_std_per_m; ///< [m/m], added to range_std in proportion to the range
    std::optional<double> bearing_std;    ///< [rad]
};

enum class Identities { log, hidden };

enum class StartPose { zero, given, truth };
struct StartParameters {
    StartPose kind = StartPose::zero;
    Pose2 pose;
    double position_std = 0, heading_std = 0;  ///< [m], [rad]
};

/// `[output]`: which files a run writes beside trajectory, tracks, landmarks and summary, and how dense.
struct OutputParameters {
    double interval = 0;  ///< [s] between rows of trajectory and tracks; stamps with detections always get one
    bool innovations = true, landmarks_history = true, steps = true, correlation = true;
    bool tentative = false, particles = false;
    int most_particles = 200;  ///< at a stamp
    bool map = true, scene = true, rawlog = true, figure = true, report = true;
};

struct RunConfig {
    std::string estimator = "ekf_slamot", detector = "none", odometry = "auto";
    std::uint64_t seed = 1;
    double max_odometry_gap = 1.0;  ///< [s]
    LogParameters log;
    Identities landmark_identities = Identities::log, mover_identities = Identities::log;
    SensorRoles sensors;
    NoiseOverride noise;
    std::map<std::string, NoiseOverride> noise_by_label;
    ClutterParameters clutter;
    StartParameters start;
    OutputParameters output;
};

/// The tables of the sections with fixed keys, tied to `config`.
std::vector<ParameterTable> describe(RunConfig& config);

/// Reads and checks a whole config file, plugins' sections included. Throws ConfigError or PluginError.
struct AssembledRun {
    RunConfig config;
    std::shared_ptr<Estimator> estimator;  ///< initialized, not started
    std::shared_ptr<Detector> detector;    ///< null for none
    eval::EvaluationOptions evaluation;
    std::string canonical_config;
};
AssembledRun assembleRun(const Config& config, const PluginRegistry& registry);

/// A complete, commented, runnable config file for a plugin: what `slamot config` prints and config/ holds.
std::string fullConfigText(const std::string& plugin, const PluginRegistry& registry);

}  // namespace slamot::run
