#pragma once
// The bank whose steps cost what is near the sensors, whatever the map (doc/maths/compressed_engine.md).
//
// Landmarks out of reach are put away in a PassiveMap: b = b0 + B^t beta + e. The modes are Gaussians over
// the active state a = [robot | targets | landmarks within reach] and beta, with formal covariance
//
//   [ P_aa  Phi ]        so that  P_ab = Phi B,  P_bb = P_bb0 + B^t Psi B,  b = b0 + B^t eta.
//   [ Phi^t Psi ]
//
// Prediction, update, transport, mixing and new landmarks act on [a | beta] as on any joint state: beta's
// rows are scalars in the classic core and 2-vectors that turn with the world in the invariant one.
// Activation and commit move landmarks between the two.
//
// Between commits a step needs nothing of the map but the landmarks that come within reach, and those are
// chosen and prepared a few metres ahead. So all that is done with the map is a job of a SerialWorker, on
// another thread if there is one for it; who reads the map waits until its jobs are done.
#include <memory>
#include <optional>
#include <vector>

#include "slamot/core/estimation/ActiveSetPolicy.h"
#include "slamot/core/estimation/BlockGaussian.h"
#include "slamot/core/estimation/JointBank.h"
#include "slamot/core/estimation/PassiveMap.h"
#include "slamot/core/estimation/SerialWorker.h"
#include "slamot/core/estimation/SquareRoot.h"

namespace slamot {

class CompressedJointBank : public JointBank {
  public:
    /// `background`: the map is worked on by a thread of its own, with the same results to the bit.
    CompressedJointBank(const Vector3& robot, const Matrix3& covariance, Consistency consistency,
                        int modes = 1, const ActiveSetParameters& policy = {}, bool background = false);
    CompressedJointBank(const CompressedJointBank& other);
    CompressedJointBank& operator=(const CompressedJointBank&) = delete;

    using JointBank::augment;
    std::unique_ptr<JointBank> clone() const override { return std::make_unique<CompressedJointBank>(*this); }
    Consistency consistency() const override { return consistency_; }
    int dimension() const override { return activeDimension() + 2 * away_count_; }
    BlockKind kind(BlockId block) const override;
    int modeCount() const override { return static_cast<int>(modes_.size()); }
    JointMode& mode(int index) override { return modes_.at(static_cast<std::size_t>(index)); }
    const JointMode& mode(int index) const override { return modes_.at(static_cast<std::size_t>(index)); }

    BlockId augment(BlockKind kind, const std::vector<NewBlock>& by_mode) override;
    void remove(BlockId block) override;
    void mix(const Eigen::Ref<const Eigen::MatrixXd>& mu) override;
    void attend(const Attention& attention, const ModeWeights& weights) override;
    std::vector<BlockId> landmarksWithinReach() const override { return layout_.blocks(BlockKind::landmark); }
    void activate(const std::vector<BlockId>& landmarks) override;
    void commit(const std::vector<BlockId>& landmarks, const ModeWeights& weights) override;

    bool active(BlockId block) const { return layout_.contains(block); }
    int activeDimension() const { return layout_.dimension() - base_dimension_; }
    /// Waits for what is being done with it.
    const PassiveMap& map() const {
        worker_.wait();
        return map_;
    }
    /// Bytes of all modes and of what is put away, work space of the modes left out.
    std::size_t memory() const;
    std::int64_t commits() const { return commits_; }
    std::int64_t activations() const { return activations_; }
    /// Of these, activations of what was measured before it was within reach: the step had to wait for it.
    std::int64_t unforeseen() const { return unforeseen_; }

  private:
    class Mode : public JointMode {
      public:
        explicit Mode(const CompressedJointBank& owner) : bank(&owner) {}
        BlockVector mean(BlockId block) const override;
        BlockMatrix covariance(BlockId a, BlockId b) const override;
        Eigen::MatrixXd jointCovariance(const std::vector<BlockId>& blocks) const override;
        void propagate(BlockId block, const Eigen::Ref<const Eigen::VectorXd>& mean,
                       const Eigen::Ref<const Eigen::MatrixXd>& F, const Eigen::Ref<const Eigen::MatrixXd>& Q,
                       const std::vector<Coupling>& couplings) override;
        BatchLikelihood update(const std::vector<LinearMeasurement>& batch) override;

        /// How the block depends on [a | beta], size x n.
        Eigen::MatrixXd dependence(BlockId block) const;

        const CompressedJointBank* bank;
        BlockGaussian gaussian;
    };

    /// What is to be activated next. The result is there when the job is done, and holds until the map
    /// changes.
    struct Plan {
        SerialWorker::Ticket job = 0;
        std::shared_ptr<PassiveMap::Taken> taken;
    };

    bool away(BlockId block) const {
        return block >= 0 && block < static_cast<BlockId>(away_.size()) &&
               away_[static_cast<std::size_t>(block)] != 0;
    }
    void setAway(BlockId landmark, bool away);
    /// Chooses what to activate next.
    void plan(const Mode& mode);
    /// Prepares landmarks that are away, and waits for it.
    std::shared_ptr<const PassiveMap::Taken> prepare(const std::vector<BlockId>& landmarks);
    /// Offsets of beta's coordinates, in the order of the base's rows.
    std::vector<int> baseCoordinates() const;
    void appendBase(int rows);
    /// Marginalises beta out, when nothing is away.
    void removeBase();
    /// Commits the landmarks out of reach, if they are worth it.
    void retire(const Mode& mode, const std::vector<BlockId>& measured, const ModeWeights& weights);
    /// A mode at the start of a new base: P_aa and a of its own, b given a as all modes have it. `merged` is
    /// of the modes' common P_aa, `deviation` of the mode's mean from the common one.
    void restart(BlockGaussian& mode, const std::vector<int>& kept, const SquareRoot& merged,
                 const Eigen::VectorXd& deviation) const;

    Consistency consistency_;
    BlockLayout layout_;         ///< of [a | beta]
    std::vector<BlockId> base_;  ///< beta's blocks, in the order of the base's rows
    int base_dimension_ = 0;
    BlockId next_id_ = 0;
    std::vector<Mode> modes_;
    std::vector<BlockGaussian> mixed_;  ///< where mixing works
    std::vector<char> away_;            ///< by block: what is in the map once all jobs are done
    int away_count_ = 0;
    PassiveMap map_;  ///< the worker's
    ActiveSetPolicy policy_;
    std::optional<Plan> plan_;
    std::int64_t commits_ = 0, activations_ = 0, unforeseen_ = 0;
    std::vector<BlockId> leaving_, coming_;  ///< work space
    SerialWorker worker_;                    ///< the first to go: its jobs use what is above
};

}  // namespace slamot
