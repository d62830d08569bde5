#include "slamot/eval/SetDistance.h"

#include <algorithm>
#include <cmath>

#include "slamot/core/association/Assignment.h"
#include "slamot/eval/TrackingScene.h"

namespace slamot::eval {
namespace {

double root(double power, double p) {
    return std::pow(power, 1 / p);
}

/// Distances of the pairs of the assignment that is best for the distance cut off at c, to the power p.
std::vector<double> assignedPowers(const Points& estimates, const Points& truths, double p, double c) {
    Eigen::MatrixXd cost(static_cast<Eigen::Index>(estimates.size()),
                         static_cast<Eigen::Index>(truths.size()));
    for (Eigen::Index i = 0; i < cost.rows(); ++i)
        for (Eigen::Index j = 0; j < cost.cols(); ++j) {
            const double d =
                (estimates[static_cast<std::size_t>(i)] - truths[static_cast<std::size_t>(j)]).norm();
            cost(i, j) = std::pow(std::min(d, c), p);
        }
    const Assignment assignment = optimalAssignment(cost);
    std::vector<double> powers;
    for (std::size_t i = 0; i < estimates.size(); ++i)
        if (const int j = assignment.column_of_row[i]; j >= 0)
            powers.push_back(cost(static_cast<Eigen::Index>(i), j));
    return powers;
}

}  // namespace

// One assignment serves both: cut off at c, a pair costs GOSPA as much as leaving both points out (c^p / 2
// each), so the pairs at the cutoff are those GOSPA does not make.
SetDistance setDistance(const Points& estimates, const Points& truths, double p, double c) {
    const auto m = static_cast<double>(estimates.size()), n = static_cast<double>(truths.size());
    SetDistance result;
    if (estimates.empty() && truths.empty()) return result;

    const double cutoff_power = std::pow(c, p);
    double within = 0, all = 0, pairs_within = 0;
    for (const double power : assignedPowers(estimates, truths, p, c)) {
        all += power;
        if (power >= cutoff_power) continue;
        within += power;
        ++pairs_within;
    }

    const double larger = std::max(m, n), unpaired = std::abs(m - n) * cutoff_power;
    result.ospa = {root((all + unpaired) / larger, p), root(all / larger, p), root(unpaired / larger, p)};

    Gospa& g = result.gospa;
    g.matched_count = pairs_within;
    g.missed_count = n - pairs_within;
    g.false_count = m - pairs_within;
    g.localisation_part = within;
    g.missed_part = g.missed_count * cutoff_power / 2;
    g.false_part = g.false_count * cutoff_power / 2;
    g.total = root(g.localisation_part + g.missed_part + g.false_part, p);
    return result;
}

namespace {

void add(SetDistance& sum, const SetDistance& d, double weight) {
    sum.ospa.total += weight * d.ospa.total;
    sum.ospa.localisation += weight * d.ospa.localisation;
    sum.ospa.cardinality += weight * d.ospa.cardinality;
    sum.gospa.total += weight * d.gospa.total;
    sum.gospa.localisation_part += weight * d.gospa.localisation_part;
    sum.gospa.missed_part += weight * d.gospa.missed_part;
    sum.gospa.false_part += weight * d.gospa.false_part;
    sum.gospa.matched_count += weight * d.gospa.matched_count;
    sum.gospa.missed_count += weight * d.gospa.missed_count;
    sum.gospa.false_count += weight * d.gospa.false_count;
}

Points positionsOf(const std::vector<SceneObject>& objects) {
    Points points;
    for (const SceneObject& object : objects) points.push_back(object.position);
    return points;
}

}  // namespace

Measured<TrackSetDistance> trackSetDistance(const RunRecord& run, const Truth& truth,
                                            const EvaluationOptions& options) {
    const Measured<TrackingScene> scene = sceneOfAllTargets(run, truth, options);
    if (!scene) return Measured<TrackSetDistance>::absent(scene.whyAbsent());
    TrackSetDistance result;
    result.stamps = static_cast<std::int64_t>(scene->frames.size());
    result.stamps_in_gaps = scene->stamps_in_gaps;
    for (const SceneFrame& frame : scene->frames)
        add(result.mean,
            setDistance(positionsOf(frame.tracks), positionsOf(frame.targets), options.set_order,
                        options.set_cutoff),
            1 / static_cast<double>(result.stamps));
    return result;
}

Measured<SetDistance> landmarkSetDistance(const RunRecord& run, const Truth& truth,
                                          const EvaluationOptions& options) {
    using Result = Measured<SetDistance>;
    if (run.landmarks.empty()) return Result::absent("the run has no landmarks");
    if (truth.landmarks.empty()) return Result::absent("truth has no landmarks");
    Points estimates, truths;
    for (const LandmarkEstimate& landmark : run.landmarks) estimates.push_back(landmark.mean);
    for (const auto& [id, position] : truth.landmarks) truths.push_back(position);
    return setDistance(estimates, truths, options.set_order, options.set_cutoff);
}

}  // namespace slamot::eval
