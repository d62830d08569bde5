#pragma once
// The interacting multiple model filter for many movers: one joint Gaussian over robot, movers and map, and
// beside it a bank of modes for each mover. Robot and map are reported from the joint Gaussian, movers from
// their banks.
#include <utility>

#include "slamot/core/estimation/JointImm.h"
#include "slamot/core/estimation/LandmarkUpdate.h"
#include "slamot/core/estimation/TargetBank.h"

namespace slamot {

class BankedImm : public ModalState {
  public:
    /// Goes on where the exact form stands.
    BankedImm(std::shared_ptr<const ModalSettings> settings, JointImm&& exact);

    BlockVector mean(BlockId block) const override { return bank_->mode(0).mean(block); }
    BlockMatrix covariance(BlockId a, BlockId b) const override { return bank_->mode(0).covariance(a, b); }
    Eigen::MatrixXd jointCovariance(const std::vector<BlockId>& blocks) const override {
        return bank_->mode(0).jointCovariance(blocks);
    }
    TargetBelief target(BlockId target) const override;

    void predict(const OdometryIncrement& odometry, const std::vector<TargetModel>& models) override;
    void update(const RangeBearingSet& seen, const KnownObjects& known,
                std::vector<Innovation>& innovations) override;
    BlockId addTarget(const RelativeGaussian& target) override;
    void removeTarget(BlockId target) override;
    void widenTarget(BlockId target, const Matrix6& Q) override;
    using ModalState::addLandmark;
    BlockId addLandmark(const std::vector<PastSight>& sights, double gate) override;
    void mergeLandmarks(BlockId kept, BlockId gone, double deviation) override;

    /// Gives the joint state away; this is empty then.
    std::unique_ptr<JointBank> release() { return std::move(bank_); }

  private:
    TargetGaussian marginal(BlockId target) const;
    std::size_t indexOf(BlockId target) const;
    /// The banks follow what has moved the joint state.
    void synchronise();
    void updateByTargets(const RangeBearingSet& seen, const KnownObjects& known,
                         std::vector<Innovation>& innovations);
    /// A mover's bank takes its detection in; the joint state's part joins the batch.
    void measure(const RangeBearingSet& seen, const KnownObjects::Sight& sight, Innovation& innovation);
    /// By the batch of movers, which is empty then.
    void updateJoint();

    std::vector<std::pair<BlockId, TargetBank>> targets_;
    LandmarkUpdate update_by_landmarks_;
    std::vector<LinearMeasurement> batch_;  ///< of movers; kept for its capacity
    std::vector<Linearisation> linear_;
};

}  // namespace slamot
