#pragma once
// A range-bearing detection against the joint state: linearisation, gate, and the start of new objects. The
// second-order range terms belong to the invariant core; doc/plugins/ekf_slamot.md derives them.
#include "slamot/core/data/Detections.h"
#include "slamot/core/estimation/JointBank.h"

namespace slamot {

struct Linearisation {
    LinearMeasurement measurement;
    Matrix2 S;   ///< innovation covariance at the predicted state, second-order terms included
    double nis;  ///< residual^t S^-1 residual
};

/// Linearises the detection of the object in `block` at the present mean. Throws std::domain_error when S is not
/// positive definite.
Linearisation linearise(const JointView& state, BlockId block, const RangeBearingDetection& detection,
                        const Pose2& sensor, Consistency consistency);

/// Position of an object seen for the first time, its Jacobian with respect to the robot and its own covariance.
struct FirstSight {
    Vector2 position;
    Eigen::Matrix<double, 2, 3> G;
    Matrix2 own;
};
FirstSight firstSight(const JointView& state, const RangeBearingDetection& detection, const Pose2& sensor,
                      Consistency consistency);

}  // namespace slamot
