// One world and its runs, in one thread.
#include <fmt/format.h>
#include <mrpt/core/exceptions.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "Meters.h"
#include "WorldRun.h"
#include "slamot/core/plugin/Detector.h"
#include "slamot/core/plugin/ErrorText.h"
#include "slamot/core/plugin/Estimator.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/run/CpuClock.h"
#include "slamot/run/OutputFolder.h"
#include "slamot/run/Run.h"
#include "slamot/study/Runner.h"
#include "slamot/study/Series.h"

namespace slamot::study {
namespace {

namespace fs = std::filesystem;

/// The part of a list that stands for its place: what it is about, where it says so.
std::string placeOf(const nlohmann::json& item, std::size_t index) {
    if (!item.is_object() || !item.contains("sensor")) return std::to_string(index);
    return item["sensor"].get<std::string>() + "." + item["kind"].get<std::string>();
}

void flatten(const nlohmann::json& json, const std::string& name, std::map<std::string, double>& metrics) {
    const std::string prefix = name.empty() ? "" : name + ".";
    if (json.is_object())
        for (const auto& [key, value] : json.items()) flatten(value, prefix + key, metrics);
    else if (json.is_array())
        for (std::size_t i = 0; i < json.size(); ++i) flatten(json[i], prefix + placeOf(json[i], i), metrics);
    else if (json.is_number() && std::isfinite(json.get<double>()))
        metrics[name] = json.get<double>();
}

Row rowOf(const Plan& plan, const WorldPlan& world, const RunPlan& run) {
    Row row;
    row.key = plan.keyOf(world, run);
    setLabels(row, plan, world, run);
    row.world_seed = world.world_seed;
    row.estimator_seed = plan.estimatorSeedOf(world, run);
    row.build = plan.configs[run.config].build;
    row.cost.host = hostName();
    return row;
}

void fill(Row& row, const run::RunResult& result, const std::vector<std::string>& series,
          const LandmarkHistory& landmarks, const Truth* truth) {
    row.status = toText(result.status);
    row.estimate_hash = result.estimate_hash;
    flatten(result.summary["metrics"], "", row.metrics);
    flatten(result.summary["counts"], "counts", row.metrics);
    row.series = seriesOf(series, result.record, landmarks, truth);
    const nlohmann::json& time = result.summary["time"];
    const auto number = [](const nlohmann::json& json) {
        return json.is_number() ? json.get<double>() : Cost::none;
    };
    row.cost.wall_s = number(time["wall_s"]);
    row.cost.step_ms_mean = number(time["step_ms"]["mean"]);
    const double cpu_s =
        number(time["predict_cpu_s"]) + number(time["detect_cpu_s"]) + number(time["update_cpu_s"]);
    const double steps = number(time["steps"]);
    row.cost.step_cpu_ms_mean = steps > 0 ? 1e3 * cpu_s / steps : Cost::none;
    row.cost.step_ms_p50 = number(time["step_ms"]["p50"]);
    row.cost.step_ms_p99 = number(time["step_ms"]["p99"]);
    row.cost.step_ms_max = number(time["step_ms"]["max"]);
}

/// Where the truth of a kept world is: beside its runs, whose summaries name it.
std::string truthFolderIn(const fs::path& world_folder) {
    return (world_folder / "truth").string();
}

/// Tells the errors of another sink from those of the run.
class CheckedSink : public run::Sink {
  public:
    explicit CheckedSink(run::Sink& sink) : sink_(sink) {}
    void observation(const mrpt::obs::CObservation& observation) override {
        checked([&] { sink_.observation(observation); });
    }
    void step(const run::Step& step) override {
        checked([&] { sink_.step(step); });
    }
    void end(const run::RunEnd& end) override {
        checked([&] { sink_.end(end); });
    }

  private:
    template <class Function>
    static void checked(const Function& function) {
        try {
            function();
        } catch (const std::exception& error) {
            throw OutputError(sentenceOf(error));
        }
    }
    run::Sink& sink_;
};

/// Runs the config through the world; an exception is one that ends the study.
run::RunStatus runInto(Row& row, const Plan& plan, const WorldPlan& planned, const RunPlan& planned_run,
                       const World& world, const std::string& folder, const PluginRegistry& registry,
                       const UnitOptions& options) {
    MemoryMeter memory;
    if (options.measure_memory) memory.start();
    WorldRun run(plan, planned, planned_run, world, registry);
    LandmarkHistory landmarks(plan.study.parameters.series);
    run.input.stop = options.stop;
    run.input.sinks.push_back(&landmarks);
    std::optional<run::OutputFolder> output;
    std::vector<std::unique_ptr<CheckedSink>> checked;
    if (!folder.empty()) {
        if (world.truth()) run.input.truth_name = truthFolderIn(fs::path(folder).parent_path());
        output.emplace(folder, run.assembled, "");
        for (run::Sink* sink : output->sinks()) checked.push_back(std::make_unique<CheckedSink>(*sink));
        for (const auto& sink : checked) run.input.sinks.push_back(sink.get());
    }
    const double cpu_begin = run::threadCpuSeconds();
    run::RunResult result;
    try {
        result = run::runSource(run.assembled, run.input);
    } catch (const std::exception&) {
        row.status = toText(run::RunStatus::failed);
        row.reason = world.withoutPlace(sentenceOfFailure());
        return run::RunStatus::failed;
    }
    row.cost.cpu_s = run::threadCpuSeconds() - cpu_begin;
    if (options.measure_memory) row.cost.memory_mb = memory.most();
    if (output) output->writeSummary(result.summary);
    fill(row, result, plan.study.parameters.series, landmarks, world.truth());
    row.reason = world.withoutPlace(result.end_message);
    return result.status;
}

}  // namespace

std::vector<Row> runUnit(const Plan& plan, const Unit& unit, const PluginRegistry& registry,
                         const UnitOptions& options) {
    const auto stopped = [&] { return options.stop && options.stop->load(); };
    const WorldPlan& planned = plan.worlds[unit.world];
    std::vector<Row> rows;
    for (const std::size_t i : unit.runs) rows.push_back(rowOf(plan, planned, plan.runsOf(planned)[i]));

    std::optional<World> world;
    try {
        world.emplace(plan, planned, stopped);
    } catch (const World::Stopped&) {
        return {};
    } catch (const ConfigError& error) {
        for (Row& row : rows) row.status = toText(run::RunStatus::failed), row.reason = sentenceOf(error);
        return rows;
    }
    const std::string folder =
        options.keep_folder.empty() ? "" : options.keep_folder + "/" + plan.nameOf(planned);
    if (!folder.empty() && world->truth()) writeTruth(*world->truth(), truthFolderIn(folder));

    for (std::size_t i = 0; i < unit.runs.size(); ++i) {
        const RunPlan& run = plan.runsOf(planned)[unit.runs[i]];
        const auto begin = std::chrono::steady_clock::now();
        Row& row = rows[i];
        row.cost.simulate_s = world->secondsToMake() / static_cast<double>(unit.runs.size());
        const run::RunStatus status =
            runInto(row, plan, planned, run, *world, folder.empty() ? "" : folder + "/" + plan.nameOf(run),
                    registry, options);
        if (status == run::RunStatus::stopped) {
            rows.resize(i);
            return rows;
        }
        if (!std::isfinite(row.cost.wall_s))
            row.cost.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }
    return rows;
}

}  // namespace slamot::study
