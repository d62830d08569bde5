#include "TrueOrigin.h"

#include <fmt/format.h>

#include <algorithm>

#include "slamot/core/data/Angle.h"

namespace slamot::report {

Vector2 trueOrigin(const Vector2& measured, const Vector2& point, double estimated_heading) {
    return measured - rotation(estimated_heading) * point;
}

double estimatedHeading(const std::vector<eval::RobotRow>& trajectory, Stamp stamp) {
    if (trajectory.empty()) {
        return 0;
    }
    const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                                        [](const eval::RobotRow& row, Stamp t) { return row.stamp < t; });
    if (after == trajectory.begin() || after == trajectory.end() || after->stamp == stamp) {
        return (after == trajectory.end() ? after - 1 : after)->robot.mean.theta;
    }
    const auto before = after - 1;
    const double part = secondsBetween(before->stamp, stamp) / secondsBetween(before->stamp, after->stamp);
    const double theta = before->robot.mean.theta;
    return wrapAngle(theta + part * angleDifference(after->robot.mean.theta, theta));
}

std::string whereTruthIsDrawn(const Truth& truth) {
    if (truth.robot.empty() || truth.point.isZero(0)) {
        return {};
    }
    return fmt::format(
        "Truth is measured at the point ({}, {}) m of the robot; the true way is drawn at the robot's "
        "origin, "
        "by the estimated heading.",
        truth.point.x(), truth.point.y());
}

}  // namespace slamot::report
