#pragma once
// What a study file asks for, before anything runs: every world, every run in it, their keys and seeds. All
// of it is a function of the file and the program's version, so that serial, parallel, sharded and resumed
// studies agree.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "slamot/core/config/Config.h"
#include "slamot/core/plugin/PluginRegistry.h"

namespace slamot::study {

/// Section `[study]`.
struct StudyParameters {
    std::string about;
    std::uint64_t seed = 1;
    int replicates = 50;        ///< worlds drawn of each scenario
    int short_replicates = 10;  ///< of the short form
    /// A run whose robot position RMSE exceeds this counts as diverged [m].
    double diverged_above = 10;
    std::vector<std::string> series;  ///< kept step by step, names of Series.h
};

/// Section `[scenario.NAME]`: worlds that are simulated.
struct ScenarioSource {
    Config scenario;  ///< overrides applied
    int robot = 0;    ///< the log taken, where there are several
    /// Of SLAMOT_DATASETS: where files that the scenario names lie; empty: beside the scenario.
    std::string folder;
};

/// Section `[log.NAME]`: recorded logs, each one world or, with replicates, several.
struct LogSourceFiles {
    /// Made by an importer from a folder of SLAMOT_DATASETS, or files beside the study; a pattern
    /// (`robot_*.rawlog`).
    std::string importer, folder, files;
    int replicates = 1;  ///< runs of each log, with seeds of their own
};

/// Where worlds come from. Exactly one of the two is set.
struct Source {
    std::string name;
    std::optional<ScenarioSource> scenario;
    std::optional<LogSourceFiles> log;
    /// Of the world's own: where the variants that name no file begin.
    std::optional<Config> config;
    /// Section `[told.NAME]`: what runs on it are told, whatever config they begin with.
    Config told;
};

/// Section `[config.NAME]`: one side of a comparison.
struct Variant {
    std::string name;
    std::optional<Config> file;  ///< absent: the source's own config
    Config overrides;
    std::vector<std::string> on;  ///< sources it runs on; empty: all
};

/// `section.key` and value, in the order of the file: the sections `[grid]` (configs) and `[grid.scenario]`.
using GridPoint = std::vector<std::pair<std::string, std::string>>;

struct StudyFile {
    std::string path, name;
    StudyParameters parameters;
    std::vector<Source> sources;                        ///< in the order of the file
    std::vector<Variant> variants;                      ///< in the order of the file
    std::vector<GridPoint> config_grid, scenario_grid;  ///< at least one point, which may be empty
    Config text;  ///< all sections: tables, figures and checks are read from it by Analysis
};

/// Reads and checks a study file strictly. Throws ConfigError.
StudyFile loadStudy(const std::string& path);

/// A config as it runs, but for its seed: a variant at a point of the grid.
struct PlannedConfig {
    std::size_t variant = 0, config_point = 0;
    std::optional<std::size_t> source;  ///< whose own config it is made from
    Config config;
    std::string digest;  ///< SHA-256 of its text without the seed
    std::string build;   ///< buildOf the plugins it uses
};

/// One run in every world of a kind.
struct RunPlan {
    std::size_t variant = 0, config_point = 0;
    std::size_t config = 0;  ///< index of Plan::configs
};

/// A scenario at a point of its grid, or one recorded log.
struct PlannedWorldKind {
    std::size_t source = 0, scenario_point = 0;
    std::optional<Config> scenario;
    std::string log_file;
    std::string digest;  ///< SHA-256 of what the world is made from
    std::vector<RunPlan> runs;
};

/// The runs that share one world, which is made once: comparisons are paired by it. Plans have millions of
/// these: what all worlds of a kind share stands there, and keys are computed when they are asked for.
struct WorldPlan {
    std::uint32_t source = 0, scenario_point = 0;
    std::uint32_t kind = 0;  ///< index of Plan::kinds
    int replicate = 1;  ///< counts from 1; of recorded logs, their number within the source, round by round
    /// f(study seed, source's name, replicate): the same for every config and every point of the grid.
    std::uint64_t world_seed = 0;
};

/// Index of Plan::worlds and of the runs of its kind.
using RunIndex = std::pair<std::size_t, std::size_t>;

struct Plan {
    StudyFile study;
    std::vector<PlannedConfig> configs;
    std::vector<PlannedWorldKind> kinds;
    /// Recorded logs first, then replicate by replicate: a longer study begins with the shorter one's worlds.
    std::vector<WorldPlan> worlds;
    /// Sources that cannot run here and why: a dataset that is not there.
    std::vector<std::string> skipped;

    std::size_t runCount() const;
    const std::vector<RunPlan>& runsOf(const WorldPlan& world) const { return kinds[world.kind].runs; }
    /// SHA-256 of world, config, series and program version, as hex.
    std::string keyOf(const WorldPlan& world, const RunPlan& run) const;
    /// f(world seed, config).
    std::uint64_t estimatorSeedOf(const WorldPlan& world, const RunPlan& run) const;
    const Source& sourceOf(const WorldPlan& world) const { return study.sources[world.source]; }
    const Variant& variantOf(const RunPlan& run) const { return study.variants[run.variant]; }
    /// Words for messages and folders: `paper1-p2-17`, the second point of a grid of several, replicate 17.
    std::string nameOf(const WorldPlan& world) const;
    std::string nameOf(const RunPlan& run) const;
};

struct PlanRequest {
    bool short_form = false;
    std::optional<int> replicates;  ///< overrides the file's
    std::string work_folder;        ///< where importers put their logs
};

/// Lays out all runs; assembles each config once, so that a mistake in any of them is found before the first
/// run, and so that all plugins are loaded before any thread starts. Throws ConfigError, PluginError or
/// LogError.
Plan layOut(StudyFile study, const PlanRequest& request, const PluginRegistry& registry);

}  // namespace slamot::study
