#pragma once
// Tracks and true targets side by side, stamp by stamp: what every metric of tracking starts from.
#include <cstdint>
#include <vector>

#include "slamot/core/data/Pose2.h"
#include "slamot/eval/Measured.h"
#include "slamot/eval/Options.h"
#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/Truth.h"

namespace slamot::eval {

/// A target or a track at one stamp; `index` counts the targets or the tracks of the scene from 0.
struct SceneObject {
    int index = 0;
    Vector2 position = Vector2::Zero();
};

struct SceneFrame {
    Stamp stamp;
    std::vector<SceneObject> targets, tracks;
};

struct TrackingScene {
    /// Stamps of the trajectory at which truth knows every target it spans.
    std::vector<SceneFrame> frames;
    int targets = 0, tracks = 0;
    /// Stamps left out: a target's truth has a gap there, so the true set is unknown.
    std::int64_t stamps_in_gaps = 0;
    /// Tracks, by stamp, taken out since they follow a target that does not count there.
    std::int64_t set_aside = 0;
};

/// Every target counts wherever its truth spans the stamp, seen or not. Tracks of existence below
/// `min_existence` are not there.
Measured<TrackingScene> sceneOfAllTargets(const RunRecord& run, const Truth& truth,
                                          const EvaluationOptions& options);

/// A target counts from its first to its last detection, as truth's associations tell; one never detected
/// does not count. Outside that time it is neither missed nor may a track on it be called false: of the
/// one-to-one pairings of tracks and targets within `target_gate` with the most pairs, the one of least total
/// distance says which tracks are set aside.
Measured<TrackingScene> sceneOfSeenTargets(const RunRecord& run, const Truth& truth,
                                           const EvaluationOptions& options);

/// One-to-one pairs of a target and a track, by their place in the lists: the most pairs within `gate`, and
/// of those the least total distance.
struct ScenePair {
    std::size_t target, track;
    double distance;
};
std::vector<ScenePair> pairWithin(const std::vector<SceneObject>& targets,
                                  const std::vector<SceneObject>& tracks, double gate);

}  // namespace slamot::eval
