#include "slamot/core/estimation/DenseJointBank.h"

#include <stdexcept>

#include "slamot/core/estimation/CommonConditional.h"

namespace slamot {

DenseJointBank::DenseJointBank(const Vector3& robot, const Matrix3& covariance, Consistency consistency,
                               int modes)
    : consistency_(consistency), modes_(static_cast<std::size_t>(modes), Mode(*this)) {
    augment(BlockKind::robot, NewBlock{robot, {}, covariance});
}

DenseJointBank::DenseJointBank(const DenseJointBank& other)
    : JointBank(other),
      consistency_(other.consistency_),
      layout_(other.layout_),
      next_id_(other.next_id_),
      modes_(other.modes_) {
    for (Mode& mode : modes_) mode.bank = this;
}

BlockId DenseJointBank::augment(BlockKind kind, const std::vector<NewBlock>& by_mode) {
    const int from = layout_.dimension() == 0 ? 0 : layout_.at(by_mode.front().from).offset;
    for (std::size_t i = 0; i < modes_.size(); ++i) modes_[i].gaussian.augment(by_mode.at(i), from);
    layout_.append(next_id_, kind, static_cast<int>(by_mode.front().mean.size()));
    return next_id_++;
}

void DenseJointBank::remove(BlockId id) {
    const BlockPlace gone = layout_.at(id);
    if (gone.kind == BlockKind::robot) throw std::invalid_argument("the robot cannot leave the joint state");
    for (Mode& mode : modes_) mode.gaussian.remove(gone.offset, gone.size);
    layout_.remove(id);
}

void DenseJointBank::mix(const Eigen::Ref<const Eigen::MatrixXd>& mu) {
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

void DenseJointBank::activate(const std::vector<BlockId>& landmarks) {
    for (const BlockId id : landmarks) layout_.setPutAway(id, false);
}

void DenseJointBank::commit(const std::vector<BlockId>& landmarks, const ModeWeights& weights) {
    for (const BlockId id : landmarks) layout_.setPutAway(id, true);
    if (modes_.size() == 1) return;
    std::vector<BlockGaussian*> modes;
    for (Mode& mode : modes_) modes.push_back(&mode.gaussian);
    shareConditional(layout_, modes, weights, consistency_);
}

BlockVector DenseJointBank::Mode::mean(BlockId id) const {
    const BlockPlace& block = bank->layout_.at(id);
    return gaussian.mean().segment(block.offset, block.size);
}

BlockMatrix DenseJointBank::Mode::covariance(BlockId a, BlockId b) const {
    return gaussian.covariance(bank->layout_.at(a), bank->layout_.at(b));
}

Eigen::MatrixXd DenseJointBank::Mode::jointCovariance(const std::vector<BlockId>& blocks) const {
    return gaussian.jointCovariance(bank->layout_, blocks);
}

void DenseJointBank::Mode::propagate(BlockId block, const Eigen::Ref<const Eigen::VectorXd>& mean,
                                     const Eigen::Ref<const Eigen::MatrixXd>& F,
                                     const Eigen::Ref<const Eigen::MatrixXd>& Q,
                                     const std::vector<Coupling>& couplings) {
    gaussian.propagate(bank->layout_, block, mean, F, Q, couplings);
}

BatchLikelihood DenseJointBank::Mode::update(const std::vector<LinearMeasurement>& batch) {
    return gaussian.update(bank->layout_, batch, bank->consistency_);
}

}  // namespace slamot
