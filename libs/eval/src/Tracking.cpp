#include "slamot/eval/Tracking.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "slamot/core/association/Assignment.h"

namespace slamot::eval {
namespace {

double part(std::int64_t of, std::int64_t whole) {
    return whole == 0 ? std::numeric_limits<double>::quiet_NaN()
                      : static_cast<double>(of) / static_cast<double>(whole);
}

/// One target's way through the stamps at which it counts.
struct TargetHistory {
    std::int64_t stamps = 0, matched = 0;
    /// The last track it had, and the frame of that; -1 for none yet.
    int last_track = -1;
    std::int64_t last_frame = -1;
    /// Whether it had a track at its last stamp.
    bool on_track = false;
};

/// The correspondences of earlier stamps that still hold, the newest first where two want one track.
std::vector<ScenePair> heldPairs(const SceneFrame& frame, const std::vector<TargetHistory>& histories,
                                 double gate) {
    std::map<int, std::size_t> place_of_track;
    for (std::size_t j = 0; j < frame.tracks.size(); ++j) place_of_track[frame.tracks[j].index] = j;
    const auto history = [&](std::size_t i) -> const TargetHistory& {
        return histories[static_cast<std::size_t>(frame.targets[i].index)];
    };
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < frame.targets.size(); ++i)
        if (history(i).last_track >= 0) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return history(a).last_frame > history(b).last_frame;
    });
    std::vector<ScenePair> pairs;
    for (const std::size_t i : order) {
        const auto place = place_of_track.find(history(i).last_track);
        if (place == place_of_track.end()) continue;
        const double d = (frame.targets[i].position - frame.tracks[place->second].position).norm();
        if (d > gate) continue;
        pairs.push_back({i, place->second, d});
        place_of_track.erase(place);
    }
    return pairs;
}

/// Held pairs, then the best pairs of those that are left.
std::vector<ScenePair> correspondences(const SceneFrame& frame, const std::vector<TargetHistory>& histories,
                                       double gate) {
    std::vector<ScenePair> pairs = heldPairs(frame, histories, gate);
    std::vector<bool> target_taken(frame.targets.size(), false), track_taken(frame.tracks.size(), false);
    for (const ScenePair& pair : pairs) target_taken[pair.target] = track_taken[pair.track] = true;
    std::vector<SceneObject> targets, tracks;
    std::vector<std::size_t> target_places, track_places;
    for (std::size_t i = 0; i < frame.targets.size(); ++i)
        if (!target_taken[i]) targets.push_back(frame.targets[i]), target_places.push_back(i);
    for (std::size_t j = 0; j < frame.tracks.size(); ++j)
        if (!track_taken[j]) tracks.push_back(frame.tracks[j]), track_places.push_back(j);
    for (const ScenePair& pair : pairWithin(targets, tracks, gate))
        pairs.push_back({target_places[pair.target], track_places[pair.track], pair.distance});
    return pairs;
}

}  // namespace

ClearMot clearMot(const TrackingScene& scene, double gate) {
    ClearMot result;
    std::vector<TargetHistory> histories(static_cast<std::size_t>(scene.targets));
    double distances = 0;
    for (std::size_t k = 0; k < scene.frames.size(); ++k) {
        const SceneFrame& frame = scene.frames[k];
        const std::vector<ScenePair> pairs = correspondences(frame, histories, gate);
        std::vector<bool> has_track(frame.targets.size(), false);
        for (const ScenePair& pair : pairs) {
            TargetHistory& history = histories[static_cast<std::size_t>(frame.targets[pair.target].index)];
            const int track = frame.tracks[pair.track].index;
            result.switches += history.last_track >= 0 && history.last_track != track;
            result.fragmentations += history.last_track >= 0 && !history.on_track;
            history.last_track = track;
            history.last_frame = static_cast<std::int64_t>(k);
            ++history.matched;
            distances += pair.distance;
            has_track[pair.target] = true;
        }
        for (std::size_t i = 0; i < frame.targets.size(); ++i) {
            TargetHistory& history = histories[static_cast<std::size_t>(frame.targets[i].index)];
            ++history.stamps;
            history.on_track = has_track[i];
        }
        result.target_stamps += static_cast<std::int64_t>(frame.targets.size());
        result.matched += static_cast<std::int64_t>(pairs.size());
        result.false_positives += static_cast<std::int64_t>(frame.tracks.size() - pairs.size());
    }
    result.misses = result.target_stamps - result.matched;
    for (const TargetHistory& history : histories) {
        if (history.stamps == 0) continue;
        // In whole numbers, so that exactly 80 % is 80 %.
        const bool mostly_tracked = 5 * history.matched >= 4 * history.stamps;
        const bool mostly_lost = 5 * history.matched < history.stamps;
        ++(mostly_tracked ? result.mostly_tracked : mostly_lost ? result.mostly_lost : result.partly_tracked);
    }
    result.mota = 1 - part(result.misses + result.false_positives + result.switches, result.target_stamps);
    if (result.matched > 0) result.motp = distances / static_cast<double>(result.matched);
    return result;
}

IdentityScores identityScores(const TrackingScene& scene, double gate) {
    std::int64_t target_stamps = 0, track_stamps = 0;
    // By track and target, the stamps at which the two are within the gate.
    std::map<int, std::map<int, std::int64_t>> together;
    for (const SceneFrame& frame : scene.frames) {
        target_stamps += static_cast<std::int64_t>(frame.targets.size());
        track_stamps += static_cast<std::int64_t>(frame.tracks.size());
        for (const SceneObject& track : frame.tracks)
            for (const SceneObject& target : frame.targets)
                if ((track.position - target.position).norm() <= gate) ++together[track.index][target.index];
    }
    Eigen::MatrixXd cost = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(together.size()),
                                                 static_cast<Eigen::Index>(scene.targets));
    Eigen::Index row = 0;
    for (const auto& [track, targets] : together) {
        for (const auto& [target, stamps] : targets) cost(row, target) = -static_cast<double>(stamps);
        ++row;
    }
    IdentityScores scores;
    scores.true_positives = std::llround(-optimalAssignment(cost).cost);
    scores.false_negatives = target_stamps - scores.true_positives;
    scores.false_positives = track_stamps - scores.true_positives;
    scores.idf1 = part(2 * scores.true_positives, target_stamps + track_stamps);
    scores.precision = part(scores.true_positives, track_stamps);
    scores.recall = part(scores.true_positives, target_stamps);
    return scores;
}

CardinalityError cardinalityError(const TrackingScene& scene) {
    CardinalityError error;
    const auto frames = static_cast<double>(scene.frames.size());
    for (const SceneFrame& frame : scene.frames) {
        const auto targets = static_cast<double>(frame.targets.size());
        const auto tracks = static_cast<double>(frame.tracks.size());
        error.mean_targets += targets / frames;
        error.mean_tracks += tracks / frames;
        error.mean_absolute += std::abs(tracks - targets) / frames;
    }
    error.mean = error.mean_tracks - error.mean_targets;
    return error;
}

Measured<TrackingMetrics> trackingMetrics(const Measured<TrackingScene>& scene,
                                          const EvaluationOptions& options) {
    if (!scene) return Measured<TrackingMetrics>::absent(scene.whyAbsent());
    TrackingMetrics metrics;
    metrics.stamps = static_cast<std::int64_t>(scene->frames.size());
    metrics.stamps_in_gaps = scene->stamps_in_gaps;
    metrics.set_aside = scene->set_aside;
    metrics.clear = clearMot(*scene, options.target_gate);
    metrics.identity = identityScores(*scene, options.target_gate);
    metrics.cardinality = cardinalityError(*scene);
    metrics.trajectories =
        trajectoryDistance(*scene, options.set_order, options.set_cutoff, options.switch_penalty);
    return metrics;
}

}  // namespace slamot::eval
