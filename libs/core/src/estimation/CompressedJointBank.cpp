#include "slamot/core/estimation/CompressedJointBank.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "slamot/core/estimation/CommonConditional.h"
#include "slamot/core/estimation/DenseAlgebra.h"

namespace slamot {

CompressedJointBank::CompressedJointBank(const Vector3& robot, const Matrix3& covariance,
                                         Consistency consistency, int modes,
                                         const ActiveSetParameters& policy, bool background)
    : consistency_(consistency),
      modes_(static_cast<std::size_t>(modes), Mode(*this)),
      map_(consistency == Consistency::invariant),
      policy_(policy),
      worker_(background) {
    augment(BlockKind::robot, NewBlock{robot, {}, covariance});
}

CompressedJointBank::CompressedJointBank(const CompressedJointBank& other)
    : JointBank(other),
      consistency_(other.consistency_),
      layout_(other.layout_),
      base_(other.base_),
      base_dimension_(other.base_dimension_),
      next_id_(other.next_id_),
      modes_(other.modes_),
      away_(other.away_),
      away_count_(other.away_count_),
      map_(other.map()),
      policy_(other.policy_),
      plan_(other.plan_),
      commits_(other.commits_),
      activations_(other.activations_),
      unforeseen_(other.unforeseen_),
      worker_(other.worker_.background()) {
    for (Mode& mode : modes_) mode.bank = this;
    if (plan_) plan_->job = 0;  // map() has waited for it
}

BlockKind CompressedJointBank::kind(BlockId block) const {
    return away(block) ? BlockKind::landmark : layout_.at(block).kind;
}

void CompressedJointBank::setAway(BlockId landmark, bool away) {
    const auto id = static_cast<std::size_t>(landmark);
    if (id >= away_.size()) away_.resize(id + 1);
    away_[id] = away ? 1 : 0;
    away_count_ += away ? 1 : -1;
}

BlockId CompressedJointBank::augment(BlockKind kind, const std::vector<NewBlock>& by_mode) {
    const int from = layout_.dimension() == 0 ? 0 : layout_.at(by_mode.front().from).offset;
    for (std::size_t i = 0; i < modes_.size(); ++i) modes_[i].gaussian.augment(by_mode.at(i), from);
    layout_.append(next_id_, kind, static_cast<int>(by_mode.front().mean.size()));
    return next_id_++;
}

void CompressedJointBank::remove(BlockId id) {
    if (away(id)) {
        plan_.reset();
        worker_.post([this, id] { map_.remove(id); });
        setAway(id, false);
        if (away_count_ == 0) removeBase();
        return;
    }
    const BlockPlace gone = layout_.at(id);
    if (gone.kind == BlockKind::robot) throw std::invalid_argument("the robot cannot leave the joint state");
    for (Mode& mode : modes_) mode.gaussian.remove(gone.offset, gone.size);
    layout_.remove(id);
}

void CompressedJointBank::mix(const Eigen::Ref<const Eigen::MatrixXd>& mu) {
    if (mu.size() == 1) return;
    const auto count = static_cast<std::size_t>(mu.cols());
    mixed_.resize(count);
    std::vector<const BlockGaussian*> modes;
    for (const Mode& mode : modes_) modes.push_back(&mode.gaussian);
    for (std::size_t j = 0; j < count; ++j)
        mixed_[j].setMixture(layout_, modes, mu.col(static_cast<Eigen::Index>(j)), consistency_);
    modes_.resize(count, Mode(*this));
    for (std::size_t j = 0; j < count; ++j) std::swap(modes_[j].gaussian, mixed_[j]);
}

std::vector<int> CompressedJointBank::baseCoordinates() const {
    std::vector<int> out;
    for (const BlockId id : base_) {
        const BlockPlace& block = layout_.at(id);
        for (int k = 0; k < block.size; ++k) out.push_back(block.offset + k);
    }
    return out;
}

void CompressedJointBank::appendBase(int rows) {
    for (Mode& mode : modes_) mode.gaussian.append(rows);
    layout_.append(next_id_, BlockKind::extra, rows, consistency_ == Consistency::invariant ? rows / 2 : 0);
    base_.push_back(next_id_++);
    base_dimension_ += rows;
}

std::shared_ptr<const PassiveMap::Taken> CompressedJointBank::prepare(const std::vector<BlockId>& landmarks) {
    if (plan_) {
        const Plan plan = *std::exchange(plan_, std::nullopt);
        worker_.wait(plan.job);
        if (plan.taken->landmarks == landmarks) return plan.taken;
    }
    const auto taken = std::make_shared<PassiveMap::Taken>();
    worker_.wait(worker_.post([this, taken, landmarks] { *taken = map_.prepare(landmarks); }));
    return taken;
}

void CompressedJointBank::activate(const std::vector<BlockId>& landmarks) {
    std::vector<BlockId> coming;
    for (const BlockId id : landmarks)
        if (away(id)) coming.push_back(id);
    if (coming.empty()) return;
    // Two sensors may have measured one landmark at the same time.
    std::sort(coming.begin(), coming.end());
    coming.erase(std::unique(coming.begin(), coming.end()), coming.end());
    ++activations_;

    // c = c0 + B_c^t beta + e_c. What the base's rows proper, U, do not say of the covariance of e_c with
    // what stays, P_cr0 - U_c^t U_r, becomes base rows gamma, whitened. So e_c has the formal covariances U_c
    // with the rows proper of beta and P_c|^1/2 with those of gamma.
    const std::vector<int> beta = baseCoordinates();
    const auto prepared = prepare(coming);
    const PassiveMap::Taken& taken = *prepared;
    worker_.post([this, prepared] { map_.take(*prepared); });
    const int columns = static_cast<int>(taken.mean.size()), before = layout_.dimension();
    appendBase(taken.new_rows);
    const int gamma = before, c = gamma + taken.new_rows, step = taken.new_rows / columns;
    for (Mode& mode : modes_) {
        BlockGaussian& g = mode.gaussian;
        Eigen::MatrixXd P_beta(static_cast<Eigen::Index>(beta.size()), before);
        for (std::size_t k = 0; k < beta.size(); ++k)
            for (int j = 0; j < before; ++j)
                P_beta(static_cast<Eigen::Index>(k), j) =
                    g.lower()(std::max(beta[k], j), std::min(beta[k], j));
        Eigen::MatrixXd P_c = taken.base.transpose() * P_beta;  // with [a | beta]
        const Eigen::MatrixXd P_cc = taken.covariance + P_c(Eigen::all, beta) * taken.base;
        for (std::size_t k = 0; k < beta.size(); k += static_cast<std::size_t>(step))
            P_c.col(beta[k]) += taken.base.row(static_cast<Eigen::Index>(k)).transpose();
        const Eigen::VectorXd mean = taken.mean + taken.base.transpose() * Eigen::VectorXd(g.mean()(beta));
        g.append(columns);
        g.mean().segment(c, columns) = mean;
        g.lower().block(c, 0, columns, before) = P_c;
        for (int k = 0; k < columns; ++k)
            g.lower().col(gamma + step * k).segment(c, columns) = taken.root.col(k);
        g.lower().block(c, c, columns, columns) = P_cc;
    }
    for (const BlockId id : coming) {
        layout_.append(id, BlockKind::landmark, 2);
        setAway(id, false);
    }
    if (away_count_ == 0) removeBase();
}

void CompressedJointBank::removeBase() {
    for (const BlockId id : base_) {
        const BlockPlace gone = layout_.at(id);
        for (Mode& mode : modes_) mode.gaussian.remove(gone.offset, gone.size);
        layout_.remove(id);
    }
    base_.clear();
    base_dimension_ = 0;
    plan_.reset();
    worker_.post([this] { map_.clear(); });
}

void CompressedJointBank::commit(const std::vector<BlockId>& landmarks, const ModeWeights& weights) {
    if (landmarks.empty() && away_count_ == 0) return;
    ++commits_;
    plan_.reset();
    for (const BlockId id : landmarks)
        if (!away(id)) layout_.setPutAway(id, true);

    // (1), (2) One distribution for all modes, at the merged mean.
    std::vector<BlockGaussian*> modes;
    for (Mode& mode : modes_) modes.push_back(&mode.gaussian);
    const MatchedModes matched = matchModes(layout_, modes, weights, consistency_);
    const Eigen::MatrixXd& P = matched.covariance;

    // (3) What is put away leaves a; the kept rest gives the new base.
    PassiveMap::Commit commit;
    BlockLayout kept_layout;
    std::vector<int> kept, leaving;
    for (const BlockPlace& block : layout_.places()) {
        if (std::find(base_.begin(), base_.end(), block.id) != base_.end()) continue;
        if (block.put_away)
            commit.landmarks.push_back(block.id);
        else
            kept_layout.append(block.id, block.kind, block.size);
        for (int k = 0; k < block.size; ++k) (block.put_away ? leaving : kept).push_back(block.offset + k);
    }
    const std::vector<int> beta = baseCoordinates();
    const SquareRoot root = squareRoot(P(kept, kept));
    commit.Psi = P(beta, beta);
    commit.eta = matched.mean(beta);
    commit.rows = product(root.whitener, P(kept, beta));
    commit.mean = matched.mean(leaving);
    commit.base = product(root.whitener, P(kept, leaving));
    commit.Phi = P(leaving, beta);
    commit.covariance = P(leaving, leaving);
    for (const BlockId id : commit.landmarks) setAway(id, true);
    worker_.post([this, commit = std::move(commit)] { map_.commit(commit); });

    const bool turning = consistency_ == Consistency::invariant;
    layout_ = kept_layout;
    base_.assign(1, next_id_++);
    base_dimension_ = static_cast<int>(kept.size()) * (turning ? 2 : 1);
    layout_.append(base_.front(), BlockKind::extra, base_dimension_, turning ? base_dimension_ / 2 : 0);
    for (std::size_t i = 0; i < modes_.size(); ++i)
        restart(modes_[i].gaussian, kept, root, matched.deviation.col(static_cast<Eigen::Index>(i)));
}

void CompressedJointBank::restart(BlockGaussian& mode, const std::vector<int>& kept, const SquareRoot& merged,
                                  const Eigen::VectorXd& deviation) const {
    const int n_a = static_cast<int>(kept.size()), n = layout_.dimension(), step = (n - n_a) / n_a;
    std::vector<int> proper;  // base coordinates that stand for a itself, not for its turned copy
    for (int k = 0; k < n_a; ++k) proper.push_back(n_a + step * k);

    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    x.head(n_a) = mode.mean()(kept);
    P.topLeftCorner(n_a, n_a) = Eigen::MatrixXd(mode.lower().selfadjointView<Eigen::Lower>())(kept, kept);
    if (modes_.size() == 1) {
        P(proper, Eigen::seqN(0, n_a)) = merged.root.transpose();
        return mode.set(x, P);
    }
    const Eigen::MatrixXd Phi_t = product(merged.whitener, P.topLeftCorner(n_a, n_a));
    P(proper, Eigen::seqN(0, n_a)) = Phi_t;
    P(proper, proper) = product(Phi_t, merged.whitener.transpose());
    P.diagonal()(proper) -= merged.unknown();
    x(proper) = merged.whitener * deviation(kept);
    mode.set(x, P);
    if (consistency_ == Consistency::classic) return;
    // (4) Back to the mode's own mean.
    x.head(n_a) = deviation(kept);
    mode.transport(layout_, x);
}

void CompressedJointBank::attend(const Attention& attention, const ModeWeights& weights) {
    policy_.look(attention);
    Eigen::Index reference = 0;
    weights.maxCoeff(&reference);
    const Mode& mode = modes_[static_cast<std::size_t>(reference)];

    const bool due = policy_.due();
    if (away_count_ > 0 && policy_.range() > 0) {
        const bool planning = !plan_ || (due && !policy_.planHolds());
        // Grouping anew can wait until what is due, or is to be prepared, has been done.
        worker_.post([this, robot = Vector2(mode.gaussian.mean().head<2>()), reach = policy_.range(),
                      busy = due || planning] {
            map_.step();
            map_.follow(robot, reach, busy);
        });
        if (planning) plan(mode);
    }
    if (due) {
        // In comes what was chosen ahead, before what has fallen behind goes.
        if (plan_) {
            worker_.wait(plan_->job);
            activate(std::vector<BlockId>(plan_->taken->landmarks));
        }
        retire(mode, attention.measured, weights);
        policy_.refreshed();
        plan_.reset();
    }
    coming_.clear();
    for (const BlockId id : attention.measured)
        if (away(id)) coming_.push_back(id);
    unforeseen_ += coming_.empty() ? 0 : 1;
    activate(coming_);
}

void CompressedJointBank::plan(const Mode& mode) {
    policy_.planned();
    plan_ = Plan{0, std::make_shared<PassiveMap::Taken>()};
    plan_->job = worker_.post([this, taken = plan_->taken, policy = policy_,
                               eta = Eigen::VectorXd(mode.gaussian.mean()(baseCoordinates()))] {
        std::vector<BlockId> coming;
        map_.forNearPositions(eta, [&](BlockId id, const Vector2& position) {
            if (policy.toActivate(position)) coming.push_back(id);
        });
        std::sort(coming.begin(), coming.end());
        if (!coming.empty()) *taken = map_.prepare(coming);
    });
}

void CompressedJointBank::retire(const Mode& mode, const std::vector<BlockId>& measured,
                                 const ModeWeights& weights) {
    leaving_.clear();
    int active_landmarks = 0;
    for (const BlockPlace& block : layout_.places()) {
        if (block.kind != BlockKind::landmark) continue;
        ++active_landmarks;
        if (std::find(measured.begin(), measured.end(), block.id) == measured.end() &&
            !policy_.toKeep(mode.gaussian.mean().segment<2>(block.offset)))
            leaving_.push_back(block.id);
    }
    if (policy_.worthCommit(activeDimension(), active_landmarks, static_cast<int>(leaving_.size()),
                            base_dimension_))
        commit(leaving_, weights);
}

std::size_t CompressedJointBank::memory() const {
    std::size_t numbers = 0;
    const auto n = static_cast<std::size_t>(layout_.dimension());
    numbers += n * (n + 1) * (modes_.size() + mixed_.size());
    return sizeof(double) * numbers + map().memory();
}

}  // namespace slamot
