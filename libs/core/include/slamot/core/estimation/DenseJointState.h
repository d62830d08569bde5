#pragma once
// The joint state as one mean vector and one full covariance.
#include <vector>

#include "slamot/core/estimation/JointState.h"

namespace slamot {

/// Blocks stand in the order they were added. Only the lower triangle of the covariance is kept and worked on: it
/// is symmetric by construction. Storage grows by doubling, so that steps do not allocate once sizes have settled.
class DenseJointState : public JointState {
   public:
    DenseJointState(const Vector3& robot, const Matrix3& covariance);

    std::unique_ptr<JointState> clone() const override { return std::make_unique<DenseJointState>(*this); }
    int dimension() const override { return n_; }
    BlockVector mean(BlockId block) const override;
    BlockMatrix covariance(BlockId a, BlockId b) const override;
    Eigen::MatrixXd jointCovariance(const std::vector<BlockId>& blocks) const override;
    void propagate(BlockId block, const Eigen::Ref<const Eigen::VectorXd>& mean,
                   const Eigen::Ref<const Eigen::MatrixXd>& F, const Eigen::Ref<const Eigen::MatrixXd>& Q,
                   const std::vector<Coupling>& couplings = {}) override;
    BlockId augment(BlockKind kind, const Eigen::Ref<const Eigen::VectorXd>& mean,
                    const Eigen::Ref<const Eigen::MatrixXd>& G,
                    const Eigen::Ref<const Eigen::MatrixXd>& own) override;
    void remove(BlockId block) override;
    void update(const std::vector<LinearMeasurement>& batch, Consistency consistency) override;

   private:
    struct Block {
        BlockKind kind = BlockKind::extra;
        int offset = -1;  ///< -1 once removed
        int size = 0;
    };

    const Block& block(BlockId id) const;
    BlockId append(BlockKind kind, int size);
    void reserve(int dimension);
    /// Columns [first, first + count) of the symmetric matrix, whole.
    template <class Out>
    void gatherColumns(int first, int count, Out&& out) const;
    /// Writes whole columns of the symmetric matrix into the triangle.
    template <class In>
    void scatterColumns(int first, const In& columns);
    void transport(const Eigen::Ref<const Eigen::VectorXd>& dx);

    std::vector<Block> blocks_;  ///< by BlockId
    int n_ = 0;
    Eigen::VectorXd x_;
    Eigen::MatrixXd P_;  ///< lower triangle of the leading n_ x n_
    // Work space, kept so that steps need not allocate.
    Eigen::MatrixXd PHt_, S_, robot_columns_, columns_, moved_;
    Eigen::VectorXd nu_, dx_, shift_;
};

}  // namespace slamot
