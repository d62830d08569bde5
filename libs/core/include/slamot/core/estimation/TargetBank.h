#pragma once
// The modes of one mover beside a joint state of one mode: an IMM of six dimensions that keeps in step with
// the mover's block of the joint state (doc/plugins/imm_slamot.md, "Several movers").
#include <vector>

#include "slamot/core/estimation/ModalState.h"
#include "slamot/core/estimation/TargetMixture.h"

namespace slamot {

/// How the joint state's block of a mover moves, as the bank has it: x <- mean, P <- Phi P Phi^t + Q.
struct BlockPrediction {
    Vector6 mean;
    Matrix6 Phi, Q;
};

/// L with L from L^t = to: 2 x 2 blocks, lower triangular, symmetric on the diagonal. It turns with the
/// world, does not depend on units, and is near I where `to` is near `from`. Components without variance are
/// mapped to 0.
Matrix6 covarianceMap(const Matrix6& from, const Matrix6& to);

class RobotGivenTarget;

class TargetBank {
  public:
    /// Modes of probability mu, each with its Gaussian; the snapshot is of what they make together.
    TargetBank(const Eigen::VectorXd& mu, std::vector<TargetGaussian> modes);

    /// Step 1: what else has moved the joint state's block since the snapshot moves every mode alike.
    void synchronise(const TargetGaussian& joint);
    /// The bank has made this change of the joint state's block itself.
    void takeSnapshot(const TargetGaussian& joint) { snapshot_ = joint; }
    /// Step 2: mixing and prediction.
    BlockPrediction predict(const Eigen::MatrixXd& p, const std::vector<TargetModel>& models, double dt,
                            const Vector6& joint_mean);
    /// Step 3: the detection as each mode sees it, with the robot where it is given that mode...
    void linearise(const RobotGivenTarget& robot, const RangeBearingDetection& detection, const Pose2& sensor,
                   Consistency consistency, std::vector<Linearisation>& by_mode) const;
    /// ... and every mode's update by it.
    void update(const RobotGivenTarget& robot, const std::vector<Linearisation>& by_mode,
                Consistency consistency);
    /// Step 4: a bank that has parted from the joint state is led back.
    void guard(const TargetGaussian& joint);

    /// P += Q in every mode.
    void widen(const Matrix6& Q);

    const Eigen::VectorXd& probabilities() const { return mu_; }
    TargetGaussian merged() const;

  private:
    /// x <- to + L (x - from) in every mode.
    void move(const Vector6& from, const Matrix6& L, const Vector6& to);

    Eigen::VectorXd mu_;
    std::vector<TargetGaussian> modes_;
    TargetGaussian snapshot_;
};

}  // namespace slamot
