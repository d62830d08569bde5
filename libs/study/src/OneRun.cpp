#include "slamot/study/OneRun.h"

#include <stdexcept>

#include "WorldRun.h"
#include "slamot/core/plugin/ErrorText.h"

namespace slamot::study {
namespace {

class JointAtEnd : public run::Sink {
  public:
    void step(const run::Step&) override {}
    void end(const run::RunEnd& end) override {
        if (end.estimator) joint = end.estimator->jointCovariance();
    }
    JointCovariance joint;
};

[[noreturn]] void throwStopped() {
    throw std::runtime_error(
        "stopped while a run was made again for a figure; the rows are kept, the same command does the rest");
}

void fill(OneRun& out, const WorldPlan& planned, const RunPlan& planned_run, const World& world,
          const Plan& plan, const PluginRegistry& registry, const std::atomic<bool>* stop) {
    WorldRun run(plan, planned, planned_run, world, registry);
    LandmarkHistory landmarks({"landmark_error_by_age"});  // the series that wants sights
    JointAtEnd at_end;
    run.input.stop = stop;
    run.input.sinks = {&landmarks, &at_end};
    run::RunResult result;
    try {
        result = run::runSource(run.assembled, run.input);
    } catch (const std::exception&) {
        out.status = toText(run::RunStatus::failed);
        out.reason = world.withoutPlace(sentenceOfFailure());
        return;
    }
    if (result.status == run::RunStatus::stopped) throwStopped();
    out.status = toText(result.status);
    out.reason = world.withoutPlace(result.end_message);
    out.record = std::move(result.record);
    out.sights = landmarks.sights();
    out.joint = std::move(at_end.joint);
    out.estimate_hash = result.estimate_hash;
    if (world.truth()) out.truth = *world.truth();
}

OneRun runAgain(const Plan& plan, const RunIndex& index, const PluginRegistry& registry,
                const std::atomic<bool>* stop) {
    const WorldPlan& planned = plan.worlds[index.first];
    const RunPlan& planned_run = plan.runsOf(planned)[index.second];
    OneRun out;
    out.key = plan.keyOf(planned, planned_run);
    std::optional<World> world;
    try {
        world.emplace(plan, planned, [&] { return stop && stop->load(); });
    } catch (const World::Stopped&) {
        throwStopped();
    } catch (const ConfigError& error) {
        out.status = toText(run::RunStatus::failed);
        out.reason = sentenceOf(error);
        return out;
    }
    fill(out, planned, planned_run, *world, plan, registry, stop);
    return out;
}

}  // namespace

std::optional<RunIndex> findRun(const Plan& plan, const OneRunChoice& choice) {
    for (std::size_t w = 0; w < plan.worlds.size(); ++w) {
        const WorldPlan& world = plan.worlds[w];
        if (plan.sourceOf(world).name != choice.source || world.scenario_point != 0 ||
            world.replicate != choice.replicate)
            continue;
        const std::vector<RunPlan>& runs = plan.runsOf(world);
        for (std::size_t r = 0; r < runs.size(); ++r)
            if (plan.variantOf(runs[r]).name == choice.config && runs[r].config_point == 0)
                return RunIndex{w, r};
    }
    return std::nullopt;
}

OneRuns::OneRuns(const Plan& plan, const PluginRegistry& registry, const std::atomic<bool>* stop)
    : plan_(plan), registry_(registry), stop_(stop) {}

const OneRun& OneRuns::again(const RunIndex& run) {
    if (stop_ && stop_->load()) throwStopped();
    if (last_ != run) {
        last_.reset();
        run_ = runAgain(plan_, run, registry_, stop_);
        last_ = run;
    }
    return run_;
}

}  // namespace slamot::study
