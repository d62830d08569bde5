#include "slamot/eval/Tracks.h"

#include <set>
#include <utility>

#include "slamot/eval/BestTrack.h"

namespace slamot::eval {
namespace {

/// One track at one stamp with its truth.
struct Sample {
    Stamp stamp;
    SourceId target;
    double position, velocity, relative_position, relative_velocity;
    SquaredError nees;
    bool seen;
};

using SeenSet = std::set<std::pair<Stamp, TrackId>>;

/// Whether the detection went into the track; one weighted down did.
bool isSight(Outcome outcome) {
    return outcome == Outcome::updated || outcome == Outcome::inflated || outcome == Outcome::initiated;
}

SeenSet seenTracks(const std::vector<InnovationRow>& innovations) {
    SeenSet seen;
    for (const InnovationRow& row : innovations)
        if (row.innovation.track.valid() && isSight(row.innovation.outcome))
            seen.emplace(row.stamp, row.innovation.track);
    return seen;
}

Sample sampleOf(const RobotRow& row, const TrackEstimate& track, const TrueTarget& target,
                const std::optional<Pose2>& true_robot, bool seen) {
    const Vector2 p = track.mean.head<2>(), v = track.mean.segment<2>(2);
    const Vector2 e = p - target.position;
    Sample sample{row.stamp,
                  track.source,
                  e.norm(),
                  (v - target.velocity).norm(),
                  ErrorSummary::none,
                  ErrorSummary::none,
                  nees(e, track.covariance.topLeftCorner<2, 2>()),
                  seen};
    if (true_robot) {
        // World velocities turned into the robot's axes: the robot's own motion is not taken off.
        const Pose2 &estimated_frame = row.robot.mean, &true_frame = *true_robot;
        sample.relative_position =
            (inverse(estimated_frame) * p - inverse(true_frame) * target.position).norm();
        sample.relative_velocity =
            (rotation(-estimated_frame.theta) * v - rotation(-true_frame.theta) * target.velocity).norm();
    }
    return sample;
}

/// The tracks of one stamp by target; of several with one source the one of highest existence, of equals the
/// one of lowest id.
std::map<SourceId, const TrackEstimate*> tracksByTarget(const std::vector<TrackEstimate>& tracks,
                                                        TargetMetrics& counts) {
    std::map<SourceId, const TrackEstimate*> by_target;
    for (const TrackEstimate& track : tracks) {
        if (!track.source.valid()) {
            ++counts.without_source;
            continue;
        }
        const auto [place, is_new] = by_target.try_emplace(track.source, &track);
        if (is_new) continue;
        ++counts.doubled;
        const TrackEstimate*& best = place->second;
        if (countsBefore(track, *best)) best = &track;
    }
    return by_target;
}

TargetErrors errorsOf(const std::vector<const Sample*>& samples, double probability) {
    std::vector<double> position, velocity, relative_position, relative_velocity;
    NeesSeries series;
    for (const Sample* s : samples) {
        position.push_back(s->position);
        velocity.push_back(s->velocity);
        relative_position.push_back(s->relative_position);
        relative_velocity.push_back(s->relative_velocity);
        series.push_back({s->stamp, s->nees});
    }
    return {summariseErrors(position), summariseErrors(velocity), summariseErrors(relative_position),
            summariseErrors(relative_velocity), summariseNees(series, probability)};
}

}  // namespace

Measured<TargetMetrics> targetMetrics(const RunRecord& run, const Truth& truth,
                                      const EvaluationOptions& options) {
    using Result = Measured<TargetMetrics>;
    if (run.tracks.empty()) return Result::absent("the run has no tracks");
    if (truth.targets.empty()) return Result::absent("truth has no targets");

    TargetMetrics result;
    const SeenSet seen = seenTracks(run.innovations);
    std::vector<Sample> samples;
    const std::vector<TrackEstimate> no_tracks;
    for (const RobotRow& row : run.trajectory) {
        const auto found = run.tracks.find(row.stamp);
        const auto by_target = tracksByTarget(found == run.tracks.end() ? no_tracks : found->second, result);
        const auto true_robot = truth.robotAt(row.stamp);
        for (const auto& [id, track] : by_target) {
            const auto target = truth.targetAt(id, row.stamp);
            if (!target) {
                ++result.without_truth;
                continue;
            }
            samples.push_back(
                sampleOf(row, *track, *target, true_robot, seen.count({row.stamp, track->id}) > 0));
        }
        for (const auto& [id, states] : truth.targets)
            result.missed += by_target.count(id) == 0 && truth.targetAt(id, row.stamp).has_value();
    }
    result.matched = static_cast<std::int64_t>(samples.size());
    if (samples.empty())
        return Result::absent(result.without_truth == 0
                                  ? "no track carries a source id; OSPA and GOSPA need none"
                                  : "no track's source id has a true target at the same stamp");

    std::vector<const Sample*> all, while_seen;
    std::map<SourceId, std::vector<const Sample*>> by_target;
    for (const Sample& sample : samples) {
        all.push_back(&sample);
        if (sample.seen) while_seen.push_back(&sample);
        by_target[sample.target].push_back(&sample);
    }
    result.all = errorsOf(all, options.probability);
    result.seen = while_seen.empty()
                      ? Measured<TargetErrors>::absent(
                            "no innovation says that a detection updated or initiated a track with a truth")
                      : Measured<TargetErrors>(errorsOf(while_seen, options.probability));
    for (const auto& [id, of_target] : by_target)
        result.by_target[id] = errorsOf(of_target, options.probability);
    return result;
}

}  // namespace slamot::eval
