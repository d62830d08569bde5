#pragma once
// The joint state [robot | targets | landmarks] as a bank of Gaussians, the modes: one for an EKF, several
// for an IMM. All modes have the same blocks; means and covariances are each mode's own; the modes' weights
// are their owner's. Filters say what happens to blocks; engines decide how means and covariances are kept.
#include <memory>
#include <vector>

#include "slamot/core/data/Detections.h"
#include "slamot/core/estimation/LinearMeasurement.h"

namespace slamot {

/// One Gaussian over blocks, to look at: all that measurement models and reports need.
class JointView {
  public:
    virtual ~JointView() = default;
    virtual BlockVector mean(BlockId block) const = 0;
    /// P_ab, dim(a) x dim(b).
    virtual BlockMatrix covariance(BlockId a, BlockId b) const = 0;
    /// Covariance of many blocks in the order given. Expensive.
    virtual Eigen::MatrixXd jointCovariance(const std::vector<BlockId>& blocks) const = 0;
};

/// One mode of a bank.
class JointMode : public JointView {
  public:
    /// x_b <- mean; P_b,: <- F P_b,: + sum_c F_c P_c,:; P_bb += Q. Paper 1, eq. 27-35.
    virtual void propagate(BlockId block, const Eigen::Ref<const Eigen::VectorXd>& mean,
                           const Eigen::Ref<const Eigen::MatrixXd>& F,
                           const Eigen::Ref<const Eigen::MatrixXd>& Q,
                           const std::vector<Coupling>& couplings = {}) = 0;

    /// Conditions on a batch, linearised at the present mean. Paper 1, eq. 46-47; with Consistency::invariant
    /// the covariance is then transported from the old mean to the new one: P <- D P D^t with D = I + [J (p+
    /// - p-)] e_theta^t over every 2-vector p of robot position, targets and landmarks. Throws
    /// std::domain_error when S is not positive definite, and has changed nothing then.
    virtual BatchLikelihood update(const std::vector<LinearMeasurement>& batch) = 0;
};

/// Where the robot is and what its sensors are about to be compared with.
struct Attention {
    Pose2 robot;
    const RangeBearingSet& seen;
    /// The block of every detection of `seen` that has one.
    const std::vector<BlockId>& measured;
};

/// Weights of the modes, summing to 1. A weight of exactly 0 leaves its mode out.
using ModeWeights = Eigen::Ref<const Eigen::VectorXd>;

class JointBank {
  public:
    virtual ~JointBank() = default;
    virtual std::unique_ptr<JointBank> clone() const = 0;

    virtual Consistency consistency() const = 0;
    virtual int dimension() const = 0;
    virtual BlockKind kind(BlockId block) const = 0;
    virtual int modeCount() const = 0;
    virtual JointMode& mode(int index) = 0;
    virtual const JointMode& mode(int index) const = 0;

    /// A new block, with the values of each mode in order: P_n,: = G P_R,:, P_nn = G P_RR G^t + own, R the robot
    /// or another pose. Paper 1, eq. 10-24.
    virtual BlockId augment(BlockKind kind, const std::vector<NewBlock>& by_mode) = 0;
    /// The same values in all modes.
    BlockId augment(BlockKind kind, const NewBlock& block);

    /// Marginalises a block out.
    virtual void remove(BlockId block) = 0;

    /// Every mode j becomes the moment-matched mixture of all modes i with weights mu(i, j), columns summing
    /// to 1. The bank has as many modes afterwards as mu has columns: a column of one weight 1 is a copy of
    /// that mode. In the invariant core each mode's covariance is transported to the mean of the mode with
    /// the largest weight in the mixture, matched there, and the result transported to the mixture's mean.
    virtual void mix(const Eigen::Ref<const Eigen::MatrixXd>& mu) = 0;

    /// Called before detections are linearised. An engine that keeps part of the state away brings what can
    /// be seen from here within reach and may put the rest away (a commit, which the weights are for).
    virtual void attend(const Attention& attention, const ModeWeights& weights) = 0;

    /// Landmarks whose means and covariances are at hand.
    virtual std::vector<BlockId> landmarksWithinReach() const = 0;

    /// The part of the state that is put away. A block given to `activate` is within reach again; it changes
    /// no value of any mode.
    virtual void activate(const std::vector<BlockId>& landmarks) = 0;
    /// Puts landmarks away. With one mode this changes no value. With several, all that is put away (now or
    /// before) keeps the bank's moment-matched distribution given the rest, the same for all modes; means and
    /// covariances of the rest stay each mode's own (doc/maths/compressed_engine.md).
    virtual void commit(const std::vector<BlockId>& landmarks, const ModeWeights& weights) = 0;
};

/// The moment-matched Gaussian of a bank's modes, as `mix` would make it; looks at the bank, keeps nothing.
class CombinedView : public JointView {
  public:
    CombinedView(const JointBank& bank, const ModeWeights& weights);
    BlockVector mean(BlockId block) const override;
    BlockMatrix covariance(BlockId a, BlockId b) const override;
    Eigen::MatrixXd jointCovariance(const std::vector<BlockId>& blocks) const override;

  private:
    /// Mean of a mode minus the reference mode's, over blocks stacked in order.
    Eigen::VectorXd deviation(int mode, const std::vector<BlockId>& blocks) const;

    const JointBank& bank_;
    Eigen::VectorXd weights_;
    int reference_;
};

}  // namespace slamot
