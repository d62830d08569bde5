#include "FigureNames.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "CostFields.h"
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

}  // namespace

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
