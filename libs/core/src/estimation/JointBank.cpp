#include "slamot/core/estimation/JointBank.h"

#include "slamot/core/estimation/BlockLayout.h"

namespace slamot {
namespace {

constexpr int heading = 2;

/// d = J dx on the 2-vectors of the stacked blocks that turn with the world, 0 elsewhere.
Eigen::VectorXd turnShift(const JointBank& bank, const std::vector<BlockId>& blocks,
                          const Eigen::VectorXd& dx) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(dx.size());
    int offset = 0;
    for (const BlockId block : blocks) {
        for (int k = 0; k < turningVectors(bank.kind(block)); ++k)
            d.segment<2>(offset + 2 * k) = quarterTurn() * dx.segment<2>(offset + 2 * k);
        offset += static_cast<int>(bank.mode(0).mean(block).size());
    }
    return d;
}

/// P <- D P D^t with D = I + d e_theta^t.
void transport(const Eigen::VectorXd& d, Eigen::MatrixXd& P) {
    const Eigen::VectorXd p = P.col(heading);
    P += d * p.transpose() + p * d.transpose() + p(heading) * d * d.transpose();
}

}  // namespace

BlockId JointBank::augment(BlockKind kind, const NewBlock& block) {
    return augment(kind, std::vector<NewBlock>(static_cast<std::size_t>(modeCount()), block));
}

CombinedView::CombinedView(const JointBank& bank, const ModeWeights& weights)
    : bank_(bank), weights_(weights) {
    weights_.maxCoeff(&reference_);
}

Eigen::VectorXd CombinedView::deviation(int mode, const std::vector<BlockId>& blocks) const {
    std::vector<double> out;
    for (const BlockId block : blocks) {
        BlockVector part = bank_.mode(mode).mean(block) - bank_.mode(reference_).mean(block);
        if (block == robot_block) part(heading) = wrapAngle(part(heading));
        out.insert(out.end(), part.data(), part.data() + part.size());
    }
    return Eigen::Map<Eigen::VectorXd>(out.data(), static_cast<Eigen::Index>(out.size()));
}

BlockVector CombinedView::mean(BlockId block) const {
    BlockVector out = bank_.mode(reference_).mean(block);
    for (int i = 0; i < bank_.modeCount(); ++i)
        if (weights_(i) != 0) out += weights_(i) * deviation(i, {block});
    if (block == robot_block) out(heading) = wrapAngle(out(heading));
    return out;
}

BlockMatrix CombinedView::covariance(BlockId a, BlockId b) const {
    const auto rows = bank_.mode(reference_).mean(a).size(), cols = bank_.mode(reference_).mean(b).size();
    return jointCovariance({a, b}).topRightCorner(rows, cols);
}

Eigen::MatrixXd CombinedView::jointCovariance(const std::vector<BlockId>& asked) const {
    std::vector<BlockId> blocks{robot_block};  // its heading carries the transports
    blocks.insert(blocks.end(), asked.begin(), asked.end());
    const bool invariant = bank_.consistency() == Consistency::invariant;

    Eigen::VectorXd dx = Eigen::VectorXd::Zero(deviation(reference_, blocks).size());
    for (int i = 0; i < bank_.modeCount(); ++i)
        if (weights_(i) != 0) dx += weights_(i) * deviation(i, blocks);
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(dx.size(), dx.size());
    for (int i = 0; i < bank_.modeCount(); ++i) {
        if (weights_(i) == 0) continue;
        const Eigen::VectorXd from_reference = deviation(i, blocks), spread = from_reference - dx;
        Eigen::MatrixXd P_i = bank_.mode(i).jointCovariance(blocks);
        if (invariant) transport(turnShift(bank_, blocks, -from_reference), P_i);
        P += weights_(i) * (P_i + spread * spread.transpose());
    }
    if (invariant) transport(turnShift(bank_, blocks, dx), P);
    return P.bottomRightCorner(P.rows() - 3, P.cols() - 3);
}

}  // namespace slamot
