#pragma once
// Robot, movers and landmarks with the movers' modes: what a joint filter is made of. One way to keep the
// modes is exact (JointImm; with one mode it is the EKF), one is scalable (BankedImm).
#include <memory>
#include <optional>
#include <vector>

#include "slamot/core/data/Estimate.h"
#include "slamot/core/data/Odometry.h"
#include "slamot/core/estimation/JointBank.h"
#include "slamot/core/estimation/OutlierGate.h"
#include "slamot/core/estimation/RelativeGaussian.h"
#include "slamot/core/estimation/TargetModes.h"
#include "slamot/core/models/RobotMotion.h"

namespace slamot {

/// What does not change during a run.
struct ModalSettings {
    RobotMotionParameters motion;
    OutlierGate gate;

    ModeChain chain;
    Eigen::VectorXd initial;  ///< mode probabilities at first sight
    ModeLikelihood likelihood;
};

/// Detections of objects that have a block, each with its index in the set.
struct KnownObjects {
    struct Sight {
        int detection;
        BlockId block;
        /// Stands for several detections (JPDA), each gated already: the more they disagree, the further off
        /// it lies, with the more noise, and is no outlier.
        bool weighed = false;
    };
    std::vector<Sight> landmarks, targets;

    void clear();
};

struct TargetBelief {
    Vector6 mean;
    Matrix6 covariance;
    Eigen::VectorXd mode_probabilities;
};

/// A detection from a pose that is part of the joint state.
struct PastSight {
    BlockId from;
    RangeBearingDetection detection;
    Pose2 sensor;
};

/// As a JointView it shows the joint distribution over all modes.
class ModalState : public JointView {
  public:
    const JointBank& bank() const { return *bank_; }
    virtual TargetBelief target(BlockId target) const = 0;

    /// models: of the modes, in the order of the chain.
    virtual void predict(const OdometryIncrement& odometry, const std::vector<TargetModel>& models) = 0;
    /// Before detections are compared with blocks: brings `measured`, and what else the sensors may see from
    /// here, within reach.
    void attend(const RangeBearingSet& seen, const std::vector<BlockId>& measured);
    /// Takes in what is known of `seen`, whose blocks have been attended to; innovations are those of all
    /// detections, in their order.
    virtual void update(const RangeBearingSet& seen, const KnownObjects& known,
                        std::vector<Innovation>& innovations) = 0;
    virtual BlockId addTarget(const RelativeGaussian& target) = 0;
    virtual void removeTarget(BlockId target) = 0;
    /// P_TT += Q in every mode: a mover is less certain than the modes have it.
    virtual void widenTarget(BlockId target, const Matrix6& Q) = 0;

    BlockId addLandmark(const RelativeGaussian& landmark);
    /// A landmark of which there are several sights, each from the robot or from a remembered pose: as if it had
    /// been there at the first, but for sights after it of a NIS above `gate`: they were of something else. At
    /// least one.
    virtual BlockId addLandmark(const std::vector<PastSight>& sights, double gate);
    /// Where the robot is now, as a block; `again`: a block of this kind, which forgets what it was.
    BlockId rememberPose(std::optional<BlockId> again = std::nullopt);
    void removeLandmark(BlockId landmark) { bank_->remove(landmark); }
    /// Two landmarks within reach turn out to be one: conditions on their positions being equal up to
    /// `deviation` [m] in each coordinate, and lets go of `gone`.
    virtual void mergeLandmarks(BlockId kept, BlockId gone, double deviation);

  protected:
    /// The bank's modes have the probabilities mu.
    ModalState(std::shared_ptr<const ModalSettings> settings, std::unique_ptr<JointBank> bank,
               const Eigen::VectorXd& mu = Eigen::VectorXd::Ones(1))
        : settings_(std::move(settings)), bank_(std::move(bank)), mu_(mu) {}

    const ModalSettings& settings() const { return *settings_; }
    OutlierGate gateOf(const KnownObjects::Sight& target) const {
        return target.weighed ? OutlierGate{OutlierTreatment::accept} : settings().gate;
    }
    /// A new object as every mode of the bank has it.
    std::vector<NewBlock> byMode(const RelativeGaussian& object) const;

    std::shared_ptr<const ModalSettings> settings_;
    std::unique_ptr<JointBank> bank_;
    Eigen::VectorXd mu_;
};

}  // namespace slamot
