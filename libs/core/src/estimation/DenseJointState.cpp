#include "slamot/core/estimation/DenseJointState.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <stdexcept>

#include "slamot/core/estimation/DenseAlgebra.h"

namespace slamot {
namespace {

/// The 2-vectors of a block that turn with the world, as a count from its start.
int turningVectors(BlockKind kind) {
    switch (kind) {
        case BlockKind::robot: return 1;
        case BlockKind::target: return 3;
        case BlockKind::landmark: return 1;
        case BlockKind::extra: return 0;
    }
    return 0;
}

constexpr int heading = 2;  // offset of theta: the robot is the first block

}  // namespace

DenseJointState::DenseJointState(const Vector3& robot, const Matrix3& covariance) {
    append(BlockKind::robot, 3);
    x_.head<3>() = robot;
    P_.topLeftCorner<3, 3>() = covariance;
}

const DenseJointState::Block& DenseJointState::block(BlockId id) const {
    if (id < 0 || id >= static_cast<int>(blocks_.size()) || blocks_[id].offset < 0)
        throw std::out_of_range("no such block in the joint state");
    return blocks_[id];
}

void DenseJointState::reserve(int dimension) {
    if (dimension <= P_.rows()) return;
    const int capacity = std::max(dimension, 2 * static_cast<int>(P_.rows()));
    Eigen::MatrixXd larger = Eigen::MatrixXd::Zero(capacity, capacity);
    larger.topLeftCorner(n_, n_) = P_.topLeftCorner(n_, n_);
    P_.swap(larger);
    x_.conservativeResize(capacity);
    for (Eigen::VectorXd* vector : {&dx_, &shift_}) vector->resize(capacity);
    robot_columns_.resize(capacity, 3);
    columns_.resize(capacity, 6);
    moved_.resize(capacity, 6);
}

BlockId DenseJointState::append(BlockKind kind, int size) {
    reserve(n_ + size);
    blocks_.push_back({kind, n_, size});
    n_ += size;
    return static_cast<BlockId>(blocks_.size()) - 1;
}

template <class Out>
void DenseJointState::gatherColumns(int first, int count, Out&& out) const {
    out.topRows(first) = P_.block(first, 0, count, first).transpose();
    out.bottomRows(n_ - first) = P_.block(first, first, n_ - first, count);
    for (int j = 1; j < count; ++j)
        for (int i = 0; i < j; ++i) out(first + i, j) = P_(first + j, first + i);
}

template <class In>
void DenseJointState::scatterColumns(int first, const In& columns) {
    const int count = static_cast<int>(columns.cols());
    P_.block(first, 0, count, first) = columns.topRows(first).transpose();
    P_.block(first, first, n_ - first, count) = columns.bottomRows(n_ - first);
}

BlockVector DenseJointState::mean(BlockId id) const {
    const Block& b = block(id);
    return x_.segment(b.offset, b.size);
}

BlockMatrix DenseJointState::covariance(BlockId a, BlockId b) const {
    const Block &A = block(a), &B = block(b);
    if (A.offset > B.offset) return P_.block(A.offset, B.offset, A.size, B.size);
    if (A.offset < B.offset) return P_.block(B.offset, A.offset, B.size, A.size).transpose();
    return P_.block(A.offset, A.offset, A.size, A.size).selfadjointView<Eigen::Lower>();
}

Eigen::MatrixXd DenseJointState::jointCovariance(const std::vector<BlockId>& blocks) const {
    int size = 0;
    for (const BlockId id : blocks) size += block(id).size;
    Eigen::MatrixXd out(size, size);
    int row = 0;
    for (const BlockId a : blocks) {
        int column = 0;
        for (const BlockId b : blocks) {
            out.block(row, column, block(a).size, block(b).size) = covariance(a, b);
            column += block(b).size;
        }
        row += block(a).size;
    }
    return out;
}

void DenseJointState::propagate(BlockId id, const Eigen::Ref<const Eigen::VectorXd>& mean,
                                const Eigen::Ref<const Eigen::MatrixXd>& F,
                                const Eigen::Ref<const Eigen::MatrixXd>& Q,
                                const std::vector<Coupling>& couplings) {
    const Block b = block(id);
    auto columns = columns_.topLeftCorner(n_, b.size), moved = moved_.topLeftCorner(n_, b.size);
    gatherColumns(b.offset, b.size, columns);
    moved.noalias() = columns * F.transpose();
    for (const Coupling& coupling : couplings) {
        const Block& c = block(coupling.from);
        auto other = columns_.topLeftCorner(n_, c.size);
        gatherColumns(c.offset, c.size, other);
        moved.noalias() += other * coupling.F.transpose();
    }
    // The rows of P were taken through the transition; the block's own columns follow.
    BlockMatrix own = F * moved.middleRows(b.offset, b.size);
    for (const Coupling& coupling : couplings) {
        const Block& c = block(coupling.from);
        own.noalias() += coupling.F * moved.middleRows(c.offset, c.size);
    }
    moved.middleRows(b.offset, b.size) = 0.5 * (own + own.transpose()) + Q;
    scatterColumns(b.offset, moved);
    x_.segment(b.offset, b.size) = mean;
}

BlockId DenseJointState::augment(BlockKind kind, const Eigen::Ref<const Eigen::VectorXd>& mean,
                                 const Eigen::Ref<const Eigen::MatrixXd>& G,
                                 const Eigen::Ref<const Eigen::MatrixXd>& own) {
    const int size = static_cast<int>(mean.size()), before = n_;
    reserve(before + size);
    auto robot = robot_columns_.topRows(before);
    gatherColumns(0, 3, robot);
    const BlockId id = append(kind, size);
    x_.segment(before, size) = mean;
    P_.block(before, 0, size, before).noalias() = G * robot.transpose();
    P_.block(before, before, size, size) = P_.block(before, 0, size, 3) * G.transpose() + own;
    return id;
}

void DenseJointState::remove(BlockId id) {
    const Block gone = block(id);
    if (gone.kind == BlockKind::robot) throw std::invalid_argument("the robot cannot leave the joint state");
    const int tail = n_ - gone.offset - gone.size, from = gone.offset + gone.size;
    // Copies through temporaries: source and destination overlap.
    x_.segment(gone.offset, tail) = x_.segment(from, tail).eval();
    P_.block(gone.offset, 0, tail, gone.offset) = P_.block(from, 0, tail, gone.offset).eval();
    P_.block(gone.offset, gone.offset, tail, tail) = P_.block(from, from, tail, tail).eval();
    n_ -= gone.size;
    for (Block& b : blocks_)
        if (b.offset > gone.offset) b.offset -= gone.size;
    blocks_[id].offset = -1;
}

void DenseJointState::update(const std::vector<LinearMeasurement>& batch, Consistency consistency) {
    const int m = 2 * static_cast<int>(batch.size());
    if (m == 0) return;
    if (PHt_.rows() < n_ || PHt_.cols() < m)
        PHt_.resize(std::max<Eigen::Index>(P_.rows(), PHt_.rows()), std::max<Eigen::Index>(m, PHt_.cols()));
    if (S_.rows() < m) {
        S_.resize(2 * m, 2 * m);
        nu_.resize(2 * m);
    }

    // P H^t: H touches few blocks, so only their columns are looked up.
    auto PHt = PHt_.topLeftCorner(n_, m);
    auto robot_columns = robot_columns_.topRows(n_);
    gatherColumns(0, 3, robot_columns);
    for (std::size_t i = 0; i < batch.size(); ++i) {
        auto out = PHt.middleCols<2>(2 * static_cast<int>(i));
        out.setZero();
        for (int k = 0; k < batch[i].term_count; ++k) {
            const auto& [id, H] = batch[i].terms[k];
            if (id == robot_block) {
                out.noalias() += robot_columns.leftCols(H.cols()) * H.transpose();
                continue;
            }
            auto columns = columns_.topLeftCorner(n_, H.cols());
            gatherColumns(block(id).offset, static_cast<int>(H.cols()), columns);
            out.noalias() += columns * H.transpose();
        }
    }

    // S = H P H^t + R = L L^t
    auto S = S_.topLeftCorner(m, m);
    auto nu = nu_.head(m);
    for (std::size_t i = 0; i < batch.size(); ++i) {
        const int row = 2 * static_cast<int>(i);
        auto out = S.middleRows<2>(row);
        out.setZero();
        for (int k = 0; k < batch[i].term_count; ++k) {
            const auto& [id, H] = batch[i].terms[k];
            out.noalias() += H * PHt.middleRows(block(id).offset, H.cols());
        }
        out.middleCols<2>(row) += batch[i].R;
        nu.segment<2>(row) = batch[i].residual;
    }
    Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(S);
    if (cholesky.info() != Eigen::Success)
        throw std::domain_error("innovation covariance S is not positive definite");

    // With W = P H^t L^-t: dx = W L^-1 nu (eq. 46), P -= W W^t (eq. 47).
    solveLowerTransposedFromRight(S, PHt);
    cholesky.matrixL().solveInPlace(nu);
    auto dx = dx_.head(n_);
    dx.noalias() = PHt * nu;
    x_.head(n_) += dx;
    x_(heading) = wrapAngle(x_(heading));
    downdateLower(P_.topLeftCorner(n_, n_), PHt);
    if (consistency == Consistency::invariant) transport(dx);
}

void DenseJointState::transport(const Eigen::Ref<const Eigen::VectorXd>& dx) {
    // D = I + d e_theta^t with d = J (p+ - p-) on turning 2-vectors, 0 elsewhere (theta included).
    auto d = shift_.head(n_);
    d.setZero();
    for (const Block& b : blocks_) {
        if (b.offset < 0) continue;
        for (int k = 0; k < turningVectors(b.kind); ++k) {
            const int at = b.offset + 2 * k;
            d(at) = -dx(at + 1);
            d(at + 1) = dx(at);
        }
    }
    // D P D^t = P + d p^t + p d^t + P_tt d d^t with p = P e_theta; as p' = p + P_tt d / 2 it is rank two.
    auto p = robot_columns_.col(0).head(n_);
    gatherColumns(heading, 1, p);
    p += 0.5 * P_(heading, heading) * d;
    P_.topLeftCorner(n_, n_).selfadjointView<Eigen::Lower>().rankUpdate(d, p, 1.0);
}

}  // namespace slamot
