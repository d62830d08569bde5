#include "slamot/eval/Landmarks.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "slamot/core/association/Assignment.h"

namespace slamot::eval {
namespace {

struct LandmarkPair {
    const LandmarkEstimate* estimate;
    Vector2 truth;
};

/// Of several estimates of one source the one seen most counts, of equals the one of lowest id.
std::vector<LandmarkPair> pairsBySource(const std::vector<LandmarkEstimate>& estimates,
                                        const std::map<SourceId, Vector2>& truths) {
    std::map<SourceId, const LandmarkEstimate*> best;
    for (const LandmarkEstimate& e : estimates) {
        if (!e.source.valid()) continue;
        const LandmarkEstimate*& b = best[e.source];
        if (b == nullptr || e.seen > b->seen || (e.seen == b->seen && e.id < b->id)) b = &e;
    }
    std::vector<LandmarkPair> pairs;
    for (const auto& [source, estimate] : best)
        if (const auto truth = truths.find(source); truth != truths.end())
            pairs.push_back({estimate, truth->second});
    return pairs;
}

/// The most pairs within the cutoff, and of those the least total distance.
std::vector<LandmarkPair> pairsByAssignment(const std::vector<LandmarkEstimate>& estimates,
                                            const std::map<SourceId, Vector2>& truths, double cutoff) {
    std::vector<Vector2> points;
    for (const auto& [source, position] : truths) points.push_back(position);
    Eigen::MatrixXd cost(static_cast<Eigen::Index>(estimates.size()),
                         static_cast<Eigen::Index>(points.size()));
    for (Eigen::Index i = 0; i < cost.rows(); ++i)
        for (Eigen::Index j = 0; j < cost.cols(); ++j) {
            const double d =
                (estimates[static_cast<std::size_t>(i)].mean - points[static_cast<std::size_t>(j)]).norm();
            cost(i, j) = d <= cutoff ? d : forbidden_pair;
        }
    const Assignment assignment = optimalAssignment(cost);
    std::vector<LandmarkPair> pairs;
    for (std::size_t i = 0; i < estimates.size(); ++i)
        if (const int j = assignment.column_of_row[i]; j >= 0)
            pairs.push_back({&estimates[i], points[static_cast<std::size_t>(j)]});
    return pairs;
}

}  // namespace

Measured<LandmarkErrors> landmarkErrors(const RunRecord& run, const Truth& truth,
                                        const EvaluationOptions& options) {
    using Result = Measured<LandmarkErrors>;
    if (run.landmarks.empty()) return Result::absent("the run has no landmarks");
    if (truth.landmarks.empty()) return Result::absent("truth has no landmarks");

    LandmarkErrors result;
    result.matching = options.landmark_matching;
    if (result.matching == Matching::automatic) {
        const bool any_source = std::any_of(run.landmarks.begin(), run.landmarks.end(),
                                            [](const LandmarkEstimate& e) { return e.source.valid(); });
        result.matching = any_source ? Matching::source_id : Matching::assignment;
    }
    const std::vector<LandmarkPair> pairs =
        result.matching == Matching::source_id
            ? pairsBySource(run.landmarks, truth.landmarks)
            : pairsByAssignment(run.landmarks, truth.landmarks, options.landmark_cutoff);

    std::vector<double> errors;
    NeesSeries series;
    for (const auto& [estimate, true_position] : pairs) {
        const Vector2 e = estimate->mean - true_position;
        errors.push_back(e.norm());
        series.push_back({estimate->last_seen, nees(e, estimate->covariance)});
    }
    result.matched = static_cast<std::int64_t>(pairs.size());
    result.missing = static_cast<std::int64_t>(truth.landmarks.size()) - result.matched;
    result.extra = static_cast<std::int64_t>(run.landmarks.size()) - result.matched;
    result.position = summariseErrors(errors);
    result.nees = summariseNees(series, options.probability);
    return result;
}

Measured<MapCardinality> mapCardinality(const RunRecord& run, const Truth& truth) {
    using Result = Measured<MapCardinality>;
    using Seen = Measured<MapCardinality::Seen>;
    if (run.landmarks.empty()) return Result::absent("the run has no landmarks");
    if (truth.landmarks.empty()) return Result::absent("truth has no landmarks");
    MapCardinality result;
    result.estimated = static_cast<std::int64_t>(run.landmarks.size());
    result.landmarks = static_cast<std::int64_t>(truth.landmarks.size());
    result.error = result.estimated - result.landmarks;
    if (truth.associations.empty() || run.trajectory.empty()) {
        result.seen = Seen::absent("truth has no associations, which would tell which landmarks were seen");
        return result;
    }
    const Stamp begin = run.trajectory.front().stamp, end = run.trajectory.back().stamp;
    std::set<SourceId> seen;
    for (const TrueAssociation& a : truth.associations)
        if (a.kind == "landmark" && begin <= a.stamp && a.stamp <= end) seen.insert(a.id);
    const auto count = static_cast<std::int64_t>(seen.size());
    result.seen = MapCardinality::Seen{count, result.estimated - count};
    return result;
}

}  // namespace slamot::eval
