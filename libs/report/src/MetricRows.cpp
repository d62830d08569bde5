#include "MetricRows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "slamot/core/data/Angle.h"

namespace slamot::report {
namespace {

constexpr double degrees = 180 / pi, percent = 100;

}  // namespace

const std::vector<MetricRow>& metricRows() {
    using B = Better;
    static const std::vector<MetricRow> rows = {
        {"Robot", "position RMSE", "m", B::smaller, "metrics/robot/position/rmse"},
        {"Robot", "position error, largest", "m", B::smaller, "metrics/robot/position/maximum"},
        {"Robot", "position error at the end", "m", B::smaller, "metrics/robot/position/final"},
        {"Robot", "heading RMSE", "°", B::smaller, "metrics/robot/heading/rmse", degrees},
        {"Robot", "ATE, position RMSE", "m", B::smaller, "metrics/ate/position/rmse"},
        {"Robot", "RPE, position RMSE", "m", B::smaller, "metrics/rpe/position/rmse"},
        {"Robot", "NEES per degree of freedom", "", B::near_one, "metrics/robot_nees/average", 1,
         "metrics/robot_nees/mean_dimension"},
        {"Robot", "NEES within its band", "%", B::none, "metrics/robot_nees/inside", percent},
        {"Landmarks", "position RMSE", "m", B::smaller, "metrics/landmarks/position/rmse"},
        {"Landmarks", "NEES per degree of freedom", "", B::near_one, "metrics/landmarks/nees/average", 1,
         "metrics/landmarks/nees/mean_dimension"},
        {"Landmarks", "matched with truth", "", B::none, "metrics/landmarks/matched"},
        {"Landmarks", "true ones missing", "", B::smaller, "metrics/landmarks/missing"},
        {"Landmarks", "extra", "", B::none, "metrics/landmarks/extra"},
        {"Landmarks", "GOSPA", "m", B::smaller, "metrics/landmark_set/gospa/total"},
        {"Tracks", "position RMSE", "m", B::smaller, "metrics/targets/all/position/rmse"},
        {"Tracks", "velocity RMSE", "m/s", B::smaller, "metrics/targets/all/velocity/rmse"},
        {"Tracks", "relative position RMSE", "m", B::smaller, "metrics/targets/all/relative_position/rmse"},
        {"Tracks", "NEES per degree of freedom", "", B::near_one, "metrics/targets/all/nees/average", 1,
         "metrics/targets/all/nees/mean_dimension"},
        {"Tracks", "GOSPA, mean over stamps", "m", B::smaller, "metrics/track_set/gospa/total"},
        {"Tracks", "T-GOSPA a stamp", "m", B::smaller, "metrics/tracking/all/tgospa/per_stamp"},
        {"Tracks", "MOTA", "%", B::larger, "metrics/tracking/all/mota", percent},
        {"Tracks", "IDF1", "%", B::larger, "metrics/tracking/all/idf1", percent},
        {"Tracks", "identity switches", "", B::none, "metrics/tracking/all/switches"},
        {"Association", "recall", "%", B::larger, "metrics/association/all/recall", percent},
        {"Association", "precision", "%", B::larger, "metrics/association/all/precision", percent},
        {"Cost", "step time, mean", "ms", B::smaller, "time/step_ms/mean", 1, {}, 2},
        {"Cost", "step time, 99 %", "ms", B::smaller, "time/step_ms/p99", 1, {}, 2},
        {"Cost", "whole run", "s", B::smaller, "time/wall_s", 1, {}, 2},
        {"Cost", "peak memory", "MB", B::smaller, "peak_memory_mb", 1, {}, 2}};
    return rows;
}

std::optional<double> valueOf(const MetricRow& row, const RunFolder& run) {
    const std::optional<double> value = run.number(row.path);
    if (!value || row.divisor_path.empty()) {
        return value ? std::optional<double>(*value * row.factor) : std::nullopt;
    }
    const std::optional<double> divisor = run.number(row.divisor_path);
    return divisor && *divisor > 0 ? std::optional<double>(*value * row.factor / *divisor) : std::nullopt;
}

std::string headingOf(const MetricRow& row) {
    return row.unit.empty() ? row.name : fmt::format("{} [{}]", row.name, row.unit);
}

std::string shortNumber(double value) {
    if (value == 0) {
        return "0";
    }
    if (!std::isfinite(value)) {
        return fmt::format("{}", value);
    }
    const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value))));
    if (exponent < -4 || exponent > 6) {
        return fmt::format("{:.3g}", value);
    }
    constexpr int significant = 4;
    std::string text = fmt::format("{:.{}f}", value, std::max(0, significant - 1 - exponent));
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        text.erase(text.back() == '.' ? text.size() - 1 : text.size());
    }
    return text;
}

bool isBetter(const MetricRow& row, double a, double b) {
    switch (row.better) {
        case Better::smaller:
            return a < b;
        case Better::larger:
            return a > b;
        case Better::near_one:
            return std::abs(std::log(a)) < std::abs(std::log(b));
        case Better::none:
            break;
    }
    return false;
}

}  // namespace slamot::report
