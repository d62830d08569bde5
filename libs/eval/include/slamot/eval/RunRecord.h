#pragma once
// A finished run as the metrics see it: filled in memory by the pipeline's recorder or read from an output
// folder; both give the same numbers.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slamot/core/data/Estimate.h"

namespace slamot::eval {

struct RobotRow {
    Stamp stamp;
    PoseGaussian robot;
};

/// Where a detection stands among those that the log has at its stamp, used or not: as truth's associations
/// count.
struct LogNumber {
    /// From 0; -1 for a false detection that the run itself added, `count` and more for what a detector
    /// found.
    int number = -1;
    int count = 0;  ///< detections that the log has at the stamp
};

/// One innovation with the stamp and sensor it came from.
struct InnovationRow {
    Stamp stamp;
    std::string sensor;
    Innovation innovation;
    std::optional<LogNumber> log;  ///< nothing in files of programs that do not tell
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
