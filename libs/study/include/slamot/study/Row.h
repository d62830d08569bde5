#pragma once
// One finished run as a study keeps it.
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "slamot/study/Plan.h"

namespace slamot::study {

/// A figure of a run, step by step; seconds since the run's start. `dimension` is empty but for NEES.
struct Series {
    std::vector<double> seconds, value, dimension;
};

/// What depends on machine and moment, and so is no part of a row's identity.
struct Cost {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    /// Of running and evaluating; of making the world (simulating it, or reading its truth), its part of what
    /// the runs made from it share.
    double wall_s = none, simulate_s = none;
    double cpu_s = none;  ///< of the thread that ran it
    /// The estimator's work for a step with detections, by the clock on the wall.
    double step_ms_mean = none, step_ms_p50 = none, step_ms_p99 = none, step_ms_max = none;
    /// The same in processor time: what other programs on the machine do hardly counts.
    double step_cpu_ms_mean = none;
    /// Most memory the run took beyond what was there before it; NaN where runs share the process in
    /// parallel.
    double memory_mb = none;
    std::string host;
};

struct Row {
    std::string key, source, variant;
    GridPoint scenario_point, config_point;
    int replicate = 1;
    std::uint64_t world_seed = 0, estimator_seed = 0;
    std::string status, reason;  ///< RunStatus in words, `failed` with its sentence
    std::string estimate_hash;
    /// summary.json's metrics and counts, nested names joined by dots: robot.position.rmse,
    /// nis.<sensor>.<kind>.inside, counts.landmarks. Numbers that exist only.
    std::map<std::string, double> metrics;
    std::map<std::string, Series> series;
    Cost cost;
    std::string build;  ///< RunPlan's: what computed it; no part of its identity either
};

/// A figure of a row: a metric's name, or `cost.<field>`. NaN where the row has none.
double figureOf(const Row& row, const std::string& name);

/// Names, points and replicate as the plan has them: a key outlives a grid that is put around it.
void setLabels(Row& row, const Plan& plan, const WorldPlan& world, const RunPlan& run);

/// All but cost and build: what must agree whatever the row was computed by, with every bit of its numbers.
std::string identity(const Row& row);

nlohmann::json toJson(const Row& row);
Row rowFromJson(const nlohmann::json& json);

}  // namespace slamot::study
