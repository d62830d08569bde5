#pragma once
// A range-bearing detection against the joint state. The second-order range terms belong to the invariant
// core; doc/plugins/ekf_slamot.md derives them.
#include "slamot/core/data/Detections.h"
#include "slamot/core/estimation/JointBank.h"

namespace slamot {

/// A detection to come, without its noise: z = [range bearing] and its covariance.
struct ExpectedDetection {
    Vector2 z;
    Matrix2 covariance;
};

/// Whether each row alone lies within the gate: what fails here fails the gate of both, at the price of two
/// comparisons.
bool rowsLieWithin(double gate, const ExpectedDetection& expected, const RangeBearingDetection& detection);

struct Linearisation {
    LinearMeasurement measurement;
    Matrix2 S;   ///< innovation covariance at the predicted state, second-order terms included
    double nis;  ///< residual^t S^-1 residual
};

/// An object as a sensor is about to see it: all about a pair that the detection has no part in.
struct ExpectedSight {
    ExpectedDetection detection;    ///< H P H^t, second-order terms included
    LinearMeasurement measurement;  ///< no residual yet; R: the second-order terms' variance alone

    /// Throws std::domain_error when S is not positive definite.
    Linearisation with(const RangeBearingDetection& seen) const;
};

/// Linearises the sight of the object in `block`, whose position leads it, from the robot or from another pose,
/// at the present mean.
ExpectedSight expectedSight(const JointView& state, BlockId block, const Pose2& sensor,
                            Consistency consistency, BlockId from = robot_block);

/// The same, with the detection.
inline Linearisation linearise(const JointView& state, BlockId block, const RangeBearingDetection& detection,
                               const Pose2& sensor, Consistency consistency, BlockId from = robot_block) {
    return expectedSight(state, block, sensor, consistency, from).with(detection);
}

}  // namespace slamot
