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
    if (planned.config.has("clutter")) planned.config.set("clutter", "seed", "auto");
    const run::AssembledRun assembled = run::assembleRun(planned.config, registry);
    planned.digest = digestOf({assembled.canonical_config});
    std::vector<const PluginInfo*> plugins = {&registry.find(assembled.config.estimator, "estimator")};
    if (assembled.detector) plugins.push_back(&registry.find(assembled.config.detector, "detector"));
    planned.build = buildOf(plugins);
    return planned;
}

/// A variant with a file of its own is one config, unless sources it runs on tell it something; otherwise one
/// for each source it runs on.
std::vector<PlannedConfig> plannedConfigs(const StudyFile& study, std::size_t variant, std::size_t point,
                                          const PluginRegistry& registry) {
    const Variant& wanted = study.variants[variant];
    const bool told = std::any_of(study.sources.begin(), study.sources.end(), [&](const Source& source) {
        return runsOn(wanted, source) && !source.told.sectionNames().empty();
    });
    if (wanted.file && !told) return {plannedConfig(study, variant, point, *wanted.file, registry)};
    std::vector<PlannedConfig> configs;
    for (std::size_t i = 0; i < study.sources.size(); ++i) {
        const Source& source = study.sources[i];
        if (!runsOn(wanted, source)) continue;
        configs.push_back(
            plannedConfig(study, variant, point,
                          withOverrides(wanted.file ? *wanted.file : *source.config, source.told), registry));
        configs.back().source = i;
    }
    return configs;
}

/// `folder`: where the files that the scenario names lie, if not beside it.
std::vector<PlannedWorldKind> scenarioKinds(const StudyFile& study, std::size_t source,
                                            const std::string& folder) {
    std::vector<PlannedWorldKind> kinds;
    for (std::size_t point = 0; point < study.scenario_grid.size(); ++point) {
        PlannedWorldKind kind;
        kind.source = source;
        kind.scenario_point = point;
        const ScenarioSource& wanted = *study.sources[source].scenario;
        kind.scenario = at(study.scenario_grid[point], wanted.scenario, "grid.scenario", study.text);
        if (!folder.empty()) kind.scenario->setFolder(folder);
        const sim::Scenario scenario = sim::loadScenario(*kind.scenario);
        const bool has_robot = std::any_of(scenario.robots.begin(), scenario.robots.end(),
                                           [&](const auto& robot) { return robot.number == wanted.robot; });
        if (!has_robot)
            throw ConfigError(fmt::format("{}: [scenario.{}] has no robot {}, expected one of the scenario's",
                                          study.text.origin("scenario." + study.sources[source].name),
                                          study.sources[source].name, wanted.robot));
        std::vector<std::string> made_from = {study.sources[source].name, kind.scenario->canonicalText(),
                                              std::to_string(wanted.robot)};
        for (const std::string& file : sim::filesOf(scenario)) made_from.push_back(sha256OfFile(file));
        kind.digest = digestOf(made_from);
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

std::vector<RunPlan> runsIn(const Plan& plan, std::size_t source) {
    std::vector<RunPlan> runs;
    for (std::size_t c = 0; c < plan.configs.size(); ++c) {
        const PlannedConfig& config = plan.configs[c];
        if (config.source.value_or(source) == source &&
            runsOn(plan.study.variants[config.variant], plan.study.sources[source]))
            runs.push_back({config.variant, config.config_point, c});
    }
    return runs;
}

/// Of each log of a source: what the request says, unless the file runs its logs once.
int replicatesOf(const Source& source, const StudyFile& study, const PlanRequest& request) {
    const int wanted = source.log->replicates;
    if (wanted == 1) return 1;
    return request.replicates.value_or(
        request.short_form ? std::min(wanted, study.parameters.short_replicates) : wanted);
}

std::uint64_t sourceSeed(const StudyFile& study, std::size_t source) {
    return derivedSeed(study.parameters.seed, bitsOf(digestOf({study.sources[source].name})));
}

WorldPlan worldOf(const Plan& plan, std::size_t kind, int replicate, std::uint64_t source_seed) {
    WorldPlan world;
    world.source = static_cast<std::uint32_t>(plan.kinds[kind].source);
    world.scenario_point = static_cast<std::uint32_t>(plan.kinds[kind].scenario_point);
    world.kind = static_cast<std::uint32_t>(kind);
    world.replicate = replicate;
    world.world_seed = derivedSeed(source_seed, static_cast<std::uint64_t>(replicate));
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
    for (const WorldPlan& world : worlds) count += runsOf(world).size();
    return count;
}

std::string Plan::keyOf(const WorldPlan& world, const RunPlan& run) const {
    return digestOf({kinds[world.kind].digest, std::to_string(world.world_seed), variantOf(run).name,
                     configs[run.config].digest, fmt::format("{}", fmt::join(study.parameters.series, ",")),
                     version});
}

std::uint64_t Plan::estimatorSeedOf(const WorldPlan& world, const RunPlan& run) const {
    return derivedSeed(world.world_seed, bitsOf(configs[run.config].digest));
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
        const std::string& dataset = file.sources[source].scenario->folder;
        const FoundFolder found =
            dataset.empty() ? FoundFolder{} : findDataset(file, file.sources[source], dataset);
        if (!found.why_none.empty()) {
            plan.skipped.push_back(found.why_none);
            continue;
        }
        for (PlannedWorldKind& kind :
             inFile(fmt::format("{}: [scenario.{}]", file.path, file.sources[source].name),
                    [&] { return scenarioKinds(file, source, found.folder); })) {
            scenario_kinds.push_back(plan.kinds.size());
            kind.runs = runsIn(plan, source);
            plan.kinds.push_back(std::move(kind));
        }
    }
    for (std::size_t source = 0; source < file.sources.size(); ++source) {
        if (!file.sources[source].log) continue;
        const FoundLogs found = findLogs(file, file.sources[source], request.work_folder);
        if (!found.why_none.empty()) plan.skipped.push_back(found.why_none);
        const std::size_t first_kind = plan.kinds.size();
        for (PlannedWorldKind& kind : logKinds(file, source, found.files)) {
            kind.runs = runsIn(plan, source);
            plan.kinds.push_back(std::move(kind));
        }
        int replicate = 0;
        for (int round = replicatesOf(file.sources[source], file, request); round > 0; --round)
            for (std::size_t kind = first_kind; kind < plan.kinds.size(); ++kind)
                plan.worlds.push_back(worldOf(plan, kind, ++replicate, sourceSeed(file, source)));
    }
    const int replicates = request.replicates.value_or(request.short_form ? file.parameters.short_replicates
                                                                          : file.parameters.replicates);
    std::vector<std::uint64_t> seeds;
    for (const std::size_t kind : scenario_kinds) seeds.push_back(sourceSeed(file, plan.kinds[kind].source));
    plan.worlds.reserve(plan.worlds.size() + scenario_kinds.size() * static_cast<std::size_t>(replicates));
    for (int replicate = 1; replicate <= replicates; ++replicate)
        for (std::size_t i = 0; i < scenario_kinds.size(); ++i)
            plan.worlds.push_back(worldOf(plan, scenario_kinds[i], replicate, seeds[i]));
    if (plan.runCount() == 0)
        throw ConfigError(fmt::format("{}: nothing remains to run{}{}", file.path,
                                      plan.skipped.empty() ? "" : "; ", fmt::join(plan.skipped, "; ")));
    return plan;
}

}  // namespace slamot::study
