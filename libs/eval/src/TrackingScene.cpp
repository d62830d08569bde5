#include "slamot/eval/TrackingScene.h"

#include <algorithm>
#include <map>
#include <optional>

#include "slamot/core/association/Assignment.h"

namespace slamot::eval {
namespace {

/// The targets that truth spans at `stamp`, in the order of their ids; nothing if one of them has a gap
/// there.
std::optional<std::vector<SceneObject>> targetsAt(const Truth& truth, Stamp stamp) {
    std::vector<SceneObject> targets;
    int index = -1;
    for (const auto& [id, samples] : truth.targets) {
        ++index;
        if (samples.empty() || stamp < samples.front().stamp || stamp > samples.back().stamp) continue;
        const auto target = truth.targetAt(id, stamp);
        if (!target) return std::nullopt;
        targets.push_back({index, target->position});
    }
    return targets;
}

/// Tracks get their index in the order they turn up.
class TrackIndices {
  public:
    int of(TrackId id) { return indices_.try_emplace(id, count()).first->second; }
    int count() const { return static_cast<int>(indices_.size()); }

  private:
    std::map<TrackId, int> indices_;
};

/// From the first to the last detection of one target.
struct SeenTime {
    Stamp first, last;
    bool contains(Stamp stamp) const { return first <= stamp && stamp <= last; }
};

/// By index of the target; nothing for one never detected while the run lasted.
std::vector<std::optional<SeenTime>> seenTimes(const RunRecord& run, const Truth& truth) {
    std::map<SourceId, std::size_t> index_of;
    for (const auto& [id, samples] : truth.targets) index_of.emplace(id, index_of.size());
    std::vector<std::optional<SeenTime>> times(index_of.size());
    const Stamp begin = run.trajectory.front().stamp, end = run.trajectory.back().stamp;
    for (const TrueAssociation& detection : truth.associations) {
        const auto target = index_of.find(detection.id);
        if (detection.kind != "mover" || target == index_of.end() || detection.stamp < begin ||
            detection.stamp > end)
            continue;
        auto& time = times[target->second];
        if (!time) time = SeenTime{detection.stamp, detection.stamp};
        time->first = std::min(time->first, detection.stamp);
        time->last = std::max(time->last, detection.stamp);
    }
    return times;
}

/// Takes out the targets that do not count at the frame's stamp, and the tracks that follow them.
std::int64_t setAside(SceneFrame& frame, const std::vector<std::optional<SeenTime>>& seen, double gate) {
    const auto counts = [&](const SceneObject& target) {
        const auto& time = seen[static_cast<std::size_t>(target.index)];
        return time && time->contains(frame.stamp);
    };
    if (std::all_of(frame.targets.begin(), frame.targets.end(), counts)) return 0;
    std::vector<bool> aside(frame.tracks.size(), false);
    for (const ScenePair& pair : pairWithin(frame.targets, frame.tracks, gate))
        aside[pair.track] = !counts(frame.targets[pair.target]);
    SceneFrame kept{frame.stamp, {}, {}};
    std::copy_if(frame.targets.begin(), frame.targets.end(), std::back_inserter(kept.targets), counts);
    for (std::size_t i = 0; i < frame.tracks.size(); ++i)
        if (!aside[i]) kept.tracks.push_back(frame.tracks[i]);
    const auto taken = static_cast<std::int64_t>(frame.tracks.size() - kept.tracks.size());
    frame = std::move(kept);
    return taken;
}

}  // namespace

std::vector<ScenePair> pairWithin(const std::vector<SceneObject>& targets,
                                  const std::vector<SceneObject>& tracks, double gate) {
    Eigen::MatrixXd cost(static_cast<Eigen::Index>(targets.size()), static_cast<Eigen::Index>(tracks.size()));
    bool any = false;
    for (Eigen::Index i = 0; i < cost.rows(); ++i)
        for (Eigen::Index j = 0; j < cost.cols(); ++j) {
            const double d =
                (targets[static_cast<std::size_t>(i)].position - tracks[static_cast<std::size_t>(j)].position)
                    .norm();
            cost(i, j) = d <= gate ? d : forbidden_pair;
            any |= d <= gate;
        }
    std::vector<ScenePair> pairs;
    if (!any) return pairs;
    const Assignment assignment = optimalAssignment(cost);
    for (std::size_t i = 0; i < targets.size(); ++i)
        if (const int j = assignment.column_of_row[i]; j >= 0)
            pairs.push_back({i, static_cast<std::size_t>(j), cost(static_cast<Eigen::Index>(i), j)});
    return pairs;
}

Measured<TrackingScene> sceneOfAllTargets(const RunRecord& run, const Truth& truth,
                                          const EvaluationOptions& options) {
    using Result = Measured<TrackingScene>;
    // A run without a track has missed every target, which is what the metrics are to tell.
    if (truth.targets.empty()) return Result::absent("truth has no targets");
    if (run.trajectory.empty()) return Result::absent("the run has no trajectory");

    TrackingScene scene;
    scene.targets = static_cast<int>(truth.targets.size());
    TrackIndices indices;
    for (const RobotRow& row : run.trajectory) {
        auto targets = targetsAt(truth, row.stamp);
        if (!targets) {
            ++scene.stamps_in_gaps;
            continue;
        }
        SceneFrame frame{row.stamp, std::move(*targets), {}};
        if (const auto found = run.tracks.find(row.stamp); found != run.tracks.end())
            for (const TrackEstimate& track : found->second)
                if (track.existence >= options.min_existence)
                    frame.tracks.push_back({indices.of(track.id), track.mean.head<2>()});
        scene.frames.push_back(std::move(frame));
    }
    scene.tracks = indices.count();
    if (scene.frames.empty())
        return Result::absent("truth of the targets has a gap at every stamp of the run");
    return scene;
}

Measured<TrackingScene> sceneOfSeenTargets(const RunRecord& run, const Truth& truth,
                                           const EvaluationOptions& options) {
    using Result = Measured<TrackingScene>;
    Result all = sceneOfAllTargets(run, truth, options);
    if (!all) return all;
    if (truth.associations.empty())
        return Result::absent("truth has no associations, which would tell when a target was seen");
    TrackingScene scene = *all;
    const auto seen = seenTimes(run, truth);
    if (std::none_of(seen.begin(), seen.end(), [](const auto& time) { return time.has_value(); }))
        return Result::absent("no target was seen, say truth's associations");
    for (SceneFrame& frame : scene.frames) scene.set_aside += setAside(frame, seen, options.target_gate);
    return scene;
}

}  // namespace slamot::eval
