#pragma once
// The blocks a joint state is made of.
#include <Eigen/Core>

namespace slamot {

enum class BlockKind {
    robot,     ///< [x y theta]
    pose,      ///< [x y theta] of the robot at another time; theta near the same value in all modes, not wrapped
    target,    ///< [px py vx vy ax ay]
    landmark,  ///< [x y]
    extra      ///< anything that does not turn with the world: calibration, delays
};

/// Names a block of the joint state; stays valid until the block is removed, never reused.
using BlockId = int;
inline constexpr BlockId robot_block = 0;

/// How an update is made consistent with the world's freedom to turn (doc/plugins/ekf_slamot.md).
enum class Consistency {
    classic,   ///< the textbook EKF
    invariant  ///< the covariance is transported along the update of the mean
};

/// Mean or covariance of a block; never on the heap.
using BlockVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;
using BlockMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

/// How a block's new value depends on another block's old value.
struct Coupling {
    BlockId from;
    BlockMatrix F;
};

/// A block to be added: it depends on the robot, or on another pose, by G and has covariance `own` of its own.
struct NewBlock {
    BlockVector mean;
    /// d block / d pose, size x 3.
    BlockMatrix G;
    BlockMatrix own;
    BlockId from = robot_block;
};

}  // namespace slamot
