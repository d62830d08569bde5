#pragma once
// Errors of the robot's trajectory against truth.
#include <optional>
#include <string>
#include <vector>

#include "slamot/eval/ErrorSummary.h"
#include "slamot/eval/Measured.h"
#include "slamot/eval/Options.h"
#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/Truth.h"

namespace slamot::eval {

/// Both of the point that truth is measured at.
struct PosePair {
    Stamp stamp;
    PoseGaussian estimate;
    Pose2 truth;
};

/// How many estimates there are, how many lie within the span of truth's stamps, and how many have a truth.
struct MatchCounts {
    std::int64_t total = 0, covered = 0, matched = 0;
};

struct PairedTrajectory {
    std::vector<PosePair> pairs;
    MatchCounts counts;
};

PairedTrajectory pairWithTruth(const std::vector<RobotRow>& trajectory, const Truth& truth);

/// Why the pairs are too few to speak for the run, or nothing. Stamps in another unit than seconds are named.
std::optional<std::string> whyTooFew(const PairedTrajectory& paired, const std::vector<RobotRow>& trajectory,
                                     const Truth& truth, double min_matched);

/// Unaligned errors: estimate minus truth in the world's axes [m], heading wrapped [rad].
struct RobotErrors {
    ErrorSummary position, x, y, heading;
};
RobotErrors robotErrors(const std::vector<PosePair>& pairs);

/// T_truth_estimate: what maps estimated positions to the truth's frame.
Pose2 alignmentOf(const std::vector<PosePair>& pairs, Alignment alignment);

/// Absolute trajectory error (ATE), after alignment.
struct AbsoluteError {
    Alignment alignment = Alignment::none;
    Pose2 T_truth_estimate;
    ErrorSummary position, heading;
};
AbsoluteError absoluteError(const std::vector<PosePair>& pairs, Alignment alignment);

/// Relative pose error (RPE) over a fixed time or path length.
struct RelativeError {
    double delta = 0;
    RelativeUnit unit = RelativeUnit::seconds;
    /// Of the distances really compared: up to a tenth more than `delta`.
    double mean_delta = 0;
    ErrorSummary position, heading;
};
Measured<RelativeError> relativeError(const std::vector<PosePair>& pairs, double delta, RelativeUnit unit);

}  // namespace slamot::eval
