#pragma once
// The main job: a log file through a pipeline into an output folder.
#include <string>

#include "slamot/core/config/Config.h"
#include "slamot/core/plugin/PluginRegistry.h"
#include "slamot/run/Run.h"

namespace slamot::run {

struct RunRequest {
    Config config;
    std::string log_file, out_folder;
    /// Truth for the start pose and the metrics; null for none.
    const Truth* truth = nullptr;
    std::string truth_folder;
    int threads = 1;
    std::function<void(double)> progress;       ///< as RunInput's
    const std::atomic<bool>* stop = nullptr;  ///< as RunInput's
    std::vector<Sink*> sinks;                 ///< beside those of the folder
};

struct JobResult : RunResult {
    std::string metrics_table;   ///< for the terminal; empty without truth
    /// [output] figure and report, if there is anything to show; made by libs/report
    bool writes_figure = false, writes_report = false;
};

/// Runs the log and writes all outputs. Throws ConfigError, PluginError or LogError when there is nothing to write; a
/// truncated log is a result with its status. So is an EstimatorError in the run, as `failure`: the folder holds what
/// came before.
JobResult runLog(const RunRequest& request, const PluginRegistry& registry);

}  // namespace slamot::run
