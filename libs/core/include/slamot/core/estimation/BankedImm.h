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

    const JointBank& bank() const override { return *joint_; }
    BlockVector mean(BlockId block) const override { return joint_->mode(0).mean(block); }
    BlockMatrix covariance(BlockId a, BlockId b) const override { return joint_->mode(0).covariance(a, b); }
    Eigen::MatrixXd jointCovariance(const std::vector<BlockId>& blocks) const override {
        return joint_->mode(0).jointCovariance(blocks);
    }
    TargetBelief target(BlockId target) const override;

    void predict(const OdometryIncrement& odometry, const std::vector<TargetModel>& models) override;
    void update(const RangeBearingSet& seen, const KnownObjects& known,
                std::vector<Innovation>& innovations) override;
    BlockId addLandmark(const RangeBearingDetection& detection, const Pose2& sensor) override;
    BlockId addTarget(const RangeBearingDetection& detection, const Pose2& sensor) override;
    void removeTarget(BlockId target) override;

    /// Gives the joint state away; this is empty then.
    std::unique_ptr<JointBank> release() { return std::move(joint_); }

  private:
    TargetGaussian marginal(BlockId target) const;
    std::size_t indexOf(BlockId target) const;
    void updateByTargets(const RangeBearingSet& seen, const KnownObjects& known,
                         std::vector<Innovation>& innovations);
    /// A mover's bank takes its detection in; the joint state's part joins the batch.
    void measure(const RangeBearingSet& seen, const KnownObjects::Sight& sight, Innovation& innovation);
    /// By the batch of movers, which is empty then.
    void updateJoint();

    std::unique_ptr<JointBank> joint_;
    std::vector<std::pair<BlockId, TargetBank>> targets_;
    Eigen::VectorXd certain_ = Eigen::VectorXd::Ones(1);  ///< weight of the joint state's only mode
    LandmarkUpdate update_by_landmarks_;
    std::vector<LinearMeasurement> batch_;  ///< of movers; kept for its capacity
    std::vector<Linearisation> linear_;
};

}  // namespace slamot
