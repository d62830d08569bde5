#pragma once
// A run in a world, set up: for rows and for figures of one run alike.
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "World.h"
#include "slamot/core/plugin/PluginRegistry.h"
#include "slamot/run/Run.h"

namespace slamot::study {

struct WorldRun {
    /// Throws what a config that does not fit throws.
    WorldRun(const Plan& plan, const WorldPlan& planned, const RunPlan& run, const World& world,
             const PluginRegistry& registry);

    run::AssembledRun assembled;
    std::unique_ptr<LogSource> log;
    run::RunInput input;  ///< of the world; sinks and stop flag are the caller's
};

/// What went wrong with writing, whatever it was: no fault of the method's.
class OutputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The sentence of an error of method, config or the log's contents, which comes again whenever the run is
/// done: a plugin may throw what it likes. Outputs, memory and files are no fault of the method's: thrown on,
/// they end the study. To be called within a catch.
std::string sentenceOfFailure();

}  // namespace slamot::study
