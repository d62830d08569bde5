#pragma once
// One run in memory: entries from anywhere through a pipeline, results as values. RunJob.h adds the files.
#include <atomic>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "slamot/eval/Metrics.h"
#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/LogSource.h"
#include "slamot/rawlog/Truth.h"
#include "slamot/run/Pipeline.h"
#include "slamot/run/RunConfig.h"

namespace slamot::run {

struct RunInput {
    LogSource* source = nullptr;
    std::string log_name;  ///< for messages and the summary
    /// Truth for the start pose and the metrics; null for none.
    const Truth* truth = nullptr;
    std::string truth_name;
    int threads = 1;
    /// Told the part done, 0 to 1, every few entries.
    std::function<void(double)> progress;
    /// Set by another hand to stop cleanly.
    const std::atomic<bool>* stop = nullptr;
    /// Beside those that make the result.
    std::vector<Sink*> sinks;
};

struct RunResult {
    RunStatus status = RunStatus::complete;
    std::string end_message;  ///< for truncated and corrupt logs and failed runs
    /// Sentences on what is legal but hardly meant: labels in the config that the log does not have.
    std::vector<std::string> warnings;
    std::string estimate_hash;
    bool started = false;
    eval::RunRecord record;
    std::optional<eval::Metrics> metrics;  ///< where there is truth
    nlohmann::json summary;                ///< as in summary.json
    /// The EstimatorError of a failed run; the rest of the result holds what came before.
    std::exception_ptr failure;
};

/// Runs all entries through `assembled`, which is used up. Throws LogError or ConfigError when nothing of the log
/// can be used.
RunResult runSource(const AssembledRun& assembled, const RunInput& input);

}  // namespace slamot::run
