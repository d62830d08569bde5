#pragma once
// What joint estimation is measured against: robot and map from landmarks alone, and each mover tracked by an
// IMM of its own that takes the robot's estimate for granted but for its covariance. Nothing couples movers
// with robot and map: no correlation is kept, and no mover corrects the robot.
#include <utility>

#include "slamot/core/estimation/LandmarkUpdate.h"
#include "slamot/core/estimation/ModalState.h"
#include "slamot/core/estimation/TargetBank.h"

namespace slamot {

class DecoupledImm : public ModalState {
  public:
    /// `bank` has one mode and no movers.
    DecoupledImm(std::shared_ptr<const ModalSettings> settings, std::unique_ptr<JointBank> bank);

    BlockVector mean(BlockId block) const override;
    /// 0 between a mover and anything else.
    BlockMatrix covariance(BlockId a, BlockId b) const override;
    Eigen::MatrixXd jointCovariance(const std::vector<BlockId>& blocks) const override;
    TargetBelief target(BlockId target) const override;

    void predict(const OdometryIncrement& odometry, const std::vector<TargetModel>& models) override;
    void update(const RangeBearingSet& seen, const KnownObjects& known,
                std::vector<Innovation>& innovations) override;
    BlockId addTarget(const RelativeGaussian& target) override;
    void removeTarget(BlockId target) override;
    void widenTarget(BlockId target, const Matrix6& Q) override;

  private:
    void updateTarget(const RangeBearingSet& seen, const KnownObjects::Sight& sight, Innovation& innovation);
    std::size_t indexOf(BlockId target) const;
    const TargetBank& trackerOf(BlockId target) const { return targets_[indexOf(target)].second; }

    std::vector<std::pair<BlockId, TargetBank>> targets_;
    BlockId last_target_;
    LandmarkUpdate update_by_landmarks_;
    std::vector<Linearisation> linear_;  ///< kept for its capacity
};

}  // namespace slamot
