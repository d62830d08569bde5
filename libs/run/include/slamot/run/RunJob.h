#pragma once
// The main job: a log through a pipeline into an output folder.
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "slamot/core/config/Config.h"
#include "slamot/core/plugin/PluginRegistry.h"
#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/Truth.h"
#include "slamot/run/Pipeline.h"

namespace slamot::run {

struct RunRequest {
    Config config;
    std::string log_file, out_folder;
    /// Truth for the start pose and the metrics; null for none.
    const Truth* truth = nullptr;
    std::string truth_folder;
    int threads = 1;
    /// Told the part done, 0 to 1, every few entries.
    std::function<void(double)> progress;
    /// Set by another hand to stop cleanly.
    const std::atomic<bool>* stop = nullptr;
};

struct RunResult {
    RunStatus status = RunStatus::complete;
    std::string end_message;  ///< for truncated and corrupt logs
    /// Sentences on what is legal but hardly meant: labels in the config that the log does not have.
    std::vector<std::string> warnings;
    std::string estimate_hash;
    std::string metrics_table;  ///< for the terminal; empty without truth
    bool writes_figure = false;  ///< [output] figure, if there is anything to draw; drawn by libs/report
    eval::RunRecord record;
    nlohmann::json summary;  ///< as in summary.json
};

/// Runs the log and writes all outputs. Throws ConfigError, PluginError, LogError or EstimatorError when there is
/// nothing to write or the run cannot go on; a truncated log is a result with its status. After an EstimatorError the
/// folder holds what came before, status failed.
RunResult runLog(const RunRequest& request, const PluginRegistry& registry);

}  // namespace slamot::run
