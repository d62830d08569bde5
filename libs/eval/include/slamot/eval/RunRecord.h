#pragma once
// A finished run as the metrics see it: filled in memory by the pipeline's recorder or read from an output
// folder; both give the same numbers.
#include <map>
#include <string>
#include <vector>

#include "slamot/core/data/Estimate.h"

namespace slamot::eval {

struct RobotRow {
    Stamp stamp;
    PoseGaussian robot;
};

/// One innovation with the stamp and sensor it came from.
struct InnovationRow {
    Stamp stamp;
    std::string sensor;
    Innovation innovation;
};

struct RunRecord {
    std::vector<RobotRow> trajectory;                            ///< one row per stamp, rising
    std::map<Stamp, std::vector<TrackEstimate>> tracks;          ///< tracks present at each stamp of the trajectory
    std::vector<LandmarkEstimate> landmarks;                     ///< at the end of the run
    std::vector<InnovationRow> innovations;
    std::vector<std::string> mode_names;
};

/// Reads trajectory.csv, tracks.csv, landmarks.csv and innovations.csv of an output folder; the last three may be
/// absent. Columns are found by name. Throws LogError naming file, line and column.
RunRecord readRun(const std::string& folder);

/// A TUM trajectory (`t x y z qx qy qz qw`) of any program; covariances are zero, which means unknown.
RunRecord readTum(const std::string& file);

}  // namespace slamot::eval
