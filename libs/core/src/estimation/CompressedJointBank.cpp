#include "slamot/core/estimation/CompressedJointBank.h"

#include <algorithm>
#include <stdexcept>

#include "slamot/core/estimation/CommonConditional.h"
#include "slamot/core/estimation/DenseAlgebra.h"

namespace slamot {

CompressedJointBank::CompressedJointBank(const Vector3& robot, const Matrix3& covariance,
                                         Consistency consistency, int modes,
                                         const ActiveSetParameters& policy)
    : consistency_(consistency),
      modes_(static_cast<std::size_t>(modes), Mode(*this)),
      map_(consistency == Consistency::invariant),
      policy_(policy) {
    augment(BlockKind::robot, NewBlock{robot, {}, covariance});
}

CompressedJointBank::CompressedJointBank(const CompressedJointBank& other)
    : JointBank(other),
      consistency_(other.consistency_),
      layout_(other.layout_),
      base_(other.base_),
      next_id_(other.next_id_),
      modes_(other.modes_),
      map_(other.map_),
      policy_(other.policy_),
      commits_(other.commits_),
      activations_(other.activations_) {
    for (Mode& mode : modes_) mode.bank = this;
}

BlockKind CompressedJointBank::kind(BlockId block) const {
    return map_.contains(block) ? BlockKind::landmark : layout_.at(block).kind;
}

BlockId CompressedJointBank::augment(BlockKind kind, const std::vector<NewBlock>& by_mode) {
    const int from = layout_.dimension() == 0 ? 0 : layout_.at(by_mode.front().from).offset;
    for (std::size_t i = 0; i < modes_.size(); ++i) modes_[i].gaussian.augment(by_mode.at(i), from);
    layout_.append(next_id_, kind, static_cast<int>(by_mode.front().mean.size()));
    return next_id_++;
}

void CompressedJointBank::remove(BlockId id) {
    if (map_.contains(id)) {
        map_.remove(id);
        if (map_.size() == 0) removeBase();
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
}

void CompressedJointBank::activate(const std::vector<BlockId>& landmarks) {
    std::vector<BlockId> away;
    for (const BlockId id : landmarks)
        if (map_.contains(id)) away.push_back(id);
    if (away.empty()) return;
    // Two sensors may have measured one landmark at the same time.
    std::sort(away.begin(), away.end());
    away.erase(std::unique(away.begin(), away.end()), away.end());
    ++activations_;

    // c = c0 + B_c^t beta + e_c. What the base's rows proper, U, do not say of the covariance of e_c with
    // what stays, P_cr0 - U_c^t U_r, becomes base rows gamma, whitened. So e_c has the formal covariances U_c
    // with the rows proper of beta and P_c|^1/2 with those of gamma.
    const std::vector<int> beta = baseCoordinates();
    const PassiveMap::Taken taken = map_.take(away);
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
    for (const BlockId id : away) layout_.append(id, BlockKind::landmark, 2);
    if (map_.size() == 0) removeBase();
}

void CompressedJointBank::removeBase() {
    for (const BlockId id : base_) {
        const BlockPlace gone = layout_.at(id);
        for (Mode& mode : modes_) mode.gaussian.remove(gone.offset, gone.size);
        layout_.remove(id);
    }
    base_.clear();
    map_.clear();
}

void CompressedJointBank::commit(const std::vector<BlockId>& landmarks, const ModeWeights& weights) {
    if (landmarks.empty() && map_.size() == 0) return;
    ++commits_;
    for (const BlockId id : landmarks)
        if (!map_.contains(id)) layout_.setPutAway(id, true);

    // (1), (2) One distribution for all modes, at the merged mean.
    std::vector<BlockGaussian*> modes;
    for (Mode& mode : modes_) modes.push_back(&mode.gaussian);
    const MatchedModes matched = matchModes(layout_, modes, weights, consistency_);
    const Eigen::MatrixXd& P = matched.covariance;

    // (3) What is put away leaves a; the kept rest gives the new base.
    PassiveMap::Commit commit;
    BlockLayout kept_layout;
    std::vector<int> kept, away;
    for (const BlockPlace& block : layout_.places()) {
        if (std::find(base_.begin(), base_.end(), block.id) != base_.end()) continue;
        if (block.put_away)
            commit.landmarks.push_back(block.id);
        else
            kept_layout.append(block.id, block.kind, block.size);
        for (int k = 0; k < block.size; ++k) (block.put_away ? away : kept).push_back(block.offset + k);
    }
    const std::vector<int> beta = baseCoordinates();
    const SquareRoot root = squareRoot(P(kept, kept));
    commit.Psi = P(beta, beta);
    commit.eta = matched.mean(beta);
    commit.rows = product(root.whitener, P(kept, beta));
    commit.mean = matched.mean(away);
    commit.base = product(root.whitener, P(kept, away));
    commit.Phi = P(away, beta);
    commit.covariance = P(away, away);
    map_.commit(commit);

    layout_ = kept_layout;
    base_.assign(1, next_id_++);
    const int q = map_.baseDimension();
    layout_.append(base_.front(), BlockKind::extra, q, consistency_ == Consistency::invariant ? q / 2 : 0);
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
    map_.step();
    policy_.look(attention);
    Eigen::Index reference = 0;
    weights.maxCoeff(&reference);
    const Mode& mode = modes_[static_cast<std::size_t>(reference)];

    coming_.clear();
    for (const BlockId id : attention.measured)
        if (map_.contains(id)) coming_.push_back(id);
    const bool due = policy_.due();
    // Out goes what has fallen behind, before what has come close joins.
    if (due) retire(mode, attention.measured, weights);
    if (policy_.range() > 0) map_.follow(mode.gaussian.mean().head<2>(), policy_.range(), due);
    if (due) {
        if (map_.size() > 0) {
            const Eigen::VectorXd eta = mode.gaussian.mean()(baseCoordinates());
            map_.forNearPositions(eta, [&](BlockId id, const Vector2& position) {
                if (policy_.toActivate(position) &&
                    std::find(coming_.begin(), coming_.end(), id) == coming_.end())
                    coming_.push_back(id);
            });
        }
        policy_.refreshed();
    }
    activate(coming_);
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
                            map_.baseDimension()))
        commit(leaving_, weights);
}

std::size_t CompressedJointBank::memory() const {
    std::size_t numbers = 0;
    const auto n = static_cast<std::size_t>(layout_.dimension());
    numbers += n * (n + 1) * (modes_.size() + mixed_.size());
    return sizeof(double) * numbers + map_.memory();
}

BlockVector CompressedJointBank::Mode::mean(BlockId id) const {
    if (bank->map_.contains(id)) {
        const Eigen::VectorXd eta = gaussian.mean()(bank->baseCoordinates());
        return bank->map_.mean(id) + bank->map_.base(id).transpose() * eta;
    }
    const BlockPlace& block = bank->layout_.at(id);
    return gaussian.mean().segment(block.offset, block.size);
}

Eigen::MatrixXd CompressedJointBank::Mode::dependence(BlockId id) const {
    const int n = bank->layout_.dimension();
    if (bank->map_.contains(id)) {
        Eigen::MatrixXd out = Eigen::MatrixXd::Zero(2, n);
        out(Eigen::all, bank->baseCoordinates()) = bank->map_.base(id).transpose();
        return out;
    }
    const BlockPlace& block = bank->layout_.at(id);
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(block.size, n);
    out.middleCols(block.offset, block.size).setIdentity();
    return out;
}

BlockMatrix CompressedJointBank::Mode::covariance(BlockId a, BlockId b) const {
    const PassiveMap& map = bank->map_;
    const bool away_a = map.contains(a), away_b = map.contains(b);
    if (!away_a && !away_b) return gaussian.covariance(bank->layout_.at(a), bank->layout_.at(b));
    Eigen::MatrixXd out =
        dependence(a) * (gaussian.lower().selfadjointView<Eigen::Lower>() * dependence(b).transpose());
    if (away_a && away_b) out += map.covariance(a, b);
    return out;
}

Eigen::MatrixXd CompressedJointBank::Mode::jointCovariance(const std::vector<BlockId>& blocks) const {
    if (std::none_of(blocks.begin(), blocks.end(), [&](BlockId id) { return bank->map_.contains(id); }))
        return gaussian.jointCovariance(bank->layout_, blocks);
    const int n = bank->layout_.dimension();
    std::vector<Eigen::MatrixXd> parts;
    int size = 0;
    for (const BlockId id : blocks) {
        parts.push_back(dependence(id));
        size += static_cast<int>(parts.back().rows());
    }
    Eigen::MatrixXd T(size, n);
    std::vector<int> offset;
    int row = 0;
    for (const Eigen::MatrixXd& part : parts) {
        offset.push_back(row);
        T.middleRows(row, part.rows()) = part;
        row += static_cast<int>(part.rows());
    }
    Eigen::MatrixXd out = T * (gaussian.lower().selfadjointView<Eigen::Lower>() * T.transpose());
    out = 0.5 * (out + out.transpose()).eval();
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (!bank->map_.contains(blocks[i])) continue;
        for (std::size_t j = 0; j < blocks.size(); ++j)
            if (bank->map_.contains(blocks[j]))
                out.block<2, 2>(offset[i], offset[j]) += bank->map_.covariance(blocks[i], blocks[j]);
    }
    return out;
}

void CompressedJointBank::Mode::propagate(BlockId block, const Eigen::Ref<const Eigen::VectorXd>& mean,
                                          const Eigen::Ref<const Eigen::MatrixXd>& F,
                                          const Eigen::Ref<const Eigen::MatrixXd>& Q,
                                          const std::vector<Coupling>& couplings) {
    gaussian.propagate(bank->layout_, block, mean, F, Q, couplings);
}

BatchLikelihood CompressedJointBank::Mode::update(const std::vector<LinearMeasurement>& batch) {
    return gaussian.update(bank->layout_, batch, bank->consistency_);
}

}  // namespace slamot
