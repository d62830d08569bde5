#pragma once
// Something as the robot alone knows it: in the robot's frame, independent of where the robot is.
#include "slamot/core/data/Detections.h"
#include "slamot/core/estimation/Blocks.h"

namespace slamot {

/// Position [x y] from the robot's origin; for a mover also velocity and acceleration relative to the ground.
/// All along the robot's axes. Covariance in the same order.
struct RelativeGaussian {
    BlockVector mean;
    BlockMatrix covariance;

    Vector2 position() const { return mean.head<2>(); }
};

/// A detection alone. The invariant core accounts for the curvature of range: the banana's mean and
/// covariance.
RelativeGaussian firstSight(const RangeBearingDetection& detection, const Pose2& sensor,
                            Consistency consistency);

/// A mover at `point` of which no velocity is known: priors around zero, standard deviations [m/s] and
/// [m/s^2].
RelativeGaussian moverAt(const RelativeGaussian& point, double velocity_std, double acceleration_std);

/// In the world, from a pose [x y theta] (paper 1, eq. 8-9 and 13-17): G is its Jacobian with respect to
/// the pose.
NewBlock inWorld(const RelativeGaussian& object, const Vector3& pose);

}  // namespace slamot
