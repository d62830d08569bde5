#include "slamot/core/data/Odometry.h"

#include <cmath>
#include <stdexcept>

namespace slamot {
namespace {

/// The twist xi with exp(xi) = pose: constant body velocity times its duration.
Vector3 poseLog(const Pose2& pose) {
    const double half = 0.5 * pose.theta;
    const double cot = std::abs(half) < 1e-6 ? 1.0 - half * half / 3.0 : half / std::tan(half);
    return {cot * pose.x + half * pose.y, -half * pose.x + cot * pose.y, pose.theta};
}

Pose2 poseExp(const Vector3& twist) {
    const double w = twist.z();
    const double f = std::abs(w) < 1e-6 ? 1.0 - w * w / 6.0 : std::sin(w) / w;
    const double g = std::abs(w) < 1e-6 ? 0.5 * w : (1.0 - std::cos(w)) / w;
    return {f * twist.x() - g * twist.y(), g * twist.x() + f * twist.y(), wrapAngle(w)};
}

}  // namespace

OdometrySplit split(const OdometryIncrement& entry, Stamp t) {
    if (!(entry.t0 < t && t < entry.t1))
        throw std::invalid_argument("an odometry entry is split strictly inside its interval");
    const double fraction = secondsBetween(entry.t0, t) / entry.seconds();
    OdometrySplit pieces{entry, entry};
    if (entry.entry_seconds <= 0) pieces.before.entry_seconds = pieces.after.entry_seconds = entry.seconds();
    pieces.before.t1 = t;
    pieces.after.t0 = t;
    pieces.before.increment = poseExp(fraction * poseLog(entry.increment));
    pieces.after.increment = inverse(pieces.before.increment) * entry.increment;
    if (entry.covariance) {
        pieces.before.covariance = fraction * *entry.covariance;
        pieces.after.covariance = (1.0 - fraction) * *entry.covariance;
    }
    return pieces;
}

OdometryIncrement extrapolate(const OdometryIncrement& entry, Stamp t) {
    if (!(entry.t1 < t)) throw std::invalid_argument("an odometry entry is extrapolated beyond its interval");
    const double fraction = secondsBetween(entry.t1, t) / entry.seconds();
    OdometryIncrement beyond = entry;
    beyond.t0 = entry.t1;
    beyond.t1 = t;
    beyond.entry_seconds = beyond.seconds();
    beyond.increment = poseExp(fraction * poseLog(entry.increment));
    if (entry.covariance) beyond.covariance = fraction * *entry.covariance;
    return beyond;
}

}  // namespace slamot
