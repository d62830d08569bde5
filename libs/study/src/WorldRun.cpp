#include "WorldRun.h"

#include <new>
#include <system_error>

#include "slamot/core/plugin/ErrorText.h"

namespace slamot::study {
namespace {

Config withSeed(Config config, std::uint64_t seed) {
    config.set("run", "seed", std::to_string(seed));
    return config;
}

}  // namespace

WorldRun::WorldRun(const Plan& plan, const WorldPlan& planned, const RunPlan& run, const World& world,
                   const PluginRegistry& registry)
    : assembled(run::assembleRun(
          withSeed(plan.configs[run.config].config, plan.estimatorSeedOf(planned, run)), registry)),
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
