#include "slamot/run/Summary.h"

#include <sys/resource.h>

#include <filesystem>

#include "slamot/core/Version.h"

namespace slamot::run {
namespace {

/// JSON has no infinity: a limit that is none is null.
nlohmann::json number(double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

double peakMemoryMegabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Where relative paths start.
std::string workingDirectory() {
    std::error_code gone;
    return std::filesystem::current_path(gone).string();
}

nlohmann::json countsJson(const PipelineCounts& counts, const Estimate& estimate) {
    const Health& health = estimate.health;
    return {{"odometry", counts.odometry},
            {"odometry_gaps", counts.odometry_gaps},
            {"scans", counts.scans},
            {"detection_sets", counts.detection_sets},
            {"detections", counts.detections},
            {"detection_sets_extrapolated", counts.extrapolated},
            {"clutter_added", counts.clutter.added},
            {"detections_withheld", counts.clutter.withheld},
            {"detections_used", health.detections_used},
            {"detections_inflated", health.detections_inflated},
            {"detections_rejected", health.detections_rejected},
            {"detections_tentative", health.detections_tentative},
            {"detections_ignored", health.detections_ignored},
            {"landmarks", estimate.landmark_count},
            {"tracks_at_end", estimate.tracks.size()}};
}

nlohmann::json sensorsJson(const std::map<std::string, RangeBearingSensor>& sensors) {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& [label, sensor] : sensors)
        list.push_back({{"label", label},
                        {"kind", toText(sensor.kind)},
                        {"x", number(sensor.pose.x)},
                        {"y", number(sensor.pose.y)},
                        {"theta", number(sensor.pose.theta)},
                        {"min_range", number(sensor.min_range)},
                        {"max_range", number(sensor.max_range)},
                        {"field_of_view", number(sensor.field_of_view)}});
    return list;
}

}  // namespace

std::vector<std::string> summaryCountNames() {
    std::vector<std::string> names;
    const nlohmann::json counts = countsJson({}, {});
    for (const auto& [name, count] : counts.items()) names.push_back(name);
    return names;
}

nlohmann::json makeSummary(const SummaryInput& in) {
    nlohmann::json drops = nlohmann::json::array();
    for (const auto& [key, count] : in.drops.rows())
        drops.push_back({{"sensor", key.first}, {"reason", key.second}, {"count", count}});

    const PipelineCounts& counts = *in.counts;
    nlohmann::json summary = {
        {"program", "slamot"},
        {"version", version},
        {"status", toText(in.status)},
        {"directory", workingDirectory()},
        {"log", in.log_file},
        {"truth", in.truth_folder.empty() ? nlohmann::json() : nlohmann::json(in.truth_folder)},
        {"estimator", in.estimator},
        {"detector", in.detector},
        {"seed", in.seed},
        {"threads", in.threads},
        {"config", in.canonical_config},
        {"estimate_sha256", in.estimate_hash},
        {"counts", countsJson(counts, in.end.estimate)},
        {"drops", drops},
        {"sensors", sensorsJson(in.sensors)},
        {"warnings", in.warnings},
        {"time",
         {{"wall_s", in.wall_seconds},
          {"cpu_s", in.cpu_seconds},
          {"predict_s", counts.times.predict},
          {"detect_s", counts.times.detect},
          {"update_s", counts.times.update},
          {"predict_cpu_s", counts.times.predict_cpu},
          {"detect_cpu_s", counts.times.detect_cpu},
          {"update_cpu_s", counts.times.update_cpu},
          {"steps", in.timer->count()},
          {"step_ms",
           {{"mean", number(1e3 * in.timer->mean())},
            {"p50", number(1e3 * in.timer->percentile(0.50))},
            {"p95", number(1e3 * in.timer->percentile(0.95))},
            {"p99", number(1e3 * in.timer->percentile(0.99))},
            {"max", number(1e3 * in.timer->percentile(1.0))}}}}},
        {"peak_memory_mb", peakMemoryMegabytes()},
        {"metrics", in.metrics},
    };
    if (!in.end_message.empty()) summary["end_message"] = in.end_message;
    return summary;
}

}  // namespace slamot::run
