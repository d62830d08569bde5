#pragma once
// The interacting multiple model filter on the joint state, exact in the movers' modes (paper 1,
// section 2.3): one joint Gaussian for each combination of modes. With one mode, or no mover, it is the EKF.
#include "slamot/core/estimation/ModalState.h"

namespace slamot {

/// n modes and k movers make n^k combinations; the last mover's mode counts fastest.
class JointImm : public ModalState {
  public:
    /// `bank` has one mode and no movers.
    JointImm(std::shared_ptr<const ModalSettings> settings, std::unique_ptr<JointBank> bank);

    BlockVector mean(BlockId block) const override;
    BlockMatrix covariance(BlockId a, BlockId b) const override;
    Eigen::MatrixXd jointCovariance(const std::vector<BlockId>& blocks) const override;
    TargetBelief target(BlockId target) const override;

    void predict(const OdometryIncrement& odometry, const std::vector<TargetModel>& models) override;
    void update(const RangeBearingSet& seen, const KnownObjects& known,
                std::vector<Innovation>& innovations) override;
    BlockId addTarget(const RelativeGaussian& target) override;
    void removeTarget(BlockId target) override;
    void widenTarget(BlockId target, const Matrix6& Q) override;

    const std::vector<BlockId>& targets() const { return targets_; }
    /// Probabilities of the combinations.
    const Eigen::VectorXd& probabilities() const { return mu_; }
    /// A mover's mode in a combination.
    int modeOf(int combination, std::size_t target) const;
    /// Gives the bank away, merged to one mode; this is empty then.
    std::unique_ptr<JointBank> releaseMerged();

  private:
    void mix(double dt);
    /// Linearises a detection in all modes and judges it; what is used joins the batches.
    void addToBatches(const RangeBearingSet& seen, const KnownObjects::Sight& sight, Innovation& innovation);
    /// Old combinations become new ones: weights(i, j), how much of the old i the new j gets.
    void regroup(const Eigen::MatrixXd& weights);

    std::vector<BlockId> targets_;
    // Work space of update, kept for its capacity.
    std::vector<std::vector<LinearMeasurement>> batches_;
    std::vector<Linearisation> linear_;
    Eigen::VectorXd log_mu_;
};

}  // namespace slamot
