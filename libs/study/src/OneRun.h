#pragma once
// One run of a study, made again for what no row keeps: ways, landmarks over time, the joint covariance.
#include <optional>
#include <string>
#include <vector>

#include "slamot/core/data/Estimate.h"
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
};

/// Which one; of the first points of the grids.
struct OneRunChoice {
    std::string source, config;
    int replicate = 1;
};

/// None where the plan has no such run, for want of its data for example. Throws what running throws.
std::optional<OneRun> runAgain(const Plan& plan, const OneRunChoice& choice);

}  // namespace slamot::study
