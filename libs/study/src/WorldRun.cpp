#include "WorldRun.h"

#include <new>
#include <system_error>

#include "slamot/core/plugin/ErrorText.h"

namespace slamot::study {
namespace {

/// Clutter is part of the world: the same for every config, so that comparisons are paired.
Config withSeeds(Config config, std::uint64_t estimator_seed, std::uint64_t world_seed) {
    config.set("run", "seed", std::to_string(estimator_seed));
    if (config.has("clutter")) config.set("clutter", "seed", std::to_string(world_seed));
    return config;
}

}  // namespace

WorldRun::WorldRun(const Plan& plan, const WorldPlan& planned, const RunPlan& run, const World& world,
                   const PluginRegistry& registry)
    : assembled(run::assembleRun(
          withSeeds(plan.configs[run.config].config, plan.estimatorSeedOf(planned, run), planned.world_seed),
          registry)),
      log(world.log(assembled.config.log)) {
    input.source = log.get();
    input.log_name = world.name();
    input.truth = world.truth();
    input.truth_name = world.truth() ? world.name() : "";
}

std::string sentenceOfFailure() {
    try {
        throw;
    } catch (const OutputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::system_error&) {
        throw;
    } catch (const std::exception& error) {
        return sentenceOf(error);
    }
}

}  // namespace slamot::study
