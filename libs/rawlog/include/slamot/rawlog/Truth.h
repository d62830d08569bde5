#pragma once
// Ground truth beside a log: the folder LOG.truth/, never inside the log.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slamot/core/data/Identities.h"
#include "slamot/core/data/Pose2.h"
#include "slamot/core/data/Stamp.h"

namespace slamot {

struct TruePose {
    Stamp stamp;
    /// The heading is NaN where it is not known, as with GPS.
    Pose2 pose;
};

/// Unknown numbers are NaN, an unknown mode is empty.
struct TrueTarget {
    Stamp stamp;
    Vector2 position, velocity, acceleration;
    std::string mode;
};

/// Which object a detection really came from; id -1 is clutter. `index` counts the detections of that stamp
/// in the order of the log. `kind` is 'landmark', 'mover' or 'clutter'.
struct TrueAssociation {
    Stamp stamp;
    int index = 0;
    std::string kind;
    SourceId id;
};

struct Truth {
    std::vector<TruePose> robot;                          ///< rising stamps
    std::map<SourceId, std::vector<TrueTarget>> targets;  ///< rising stamps each
    std::map<SourceId, Vector2> landmarks;
    std::vector<TrueAssociation> associations;
    /// truth.json: where it comes from and how good it is.
    std::string frame = "world", source;
    double position_std = 0;
    /// The point of the robot that `robot` is measured at, in the robot's frame [m]: a GPS antenna's place.
    Vector2 point = Vector2::Zero();

    /// Neighbours further apart than this are a gap: nothing is interpolated across it. A single sample
    /// answers for its own stamp always.
    double max_interpolation_gap = 0.1;  ///< [s], of truth.json
    /// Position of `point` and the robot's heading.
    std::optional<Pose2> pointAt(Stamp stamp) const;
    /// Of the robot's frame. Where the heading is not known, NaN unless the point is the frame's origin.
    std::optional<Pose2> robotAt(Stamp stamp) const;
    std::optional<TrueTarget> targetAt(SourceId id, Stamp stamp) const;
};

/// Throws LogError (slamot/rawlog/LogError.h) naming file and line.
Truth readTruth(const std::string& folder);
void writeTruth(const Truth& truth, const std::string& folder);

/// LOG's stem + ".truth".
std::string truthFolderOf(const std::string& log_file);

}  // namespace slamot
