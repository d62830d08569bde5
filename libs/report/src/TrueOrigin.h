#pragma once
#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/Truth.h"

namespace slamot::report {

/// Where truth has the robot's origin, p - R(theta) point, by the estimated heading: truth may know none.
/// Metrics carry the estimate to the point by that heading, so the distance from the estimate is the error
/// that they count.
Vector2 trueOrigin(const Vector2& measured, const Vector2& point, double estimated_heading);

/// The estimated heading at a stamp, linear between rows; that of the first or last row beyond them, 0
/// without rows.
double estimatedHeading(const std::vector<eval::RobotRow>& trajectory, Stamp stamp);

/// "Truth is measured 3.81 m from the robot's origin ...", or nothing where it is measured there.
std::string whereTruthIsDrawn(const Truth& truth);

}  // namespace slamot::report
