#include "FigureNames.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "CostFields.h"
#include "Words.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/eval/Metrics.h"
#include "slamot/run/Summary.h"

namespace slamot::study {
namespace {

/// Every number in the metrics of a run that lacks nothing, as eval itself writes them.
std::vector<std::string> namesOfMetrics() {
    eval::Metrics whole;
    whole.robot = eval::RobotErrors{};
    whole.ate = eval::AbsoluteError{};
    whole.rpe = eval::RelativeError{};
    whole.robot_nees = eval::NeesSummary{};
    whole.landmarks = [] {
        eval::LandmarkErrors landmarks;
        landmarks.nees = eval::NeesSummary{};
        return landmarks;
    }();
    whole.landmark_set = eval::SetDistance{};
    whole.track_set = eval::TrackSetDistance{};
    whole.association = eval::AssociationMetrics{};
    whole.map_cardinality = [] {
        eval::MapCardinality cardinality;
        cardinality.seen = eval::MapCardinality::Seen{};
        return cardinality;
    }();
    whole.tracking = whole.tracking_seen = eval::TrackingMetrics{};
    whole.targets = [] {
        eval::TargetErrors errors;
        errors.nees = eval::NeesSummary{};
        eval::TargetMetrics targets;
        targets.all = errors;
        targets.seen = errors;
        return targets;
    }();

    std::vector<std::string> names;
    const nlohmann::json flat = eval::toJson(whole).flatten();
    for (const auto& [pointer, value] : flat.items()) {
        if (!value.is_number() && !value.is_null()) continue;
        std::string name = pointer.substr(1);
        std::replace(name.begin(), name.end(), '/', '.');
        names.push_back(name);
    }
    return names;
}

const std::vector<std::string>& names() {
    static const std::vector<std::string> all = [] {
        std::vector<std::string> list = namesOfMetrics();
        for (const std::string& count : run::summaryCountNames()) list.push_back("counts." + count);
        for (const auto& [cost, field] : cost_fields) list.push_back(std::string("cost.") + cost);
        return list;
    }();
    return all;
}

/// Costs end in their unit or have it before the statistic: cost.wall_s, cost.step_ms_p99.
FigureUnit unitOfCost(const std::string& cost) {
    const std::vector<std::string> words = split(cost, '_');
    if (contains(words, "ms")) return {Dimension::time, 1e-3};
    if (contains(words, "s")) return {Dimension::time, 1};
    return {};
}

FigureUnit unitOfSeries(const std::string& series) {
    if (series == "robot_error" || series == "target_error") return {Dimension::length, 1};
    if (series == "heading_error") return {Dimension::angle, 1};
    if (series.rfind("p_", 0) == 0) return {Dimension::part, 1};
    return {};
}

}  // namespace

FigureUnit unitOf(const std::string& figure) {
    const std::vector<std::string> words = split(figure, '.');
    if (words.size() == 1) return unitOfSeries(figure);
    if (words[0] == "cost") return unitOfCost(words[1]);
    const std::string last = words.back(), of = words[words.size() - 2];
    if (contains({"inside", "coverage", "recall", "precision", "mota", "idf1", "idp", "idr"}, last))
        return {Dimension::part, 1};
    if (last == "motp") return {Dimension::length, 1};
    if (of == "tgospa" && contains({"total", "lower_bound", "per_stamp"}, last))
        return {Dimension::length, 1};
    if (contains({"rmse", "mean", "median", "maximum", "final"}, last)) {
        if (contains({"position", "relative_position", "x", "y"}, of)) return {Dimension::length, 1};
        if (of == "heading") return {Dimension::angle, 1};
    }
    if (of == "T_truth_estimate") return {last == "2" ? Dimension::angle : Dimension::length, 1};
    if (of == "ospa" || (of == "gospa" && last == "total")) return {Dimension::length, 1};
    return {};
}

bool isFigure(const std::string& name) {
    // Targets and sensors have the names the log gives them.
    for (const std::string open : {"targets.by_target.", "nis."})
        if (name.rfind(open, 0) == 0) return true;
    return std::find(names().begin(), names().end(), name) != names().end();
}

std::optional<std::string> nearestFigure(const std::string& name) {
    return nearestWord(name, names());
}

}  // namespace slamot::study
