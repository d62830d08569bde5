#pragma once
// One run of a study, made again for what no row keeps: ways, landmarks over time, the joint covariance.
#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "slamot/core/data/Estimate.h"
#include "slamot/core/plugin/PluginRegistry.h"
#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/Truth.h"
#include "slamot/study/Plan.h"
#include "slamot/study/Series.h"

namespace slamot::study {

struct OneRun {
    eval::RunRecord record;
    std::optional<Truth> truth;
    std::vector<LandmarkSight> sights;
    JointCovariance joint;           ///< at the end; empty where the estimator has none
    std::string key, estimate_hash;  ///< as the run's row has them
    std::string status, reason;      ///< too; anything but `complete` is no run to draw
};

/// Which one; of the first points of the grids.
struct OneRunChoice {
    std::string source, config;
    int replicate = 1;
};

/// None where the plan has no such run, for want of its data for example.
std::optional<RunIndex> findRun(const Plan& plan, const OneRunChoice& choice);

/// Makes runs again, one after another. Figures of one run often are of the same one: the last is kept.
class OneRuns {
  public:
    /// `stop` is set by another hand; null for none.
    OneRuns(const Plan& plan, const PluginRegistry& registry, const std::atomic<bool>* stop = nullptr);
    const Plan& plan() const { return plan_; }
    /// A run that fails says so in its status, as its row would. Throws std::runtime_error when stopped.
    /// Valid until the next one is asked for.
    const OneRun& again(const RunIndex& run);

  private:
    const Plan& plan_;
    const PluginRegistry& registry_;
    const std::atomic<bool>* stop_;
    std::optional<RunIndex> last_;
    OneRun run_;
};

}  // namespace slamot::study
