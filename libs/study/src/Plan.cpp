#include "slamot/study/Plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "Digest.h"
#include "LogFiles.h"
#include "Sources.h"
#include "slamot/core/Version.h"
#include "slamot/core/random/RandomStream.h"
#include "slamot/rawlog/RawlogWriter.h"
#include "slamot/rawlog/Truth.h"
#include "slamot/run/RunConfig.h"
#include "slamot/sim/Scenario.h"
#include "slamot/study/Build.h"

namespace slamot::study {
namespace {

namespace fs = std::filesystem;

Config at(const GridPoint& point, Config config, const std::string& section, const Config& text) {
    for (const auto& [address, value] : point) {
        const auto dot = address.rfind('.');
        config.set(address.substr(0, dot), address.substr(dot + 1), value,
                   text.section(section).at(address).origin);
    }
    return config;
}

/// Assembles the config, which checks it and loads its plugins.
PlannedConfig plannedConfig(const StudyFile& study, std::size_t variant, std::size_t point,
                            const Config& base, const PluginRegistry& registry) {
    PlannedConfig planned;
    planned.variant = variant;
    planned.config_point = point;
    planned.config = at(study.config_grid[point], withOverrides(base, study.variants[variant].overrides),
                        "grid", study.text);
    planned.config.set("run", "seed", "1");
    const run::AssembledRun assembled = run::assembleRun(planned.config, registry);
    planned.digest = digestOf({assembled.canonical_config});
    std::vector<const PluginInfo*> plugins = {&registry.find(assembled.config.estimator, "estimator")};
    if (assembled.detector) plugins.push_back(&registry.find(assembled.config.detector, "detector"));
    planned.build = buildOf(plugins);
    return planned;
}

/// A variant with a file of its own is one config, otherwise one for each source it runs on.
std::vector<PlannedConfig> plannedConfigs(const StudyFile& study, std::size_t variant, std::size_t point,
                                          const PluginRegistry& registry) {
    const Variant& wanted = study.variants[variant];
    if (wanted.file) return {plannedConfig(study, variant, point, *wanted.file, registry)};
    std::vector<PlannedConfig> configs;
    for (std::size_t source = 0; source < study.sources.size(); ++source) {
        if (!runsOn(wanted, study.sources[source])) continue;
        configs.push_back(plannedConfig(study, variant, point, *study.sources[source].config, registry));
        configs.back().source = source;
    }
    return configs;
}

std::vector<PlannedWorldKind> scenarioKinds(const StudyFile& study, std::size_t source) {
    std::vector<PlannedWorldKind> kinds;
    for (std::size_t point = 0; point < study.scenario_grid.size(); ++point) {
        PlannedWorldKind kind;
        kind.source = source;
        kind.scenario_point = point;
        const ScenarioSource& wanted = *study.sources[source].scenario;
        kind.scenario = at(study.scenario_grid[point], wanted.scenario, "grid.scenario", study.text);
        const sim::Scenario scenario = sim::loadScenario(*kind.scenario);
        const bool has_robot = std::any_of(scenario.robots.begin(), scenario.robots.end(),
                                           [&](const auto& robot) { return robot.number == wanted.robot; });
        if (!has_robot)
            throw ConfigError(fmt::format("{}: [scenario.{}] has no robot {}, expected one of the scenario's",
                                          study.text.origin("scenario." + study.sources[source].name),
                                          study.sources[source].name, wanted.robot));
        const std::string landmarks = scenario.world.file.empty() ? "" : sha256OfFile(scenario.world.file);
        kind.digest = digestOf({study.sources[source].name, kind.scenario->canonicalText(),
                                std::to_string(wanted.robot), landmarks});
        kinds.push_back(std::move(kind));
    }
    return kinds;
}

/// Of the tables in the log's truth folder; where it came from (truth.json) does not matter.
std::string truthDigest(const std::string& log_file) {
    std::vector<std::string> contents;
    std::error_code no_folder;
    for (const auto& entry : fs::directory_iterator(truthFolderOf(log_file), no_folder))
        if (entry.path().extension() == ".csv")
            contents.push_back(entry.path().filename().string() + " " + sha256OfFile(entry.path().string()));
    std::sort(contents.begin(), contents.end());
    return digestOf(contents);
}

std::vector<PlannedWorldKind> logKinds(const StudyFile& study, std::size_t source,
                                       const std::vector<std::string>& files) {
    std::vector<PlannedWorldKind> kinds;
    for (const std::string& file : files) {
        PlannedWorldKind kind;
        kind.source = source;
        kind.log_file = file;
        kind.digest = digestOf({study.sources[source].name, fs::path(file).filename().string(),
                                sha256OfFile(file), truthDigest(file)});
        kinds.push_back(std::move(kind));
    }
    return kinds;
}

WorldPlan worldOf(const Plan& plan, std::size_t kind, int replicate) {
    const StudyFile& study = plan.study;
    WorldPlan world;
    world.source = plan.kinds[kind].source;
    world.scenario_point = plan.kinds[kind].scenario_point;
    const Source& source = study.sources[world.source];
    world.kind = kind;
    world.replicate = replicate;
    const std::uint64_t source_seed = derivedSeed(study.parameters.seed, bitsOf(digestOf({source.name})));
    world.world_seed = derivedSeed(source_seed, static_cast<std::uint64_t>(replicate));
    for (std::size_t c = 0; c < plan.configs.size(); ++c) {
        const PlannedConfig& config = plan.configs[c];
        if (config.source.value_or(world.source) != world.source ||
            !runsOn(study.variants[config.variant], source))
            continue;
        RunPlan run;
        run.variant = config.variant;
        run.config_point = config.config_point;
        run.config = c;
        run.estimator_seed = derivedSeed(world.world_seed, bitsOf(config.digest));
        run.key = digestOf({plan.kinds[kind].digest, std::to_string(world.world_seed),
                            study.variants[config.variant].name, config.digest,
                            fmt::format("{}", fmt::join(study.parameters.series, ",")), version});
        world.runs.push_back(std::move(run));
    }
    return world;
}

/// What a mistake in a scenario or config is in, when the sentence names no file of its own.
template <class Function>
auto inFile(const std::string& name, const Function& function) {
    try {
        return function();
    } catch (const ConfigError& error) {
        const std::string what = error.what();
        throw ConfigError(what.find(".ini") == std::string::npos ? name + ": " + what : what);
    }
}

}  // namespace

std::size_t Plan::runCount() const {
    std::size_t count = 0;
    for (const WorldPlan& world : worlds) count += world.runs.size();
    return count;
}

std::set<std::string> Plan::keys() const {
    std::set<std::string> all;
    for (const WorldPlan& world : worlds)
        for (const RunPlan& run : world.runs) all.insert(run.key);
    return all;
}

std::string Plan::nameOf(const WorldPlan& world) const {
    const std::string point = study.scenario_grid.size() > 1 && kinds[world.kind].scenario
                                  ? fmt::format("-p{}", world.scenario_point + 1)
                                  : "";
    return fmt::format("{}{}-{}", sourceOf(world).name, point, world.replicate);
}

std::string Plan::nameOf(const RunPlan& run) const {
    const std::string point = study.config_grid.size() > 1 ? fmt::format("-p{}", run.config_point + 1) : "";
    return variantOf(run).name + point;
}

Plan layOut(StudyFile study, const PlanRequest& request, const PluginRegistry& registry) {
    Plan plan;
    plan.study = std::move(study);
    const StudyFile& file = plan.study;
    for (std::size_t variant = 0; variant < file.variants.size(); ++variant)
        for (std::size_t point = 0; point < file.config_grid.size(); ++point)
            for (PlannedConfig& config :
                 inFile(fmt::format("{}: [config.{}]", file.path, file.variants[variant].name),
                        [&] { return plannedConfigs(file, variant, point, registry); }))
                plan.configs.push_back(std::move(config));

    std::vector<std::size_t> scenario_kinds;
    for (std::size_t source = 0; source < file.sources.size(); ++source) {
        if (!file.sources[source].scenario) continue;
        for (PlannedWorldKind& kind :
             inFile(fmt::format("{}: [scenario.{}]", file.path, file.sources[source].name),
                    [&] { return scenarioKinds(file, source); })) {
            scenario_kinds.push_back(plan.kinds.size());
            plan.kinds.push_back(std::move(kind));
        }
    }
    for (std::size_t source = 0; source < file.sources.size(); ++source) {
        if (!file.sources[source].log) continue;
        const FoundLogs found = findLogs(file, file.sources[source], request.work_folder);
        if (!found.why_none.empty()) plan.skipped.push_back(found.why_none);
        int replicate = 0;
        for (PlannedWorldKind& kind : logKinds(file, source, found.files)) {
            plan.kinds.push_back(std::move(kind));
            plan.worlds.push_back(worldOf(plan, plan.kinds.size() - 1, ++replicate));
        }
    }
    const int replicates = request.replicates.value_or(request.short_form ? file.parameters.short_replicates
                                                                          : file.parameters.replicates);
    for (int replicate = 1; replicate <= replicates; ++replicate)
        for (const std::size_t kind : scenario_kinds) plan.worlds.push_back(worldOf(plan, kind, replicate));
    if (plan.runCount() == 0)
        throw ConfigError(fmt::format("{}: nothing remains to run{}{}", file.path,
                                      plan.skipped.empty() ? "" : "; ", fmt::join(plan.skipped, "; ")));
    return plan;
}

}  // namespace slamot::study
