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

/// Shard k of K, k from 1, takes every K-th replicate of each scenario and point: shares of equal work.
struct Shard {
    int number = 1, count = 1;
    bool has(const WorldPlan& world) const;
};

/// What is handed out as a whole: a world and those of its runs that are wanted.
struct Unit {
    std::size_t world = 0;          ///< index of Plan::worlds
    std::vector<std::size_t> runs;  ///< indices of WorldPlan::runs
};

/// The shard's runs that are not in `done`, in the plan's order. A simulated world is one unit, since it is
/// made once; the runs of a recorded log are units of their own, since there are few such worlds and reading
/// is cheap.
std::vector<Unit> unitsOf(const Plan& plan, const std::set<std::string>& done, const Shard& shard);

struct UnitOptions {
    const std::atomic<bool>* stop = nullptr;
    bool measure_memory = false;  ///< only where nothing else runs in the process
    std::string keep_folder;      ///< each run's complete output folder below it; empty: no files
};

/// Simulates or reads the world once and runs what the unit has of it. A run that fails by its
/// method, config or log is a row with its reason; memory and files that fail are exceptions. Safe to call from several threads at once. Rows come in the unit's order; fewer when stopped.
std::vector<Row> runUnit(const Plan& plan, const Unit& unit, const PluginRegistry& registry,
                         const UnitOptions& options);

struct StudyProgress {
    std::size_t done = 0, total = 0, failed = 0;  ///< runs; those of earlier sessions are not counted
};

/// Time of a whole study against that of the runs it drove: the engine's overhead.
struct StudyTimes {
    double wall_s = 0, runs_s = 0;  ///< `runs_s`: sum over runs of simulating, running and evaluating
};

/// Takes the rows of a session, counts them and tells the progress.
class RowCounter {
  public:
    RowCounter(const std::vector<Unit>& units, std::function<void(const StudyProgress&)> tell,
               std::function<void(const Row&)> take);
    void operator()(const std::vector<Row>& rows);
    const StudyProgress& progress() const { return progress_; }
    double runsSeconds() const { return runs_s_; }

  private:
    StudyProgress progress_;
    double runs_s_ = 0;
    std::function<void(const StudyProgress&)> tell_;
    std::function<void(const Row&)> take_;
};

struct RunnerOptions {
    int threads = 1;
    UnitOptions unit;
    std::function<void(const StudyProgress&)> progress;
};

/// Runs the units, on oneTBB where `threads` > 1, and hands each row to `take`, one at a time.
StudyTimes runStudy(const Plan& plan, const std::vector<Unit>& units, const PluginRegistry& registry,
                    const RunnerOptions& options, const std::function<void(const Row&)>& take);

}  // namespace slamot::study
