#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "slamot/run/Pipeline.h"
#include "slamot/run/RecordSinks.h"

namespace slamot::run {

/// What summary.json is made from.
struct SummaryInput {
    RunStatus status = RunStatus::complete;
    std::string end_message, log_file, truth_folder, canonical_config, estimator, detector, estimate_hash;
    std::uint64_t seed = 0;
    int threads = 1;
    const PipelineCounts* counts = nullptr;
    const StepTimer* timer = nullptr;
    DropTable drops;
    std::map<std::string, RangeBearingSensor> sensors;
    std::vector<std::string> warnings;
    RunEnd end;
    double wall_seconds = 0, cpu_seconds = 0;
    nlohmann::json metrics;  ///< null without truth
};

/// Names of what `counts` of summary.json holds: numbers all.
std::vector<std::string> summaryCountNames();

nlohmann::json makeSummary(const SummaryInput& input);

}  // namespace slamot::run
