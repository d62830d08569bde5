#pragma once
// The joint state as the textbook writes it: full matrices, nothing clever. What engines of joint states
// are held to.
#include <Eigen/Dense>
#include <map>
#include <vector>

#include "slamot/core/estimation/LinearMeasurement.h"

namespace slamot::test {

class FullMatrixState {
  public:
    struct Block {
        BlockKind kind;
        int size;
    };

    FullMatrixState(const Vector3& robot, const Matrix3& covariance) : x(robot), P(covariance) {
        blocks[robot_block] = {BlockKind::robot, 3};
    }

    int offset(BlockId id) const {
        int at = 0;
        for (const auto& [other, block] : blocks) {
            if (other == id) return at;
            at += block.size;
        }
        return -1;
    }

    void propagate(BlockId id, const Eigen::VectorXd& mean, const Eigen::MatrixXd& F,
                   const Eigen::MatrixXd& Q, const std::vector<Coupling>& couplings) {
        const int size = blocks.at(id).size, at = offset(id);
        Eigen::MatrixXd A = Eigen::MatrixXd::Identity(x.size(), x.size());
        A.block(at, at, size, size) = F;
        for (const Coupling& c : couplings) A.block(at, offset(c.from), size, c.F.cols()) = c.F;
        P = A * P * A.transpose();
        P.block(at, at, size, size) += Q;
        x.segment(at, size) = mean;
    }

    void augment(BlockId id, BlockKind kind, const Eigen::VectorXd& mean, const Eigen::MatrixXd& G,
                 const Eigen::MatrixXd& own) {
        const int n = static_cast<int>(x.size()), size = static_cast<int>(mean.size());
        Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + size, n);
        A.topRows(n).setIdentity();
        A.bottomLeftCorner(size, 3) = G;
        P = A * P * A.transpose();
        P.bottomRightCorner(size, size) += own;
        x.conservativeResize(n + size);
        x.tail(size) = mean;
        blocks[id] = {kind, size};
    }

    void remove(BlockId id) {
        const int size = blocks.at(id).size, at = offset(id), n = static_cast<int>(x.size());
        Eigen::MatrixXd keep = Eigen::MatrixXd::Zero(n - size, n);
        for (int i = 0; i < n - size; ++i) keep(i, i < at ? i : i + size) = 1;
        x = keep * x;
        P = keep * P * keep.transpose();
        blocks.erase(id);
    }

    void update(const std::vector<LinearMeasurement>& batch, Consistency consistency) {
        const int n = static_cast<int>(x.size()), m = 2 * static_cast<int>(batch.size());
        if (m == 0) return;
        Eigen::MatrixXd H = Eigen::MatrixXd::Zero(m, n), R = Eigen::MatrixXd::Zero(m, m);
        Eigen::VectorXd nu(m);
        for (int i = 0; i < m / 2; ++i) {
            for (int k = 0; k < batch[i].term_count; ++k) {
                const auto& term = batch[i].terms[k];
                H.block(2 * i, offset(term.block), 2, term.H.cols()) = term.H;
            }
            R.block<2, 2>(2 * i, 2 * i) = batch[i].R;
            nu.segment<2>(2 * i) = batch[i].residual;
        }
        const Eigen::MatrixXd K = P * H.transpose() * (H * P * H.transpose() + R).inverse();
        const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n) - K * H;
        const Eigen::VectorXd dx = K * nu;
        x += dx;
        x(2) = wrapAngle(x(2));
        P = A * P * A.transpose() + K * R * K.transpose();  // Joseph
        if (consistency == Consistency::classic) return;

        Eigen::MatrixXd D = Eigen::MatrixXd::Identity(n, n);
        for (const auto& [id, block] : blocks) {
            const int vectors = block.kind == BlockKind::extra ? 0 : block.kind == BlockKind::target ? 3 : 1;
            for (int k = 0; k < vectors; ++k) {
                const int at = offset(id) + 2 * k;
                D.block<2, 1>(at, 2) += quarterTurn() * dx.segment<2>(at);
            }
        }
        P = D * P * D.transpose();
    }

    Eigen::VectorXd x;
    Eigen::MatrixXd P;
    std::map<BlockId, Block> blocks;  ///< in the order of their ids, which is that of the state
};

}  // namespace slamot::test
