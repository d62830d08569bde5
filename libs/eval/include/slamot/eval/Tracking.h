#pragma once
// How well tracks follow targets as identities, not only as points: CLEAR MOT, identity scores, cardinality.
// Tracks and targets meet by position alone, so that tracks need no source id.
#include <cstdint>
#include <limits>

#include "slamot/eval/TrackingScene.h"
#include "slamot/eval/TrajectoryDistance.h"

namespace slamot::eval {

/// Bernardin and Stiefelhagen 2008; fragmentations and mostly tracked or lost by Li, Huang and Nevatia 2009.
struct ClearMot {
    /// Targets by stamp; those with a track; those without; tracks by stamp without a target.
    std::int64_t target_stamps = 0, matched = 0, misses = 0, false_positives = 0;
    /// A target goes on with another track than its last one; a target gets a track again after it had none.
    std::int64_t switches = 0, fragmentations = 0;
    /// Targets with a track at 80 % of their stamps or more, at less than 20 %, and the others. A target that
    /// counts at no stamp is none of these.
    std::int64_t mostly_tracked = 0, partly_tracked = 0, mostly_lost = 0;
    /// 1 - (misses + false positives + switches) / target stamps; mean distance of the matched [m]. NaN where
    /// there is nothing to divide by.
    double mota = std::numeric_limits<double>::quiet_NaN(), motp = mota;
};
/// Correspondences within `gate` [m] are kept from stamp to stamp as long as they hold.
ClearMot clearMot(const TrackingScene& scene, double gate);

/// Ristani et al. 2016: whole tracks against whole targets.
struct IdentityScores {
    std::int64_t true_positives = 0, false_positives = 0, false_negatives = 0;
    /// NaN where there is nothing to divide by.
    double idf1 = std::numeric_limits<double>::quiet_NaN(), precision = idf1, recall = idf1;
};
IdentityScores identityScores(const TrackingScene& scene, double gate);

/// Number of tracks minus number of targets, over the stamps.
struct CardinalityError {
    double mean = 0, mean_absolute = 0, mean_targets = 0, mean_tracks = 0;
};
CardinalityError cardinalityError(const TrackingScene& scene);

struct TrackingMetrics {
    std::int64_t stamps = 0, stamps_in_gaps = 0, set_aside = 0;
    ClearMot clear;
    IdentityScores identity;
    CardinalityError cardinality;
    TrajectoryDistance trajectories;
};
Measured<TrackingMetrics> trackingMetrics(const Measured<TrackingScene>& scene,
                                          const EvaluationOptions& options);

}  // namespace slamot::eval
