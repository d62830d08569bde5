#pragma once
// Errors of tracks whose target is known by its source id.
#include <map>

#include "slamot/eval/Consistency.h"
#include "slamot/eval/ErrorSummary.h"
#include "slamot/eval/Measured.h"
#include "slamot/eval/Options.h"
#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/Truth.h"

namespace slamot::eval {

/// Of one target, or of all together. Velocity is left out where truth does not know it.
struct TargetErrors {
    /// In the world frame [m, m/s].
    ErrorSummary position, velocity;
    /// As the robot sees it: the target in the estimated robot's frame against the true target in the true
    /// robot's frame. Empty where the robot has no truth.
    ErrorSummary relative_position, relative_velocity;
    /// Of the position in the world, 2 dimensions.
    Measured<NeesSummary> nees;
};

struct TargetMetrics {
    /// Pairs of a track and a truth over all stamps.
    std::int64_t matched = 0;
    /// Tracks by stamp that have no source id; whose target has no truth at that stamp; that are a second
    /// track of the same target (of several the one of highest existence counts).
    std::int64_t without_source = 0, without_truth = 0, doubled = 0;
    /// True targets by stamp that no track claims.
    std::int64_t missed = 0;
    TargetErrors all;
    /// Only stamps at which a detection updated or initiated the track.
    Measured<TargetErrors> seen;
    std::map<SourceId, TargetErrors> by_target;
};

Measured<TargetMetrics> targetMetrics(const RunRecord& run, const Truth& truth,
                                      const EvaluationOptions& options);

}  // namespace slamot::eval
