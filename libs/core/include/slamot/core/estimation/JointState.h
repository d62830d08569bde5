#pragma once
// The joint Gaussian state [robot | targets | landmarks] behind one interface. Filters say what happens to blocks;
// engines decide how mean and covariance are kept.
#include <Eigen/Core>

#include <array>
#include <memory>
#include <vector>

#include "slamot/core/data/Pose2.h"

namespace slamot {

enum class BlockKind {
    robot,     ///< [x y theta]
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

/// Up to 2 x 6: Jacobian of a measurement with respect to the leading coordinates of a block.
using MeasurementJacobian = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::ColMajor, 2, 6>;

/// z - h(x) = H dx + noise, for two rows: residual, noise, and H as blocks.
struct LinearMeasurement {
    struct Term {
        BlockId block = -1;
        MeasurementJacobian H;
    };
    /// Robot, object and at most one more; blocks differ from one another.
    std::array<Term, 3> terms;
    int term_count = 0;
    Vector2 residual;
    Matrix2 R;

    void add(BlockId block, const MeasurementJacobian& H) { terms[term_count++] = {block, H}; }
};

/// How a block's new value depends on another block's old value.
struct Coupling {
    BlockId from;
    BlockMatrix F;
};

class JointState {
   public:
    virtual ~JointState() = default;
    virtual std::unique_ptr<JointState> clone() const = 0;

    virtual int dimension() const = 0;
    virtual BlockVector mean(BlockId block) const = 0;
    /// P_ab, dim(a) x dim(b).
    virtual BlockMatrix covariance(BlockId a, BlockId b) const = 0;
    /// Covariance of many blocks in the order given. Expensive.
    virtual Eigen::MatrixXd jointCovariance(const std::vector<BlockId>& blocks) const = 0;

    /// x_b <- mean; P_b,: <- F P_b,: + sum_c F_c P_c,:; P_bb += Q. Paper 1, eq. 27-35.
    virtual void propagate(BlockId block, const Eigen::Ref<const Eigen::VectorXd>& mean,
                           const Eigen::Ref<const Eigen::MatrixXd>& F, const Eigen::Ref<const Eigen::MatrixXd>& Q,
                           const std::vector<Coupling>& couplings = {}) = 0;

    /// A new block that depends on the robot by G and has covariance `own` of its own: P_n,: = G P_R,:,
    /// P_nn = G P_RR G^t + own. Paper 1, eq. 10-24.
    virtual BlockId augment(BlockKind kind, const Eigen::Ref<const Eigen::VectorXd>& mean,
                            const Eigen::Ref<const Eigen::MatrixXd>& G,
                            const Eigen::Ref<const Eigen::MatrixXd>& own) = 0;

    /// Marginalises a block out.
    virtual void remove(BlockId block) = 0;

    /// Conditions on a batch, linearised at the present mean. Paper 1, eq. 46-47; with Consistency::invariant the
    /// covariance is then transported from the old mean to the new one: P <- D P D^t with
    /// D = I + [J (p+ - p-)] e_theta^t over every 2-vector p of robot position, targets and landmarks. Throws
    /// std::domain_error when S is not positive definite.
    virtual void update(const std::vector<LinearMeasurement>& batch, Consistency consistency) = 0;
};

}  // namespace slamot
