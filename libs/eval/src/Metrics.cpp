#include "slamot/eval/Metrics.h"

#include <cmath>

namespace slamot::eval {

NeesSeries robotNees(const std::vector<PosePair>& pairs) {
    NeesSeries series;
    series.reserve(pairs.size());
    for (const PosePair& pair : pairs) {
        const Pose2& m = pair.estimate.mean;
        const Vector2 position = m.position() - pair.truth.position();
        if (std::isnan(pair.truth.theta)) {
            series.push_back({pair.stamp, nees(position, pair.estimate.covariance.topLeftCorner<2, 2>())});
            continue;
        }
        const Vector3 error{position.x(), position.y(), angleDifference(m.theta, pair.truth.theta)};
        series.push_back({pair.stamp, nees(error, pair.estimate.covariance)});
    }
    return series;
}

Metrics evaluate(const RunRecord& run, const Truth& truth, const EvaluationOptions& options) {
    Metrics metrics;
    metrics.options = options;
    const PairedTrajectory paired = pairWithTruth(run.trajectory, truth);
    metrics.matching = paired.counts;
    if (const auto why = whyTooFew(paired, run.trajectory, truth, options.min_matched)) {
        metrics.robot = Measured<RobotErrors>::absent(*why);
        metrics.ate = Measured<AbsoluteError>::absent(*why);
        metrics.rpe = Measured<RelativeError>::absent(*why);
        metrics.robot_nees = Measured<NeesSummary>::absent(*why);
    } else {
        metrics.robot = robotErrors(paired.pairs);
        if (options.alignment == Alignment::first_pose && std::isnan(paired.pairs.front().truth.theta))
            metrics.ate =
                Measured<AbsoluteError>::absent("the first true pose has no heading to be aligned by");
        else
            metrics.ate = absoluteError(paired.pairs, options.alignment);
        metrics.rpe = relativeError(paired.pairs, options.rpe_delta, options.rpe_unit);
        metrics.robot_nees = summariseNees(robotNees(paired.pairs), options.probability);
    }
    metrics.nis = nisBySensor(run.innovations, options.probability);
    metrics.landmarks = landmarkErrors(run, truth, options);
    metrics.landmark_set = landmarkSetDistance(run, truth, options);
    metrics.targets = targetMetrics(run, truth, options);
    metrics.track_set = trackSetDistance(run, truth, options);
    metrics.association = associationMetrics(run, truth);
    metrics.map_cardinality = mapCardinality(run, truth);
    metrics.tracking = trackingMetrics(sceneOfAllTargets(run, truth, options), options);
    metrics.tracking_seen = trackingMetrics(sceneOfSeenTargets(run, truth, options), options);
    return metrics;
}

}  // namespace slamot::eval
