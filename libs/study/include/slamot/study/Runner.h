#pragma once
// Runs what is missing of a study.
#include <atomic>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "slamot/core/plugin/PluginRegistry.h"
#include "slamot/study/Row.h"

namespace slamot::study {

/// Simulates or reads the world once and runs what of it is not in `done`. A run that throws is a row with its
/// reason. Safe to call from several threads at once. Rows come in the world's order; fewer when stopped.
struct WorldOptions {
    const std::atomic<bool>* stop = nullptr;
    bool measure_memory = false;  ///< only where nothing else runs in the process
    std::string keep_folder;      ///< each run's complete output folder below it; empty: no files
};
std::vector<Row> runWorld(const Plan& plan, const WorldPlan& world, const std::set<std::string>& done,
                          const PluginRegistry& registry, const WorldOptions& options);

/// Shard k of K takes every K-th world, k from 1.
struct Shard {
    int number = 1, count = 1;
    bool has(std::size_t world) const { return static_cast<int>(world % static_cast<std::size_t>(count)) == number - 1; }
};

struct StudyProgress {
    std::size_t done = 0, total = 0, failed = 0;  ///< runs; those of earlier sessions are not counted
};

struct RunnerOptions {
    Shard shard;
    int threads = 1;
    WorldOptions world;
    std::function<void(const StudyProgress&)> progress;
};

/// Time of a whole study against that of the runs it drove: the engine's overhead.
struct StudyTimes {
    double wall_s = 0, runs_s = 0;  ///< `runs_s`: sum over runs of simulating, running and evaluating
};

/// Runs the shard's missing runs, on oneTBB where `threads` > 1, and hands each row to `take`, one at a time.
StudyTimes runStudy(const Plan& plan, const std::set<std::string>& done, const PluginRegistry& registry,
                    const RunnerOptions& options, const std::function<void(const Row&)>& take);

}  // namespace slamot::study
