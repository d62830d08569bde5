#pragma once
// The bank with one full covariance per mode.
#include <vector>

#include "slamot/core/estimation/BlockGaussian.h"
#include "slamot/core/estimation/JointBank.h"

namespace slamot {

/// Mixing needs a second covariance for each mode. Nothing is ever put away, so commits of one mode do
/// nothing; with several modes they are the moment matching that the compressed engine makes, for comparison.
class DenseJointBank : public JointBank {
  public:
    DenseJointBank(const Vector3& robot, const Matrix3& covariance, Consistency consistency, int modes = 1);
    DenseJointBank(const DenseJointBank& other);

    using JointBank::augment;
    std::unique_ptr<JointBank> clone() const override { return std::make_unique<DenseJointBank>(*this); }
    Consistency consistency() const override { return consistency_; }
    int dimension() const override { return layout_.dimension(); }
    BlockKind kind(BlockId block) const override { return layout_.at(block).kind; }
    int modeCount() const override { return static_cast<int>(modes_.size()); }
    JointMode& mode(int index) override { return modes_.at(static_cast<std::size_t>(index)); }
    const JointMode& mode(int index) const override { return modes_.at(static_cast<std::size_t>(index)); }

    BlockId augment(BlockKind kind, const std::vector<NewBlock>& by_mode) override;
    void remove(BlockId block) override;
    void mix(const Eigen::Ref<const Eigen::MatrixXd>& mu) override;
    void attend(const Attention&, const ModeWeights&) override {}
    std::vector<BlockId> landmarksWithinReach() const override { return layout_.blocks(BlockKind::landmark); }
    void activate(const std::vector<BlockId>& landmarks) override;
    void commit(const std::vector<BlockId>& landmarks, const ModeWeights& weights) override;

  private:
    class Mode : public JointMode {
      public:
        explicit Mode(const DenseJointBank& owner) : bank(&owner) {}
        BlockVector mean(BlockId block) const override;
        BlockMatrix covariance(BlockId a, BlockId b) const override;
        Eigen::MatrixXd jointCovariance(const std::vector<BlockId>& blocks) const override;
        void propagate(BlockId block, const Eigen::Ref<const Eigen::VectorXd>& mean,
                       const Eigen::Ref<const Eigen::MatrixXd>& F, const Eigen::Ref<const Eigen::MatrixXd>& Q,
                       const std::vector<Coupling>& couplings) override;
        BatchLikelihood update(const std::vector<LinearMeasurement>& batch) override;

        const DenseJointBank* bank;
        BlockGaussian gaussian;
    };

    Consistency consistency_;
    BlockLayout layout_;
    BlockId next_id_ = 0;
    std::vector<Mode> modes_;
    std::vector<BlockGaussian> mixed_;  ///< where mixing works
};

}  // namespace slamot
