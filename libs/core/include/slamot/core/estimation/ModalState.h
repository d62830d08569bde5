#pragma once
// Robot, movers and landmarks with the movers' modes: what a joint filter is made of. One way to keep the
// modes is exact (JointImm; with one mode it is the EKF), one is scalable (BankedImm).
#include <memory>
#include <vector>

#include "slamot/core/data/Estimate.h"
#include "slamot/core/data/Odometry.h"
#include "slamot/core/estimation/JointBank.h"
#include "slamot/core/estimation/OutlierGate.h"
#include "slamot/core/estimation/TargetModes.h"
#include "slamot/core/models/RobotMotion.h"

namespace slamot {

/// What does not change during a run.
struct ModalSettings {
    RobotMotionParameters motion;
    OutlierGate gate;
    double target_velocity_std, target_acceleration_std;  ///< priors at first sight

    ModeChain chain;
    Eigen::VectorXd initial;  ///< mode probabilities at first sight
    ModeLikelihood likelihood;
};

/// Detections of objects that have a block, each with its index in the set.
struct KnownObjects {
    struct Sight {
        int detection;
        BlockId block;
    };
    std::vector<Sight> landmarks, targets;
    /// All their blocks.
    std::vector<BlockId> blocks;

    void clear();
};

struct TargetBelief {
    Vector6 mean;
    Matrix6 covariance;
    Eigen::VectorXd mode_probabilities;
};

/// As a JointView it shows the joint distribution over all modes.
class ModalState : public JointView {
  public:
    explicit ModalState(std::shared_ptr<const ModalSettings> settings) : settings_(std::move(settings)) {}

    virtual const JointBank& bank() const = 0;
    virtual TargetBelief target(BlockId target) const = 0;

    /// models: of the modes, in the order of the chain.
    virtual void predict(const OdometryIncrement& odometry, const std::vector<TargetModel>& models) = 0;
    /// Takes in what is known of `seen`; innovations are those of all detections, in their order.
    virtual void update(const RangeBearingSet& seen, const KnownObjects& known,
                        std::vector<Innovation>& innovations) = 0;
    virtual BlockId addLandmark(const RangeBearingDetection& detection, const Pose2& sensor) = 0;
    virtual BlockId addTarget(const RangeBearingDetection& detection, const Pose2& sensor) = 0;
    virtual void removeTarget(BlockId target) = 0;

  protected:
    const ModalSettings& settings() const { return *settings_; }
    /// The object as every mode of the bank sees it for the first time (paper 1, eq. 8-9 and 13-17).
    std::vector<NewBlock> newLandmark(const RangeBearingDetection& detection, const Pose2& sensor) const;
    std::vector<NewBlock> newTarget(const RangeBearingDetection& detection, const Pose2& sensor) const;

    std::shared_ptr<const ModalSettings> settings_;
};

}  // namespace slamot
