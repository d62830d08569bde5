#pragma once
#include <optional>

#include "slamot/core/data/Pose2.h"
#include "slamot/core/data/Stamp.h"

namespace slamot {

/// Velocity of the base frame, expressed in the base frame [m/s, m/s, rad/s].
struct BodyVelocity {
    double vx = 0, vy = 0, omega = 0;
};

/// What odometry says happened in (t0, t1]. `[motion] model` decides which field an estimator reads.
struct OdometryIncrement {
    Stamp t0, t1;
    /// T_robot(t0)_robot(t1).
    Pose2 increment;
    /// Held constant over the interval, where the log has velocities.
    std::optional<BodyVelocity> velocity;
    /// Covariance of `increment` as [x y theta] in the frame of t0, where the log has one.
    std::optional<Matrix3> covariance;
    /// Length [s] of the odometry entry this increment was cut from. One draw of control noise holds over an
    /// entry, so cutting it in pieces must leave the variance of their sum unchanged: models scale the variance
    /// of the control by entry_seconds / (t1 - t0).
    double entry_seconds = 0;

    double seconds() const { return secondsBetween(t0, t1); }
};

/// Cuts `entry` at `t` (t0 < t < t1), at constant body velocity: the pieces compose to the entry exactly.
struct OdometrySplit {
    OdometryIncrement before, after;
};
OdometrySplit split(const OdometryIncrement& entry, Stamp t);

/// What would follow on `entry` until `t` (after entry.t1) at the same body velocity.
OdometryIncrement extrapolate(const OdometryIncrement& entry, Stamp t);

}  // namespace slamot
