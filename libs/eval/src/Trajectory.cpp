#include "slamot/eval/Trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "StampUnits.h"

namespace slamot::eval {
namespace {

/// The robot's pose carried to a point of it, p' = p + R(theta) point; the heading stays.
PoseGaussian carriedTo(const Vector2& point, const PoseGaussian& robot) {
    const Pose2& mean = robot.mean;
    const Vector2 place = mean * point, arm = place - mean.position();
    Matrix3 J = Matrix3::Identity();
    J.topRightCorner<2, 1>() << -arm.y(), arm.x();
    return {{place.x(), place.y(), mean.theta}, J * robot.covariance * J.transpose()};
}

}  // namespace

PairedTrajectory pairWithTruth(const std::vector<RobotRow>& trajectory, const Truth& truth) {
    PairedTrajectory paired;
    paired.counts.total = static_cast<std::int64_t>(trajectory.size());
    if (truth.robot.empty()) return paired;
    const Stamp first = truth.robot.front().stamp, last = truth.robot.back().stamp;
    for (const RobotRow& row : trajectory) {
        if (row.stamp < first || row.stamp > last) continue;
        ++paired.counts.covered;
        const auto pose = truth.pointAt(row.stamp);
        if (!pose) continue;
        const bool at_origin = truth.point.isZero(0);
        paired.pairs.push_back({row.stamp, at_origin ? row.robot : carriedTo(truth.point, row.robot), *pose});
    }
    paired.counts.matched = static_cast<std::int64_t>(paired.pairs.size());
    return paired;
}

std::optional<std::string> whyTooFew(const PairedTrajectory& paired, const std::vector<RobotRow>& trajectory,
                                     const Truth& truth, double min_matched) {
    if (trajectory.empty()) return "the run has no trajectory";
    if (truth.robot.empty()) return "truth has no robot trajectory";
    const MatchCounts& n = paired.counts;
    if (n.matched > 0 && static_cast<double>(n.matched) >= min_matched * static_cast<double>(n.covered))
        return std::nullopt;

    const StampSpan run_span{trajectory.front().stamp, trajectory.back().stamp};
    const StampSpan truth_span{truth.robot.front().stamp, truth.robot.back().stamp};
    const auto mistake = unitMistake(run_span, truth_span);
    if (n.covered == 0 || mistake)
        return fmt::format(
            "{} of {} estimates have a truth: the run covers {} s to {} s, truth {} s to {} s{}{}", n.matched,
            n.total, slamot::toText(run_span.first), slamot::toText(run_span.last),
            slamot::toText(truth_span.first), slamot::toText(truth_span.last), mistake ? "; " : "",
            mistake.value_or(""));
    return fmt::format(
        "only {} of the {} estimates within truth's span have a truth, expected at least {} of them: truth "
        "is not "
        "interpolated across gaps of more than {} s",
        n.matched, n.covered, min_matched, truth.max_interpolation_gap);
}

namespace {

/// Estimate minus truth after the estimate was moved by T_truth_estimate.
RobotErrors errorsAfter(const Pose2& T_truth_estimate, const std::vector<PosePair>& pairs) {
    std::vector<double> position, x, y, heading;
    for (const PosePair& pair : pairs) {
        const Pose2 moved = T_truth_estimate * pair.estimate.mean;
        const Vector2 e = moved.position() - pair.truth.position();
        position.push_back(e.norm());
        x.push_back(e.x());
        y.push_back(e.y());
        heading.push_back(angleDifference(moved.theta, pair.truth.theta));
    }
    return {summariseErrors(position), summariseErrors(x), summariseErrors(y), summariseErrors(heading)};
}

}  // namespace

RobotErrors robotErrors(const std::vector<PosePair>& pairs) {
    return errorsAfter(Pose2{}, pairs);
}

Pose2 alignmentOf(const std::vector<PosePair>& pairs, Alignment alignment) {
    if (pairs.empty() || alignment == Alignment::none) return {};
    if (alignment == Alignment::first_pose) return pairs.front().truth * inverse(pairs.front().estimate.mean);

    // Least squares without scale (Umeyama 1991); in the plane the rotation is the angle of the summed
    // products of the centred positions. Positions that spread less than a micrometre leave it undetermined:
    // nothing is turned.
    const auto n = static_cast<double>(pairs.size());
    Vector2 mean_estimate = Vector2::Zero(), mean_truth = Vector2::Zero();
    for (const PosePair& pair : pairs) {
        mean_estimate += pair.estimate.mean.position() / n;
        mean_truth += pair.truth.position() / n;
    }
    double cosine_sum = 0, sine_sum = 0;
    for (const PosePair& pair : pairs) {
        const Vector2 a = pair.estimate.mean.position() - mean_estimate,
                      b = pair.truth.position() - mean_truth;
        cosine_sum += a.dot(b);
        sine_sum += a.x() * b.y() - a.y() * b.x();
    }
    constexpr double least_spread = 1e-6;
    const bool spread = std::hypot(sine_sum, cosine_sum) > n * least_spread * least_spread;
    const double theta = spread ? std::atan2(sine_sum, cosine_sum) : 0.0;
    const Vector2 shift = mean_truth - rotation(theta) * mean_estimate;
    return {shift.x(), shift.y(), theta};
}

AbsoluteError absoluteError(const std::vector<PosePair>& pairs, Alignment alignment) {
    const Pose2 T = alignmentOf(pairs, alignment);
    const RobotErrors errors = errorsAfter(T, pairs);
    return {alignment, T, errors.position, errors.heading};
}

Measured<RelativeError> relativeError(const std::vector<PosePair>& pairs, double delta, RelativeUnit unit) {
    const auto has_heading = [](const PosePair& pair) { return std::isfinite(pair.truth.theta); };
    if (std::none_of(pairs.begin(), pairs.end(), has_heading))
        return Measured<RelativeError>::absent(
            "truth has no headings, without which no pose is relative to another");
    // Where each pose stands on the axis that delta is measured on: time since the start, or true path
    // length.
    std::vector<double> along(pairs.size(), 0.0);
    for (std::size_t i = 1; i < pairs.size(); ++i)
        along[i] = unit == RelativeUnit::seconds
                       ? secondsBetween(pairs[0].stamp, pairs[i].stamp)
                       : along[i - 1] + (pairs[i].truth.position() - pairs[i - 1].truth.position()).norm();

    // A rounded path length just short of delta counts as delta.
    constexpr double rounding = 1e-9, most_overshoot = 0.1;
    std::vector<double> position, heading;
    double sum_delta = 0;
    for (std::size_t i = 0, j = 0; i < pairs.size(); ++i) {
        while (j < pairs.size() && along[j] - along[i] < delta * (1 - rounding)) ++j;
        if (j == pairs.size()) break;
        const double length = along[j] - along[i];
        if (length > delta * (1 + most_overshoot) || !has_heading(pairs[i]) || !has_heading(pairs[j]))
            continue;
        const Pose2 estimated = inverse(pairs[i].estimate.mean) * pairs[j].estimate.mean;
        const Pose2 truly = inverse(pairs[i].truth) * pairs[j].truth;
        const Pose2 error = inverse(truly) * estimated;
        position.push_back(error.position().norm());
        heading.push_back(error.theta);
        sum_delta += length;
    }
    if (position.empty())
        return Measured<RelativeError>::absent(
            fmt::format("no two matched poses are between {} and {} {} apart", delta,
                        delta * (1 + most_overshoot), toText(unit)));
    return RelativeError{delta, unit, sum_delta / static_cast<double>(position.size()),
                         summariseErrors(position), summariseErrors(heading)};
}

}  // namespace slamot::eval
