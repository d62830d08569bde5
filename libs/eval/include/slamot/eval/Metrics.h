#pragma once
// All that truth allows to say of one run.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "slamot/eval/Association.h"
#include "slamot/eval/Consistency.h"
#include "slamot/eval/Landmarks.h"
#include "slamot/eval/Nis.h"
#include "slamot/eval/Options.h"
#include "slamot/eval/SetDistance.h"
#include "slamot/eval/Tracking.h"
#include "slamot/eval/Tracks.h"
#include "slamot/eval/Trajectory.h"

namespace slamot::eval {

struct Metrics {
    EvaluationOptions options;
    MatchCounts matching;
    Measured<RobotErrors> robot;
    Measured<AbsoluteError> ate;
    Measured<RelativeError> rpe;
    Measured<NeesSummary> robot_nees;
    Measured<std::vector<NisGroup>> nis;
    Measured<LandmarkErrors> landmarks;
    Measured<SetDistance> landmark_set;
    Measured<TargetMetrics> targets;
    Measured<TrackSetDistance> track_set;
    Measured<AssociationMetrics> association;
    Measured<MapCardinality> map_cardinality;
    /// Against every target, and against targets while they are seen.
    Measured<TrackingMetrics> tracking, tracking_seen;
};

Metrics evaluate(const RunRecord& run, const Truth& truth, const EvaluationOptions& options);

/// NEES of the robot's pose, step by step: what consistencyOverRuns takes. Of the position alone where truth
/// has no heading.
NeesSeries robotNees(const std::vector<PosePair>& pairs);

/// For summary.json: metres, seconds, radians. Numbers that do not exist are null; metrics that do not are
/// listed under `absent` with the reason.
nlohmann::json toJson(const Metrics& metrics);

/// For the terminal: plain text of at most 80 columns, angles in degrees.
std::string summaryTable(const Metrics& metrics);

}  // namespace slamot::eval
