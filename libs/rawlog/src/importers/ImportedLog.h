#pragma once
// What all importers share: odometry and detections in the log's conventions, written in order of time, with
// the association of every detection that has one.
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "slamot/rawlog/Conventions.h"
#include "slamot/rawlog/RawlogWriter.h"
#include "slamot/rawlog/Truth.h"

namespace slamot {

/// `pose` after `seconds` at a constant velocity of the body: exact for an arc.
Pose2 moved(const Pose2& pose, const BodyVelocity& velocity, double seconds);

/// Identifies a robot among the movers of a team's logs.
inline constexpr std::int64_t robot_id_base = 1'000'000;

class ImportedLog {
  public:
    /// A detection and what it really came from.
    struct Detection {
        Stamp stamp;
        std::string label;
        double range = 0, bearing = 0;
        SourceId id;
    };

    std::vector<OdometryReading> odometry;  ///< rising stamps
    std::vector<Detection> detections;      ///< of one stamp in any order; stamps need not rise
    /// The sensor looked at these stamps under `empty_label` and saw nothing.
    std::vector<Stamp> empty_scans;
    std::string empty_label;
    /// All detections are one sensor's, whatever label they get.
    RangeBearingSensor sensor;
    double std_range = 0, std_bearing = 0;

    /// One observation per stamp and label. Returns for every detection its index among those of its stamp,
    /// in the order of the log. `progress` as in Importer.h, from `begin` to `end`; LogError when it says
    /// stop.
    std::vector<int> write(const std::string& file, const std::function<bool(double)>& progress, double begin,
                           double end) const;
};

}  // namespace slamot
