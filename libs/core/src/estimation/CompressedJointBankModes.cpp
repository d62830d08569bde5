// One mode of a CompressedJointBank: the active state as it stands, what is put away by way of the base.
#include <algorithm>

#include "slamot/core/estimation/CompressedJointBank.h"

namespace slamot {

BlockVector CompressedJointBank::Mode::mean(BlockId id) const {
    if (bank->away(id)) {
        const Eigen::VectorXd eta = gaussian.mean()(bank->baseCoordinates());
        return bank->map().mean(id) + bank->map().base(id).transpose() * eta;
    }
    const BlockPlace& block = bank->layout_.at(id);
    return gaussian.mean().segment(block.offset, block.size);
}

Eigen::MatrixXd CompressedJointBank::Mode::dependence(BlockId id) const {
    const int n = bank->layout_.dimension();
    if (bank->away(id)) {
        Eigen::MatrixXd out = Eigen::MatrixXd::Zero(2, n);
        out(Eigen::all, bank->baseCoordinates()) = bank->map().base(id).transpose();
        return out;
    }
    const BlockPlace& block = bank->layout_.at(id);
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(block.size, n);
    out.middleCols(block.offset, block.size).setIdentity();
    return out;
}

BlockMatrix CompressedJointBank::Mode::covariance(BlockId a, BlockId b) const {
    const bool away_a = bank->away(a), away_b = bank->away(b);
    if (!away_a && !away_b) return gaussian.covariance(bank->layout_.at(a), bank->layout_.at(b));
    Eigen::MatrixXd out =
        dependence(a) * (gaussian.lower().selfadjointView<Eigen::Lower>() * dependence(b).transpose());
    if (away_a && away_b) out += bank->map().covariance(a, b);
    return out;
}

Eigen::MatrixXd CompressedJointBank::Mode::jointCovariance(const std::vector<BlockId>& blocks) const {
    if (std::none_of(blocks.begin(), blocks.end(), [&](BlockId id) { return bank->away(id); }))
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
        if (!bank->away(blocks[i])) continue;
        for (std::size_t j = 0; j < blocks.size(); ++j)
            if (bank->away(blocks[j]))
                out.block<2, 2>(offset[i], offset[j]) += bank->map().covariance(blocks[i], blocks[j]);
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
