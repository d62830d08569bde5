#include "OneRun.h"

#include "World.h"
#include "slamot/core/plugin/PluginRegistry.h"
#include "slamot/run/Run.h"

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

OneRun again(const Plan& plan, const WorldPlan& planned, const RunPlan& run) {
    const World world(plan, planned, [] { return false; });
    Config config = plan.configs[run.config].config;
    config.set("run", "seed", std::to_string(plan.estimatorSeedOf(planned, run)));
    const run::AssembledRun assembled = run::assembleRun(config, PluginRegistry::discover());
    const auto log = world.log(assembled.config.log);
    LandmarkHistory landmarks({"landmark_error_by_age"});  // the series that wants sights
    JointAtEnd at_end;
    run::RunInput input;
    input.source = log.get();
    input.log_name = world.name();
    input.truth = world.truth();
    input.truth_name = world.truth() ? world.name() : "";
    input.sinks = {&landmarks, &at_end};
    run::RunResult result = run::runSource(assembled, input);

    OneRun out{std::move(result.record), std::nullopt,        landmarks.sights(), std::move(at_end.joint),
               plan.keyOf(planned, run), result.estimate_hash};
    if (world.truth()) out.truth = *world.truth();
    return out;
}

}  // namespace

std::optional<OneRun> runAgain(const Plan& plan, const OneRunChoice& choice) {
    for (const WorldPlan& world : plan.worlds) {
        if (plan.sourceOf(world).name != choice.source || world.scenario_point != 0 ||
            world.replicate != choice.replicate)
            continue;
        for (const RunPlan& run : plan.runsOf(world))
            if (plan.variantOf(run).name == choice.config && run.config_point == 0)
                return again(plan, world, run);
    }
    return std::nullopt;
}

}  // namespace slamot::study
