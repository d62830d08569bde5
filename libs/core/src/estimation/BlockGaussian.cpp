#include "slamot/core/estimation/BlockGaussian.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>

#include "slamot/core/estimation/DenseAlgebra.h"

namespace slamot {
namespace {

constexpr int heading = 2;  // offset of theta: the robot is the first block

/// d = J dx on the 2-vectors that turn with the world, 0 elsewhere (heading included): D = I + d e_theta^t.
void turnShift(const BlockLayout& layout, const Eigen::Ref<const Eigen::VectorXd>& dx,
               Eigen::Ref<Eigen::VectorXd> d) {
    d.setZero();
    for (const BlockPlace& block : layout.places()) {
        for (int k = 0; k < block.turning; ++k) {
            const int at = block.offset + 2 * k;
            d(at) = -dx(at + 1);
            d(at + 1) = dx(at);
        }
    }
}

}  // namespace

void BlockGaussian::reserve(int dimension) {
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

void BlockGaussian::append(int count) {
    reserve(n_ + count);
    x_.segment(n_, count).setZero();
    P_.block(n_, 0, count, n_ + count).setZero();
    n_ += count;
}

void BlockGaussian::set(const Eigen::Ref<const Eigen::VectorXd>& mean,
                        const Eigen::Ref<const Eigen::MatrixXd>& covariance) {
    n_ = 0;
    append(static_cast<int>(mean.size()));
    x_.head(n_) = mean;
    lower() = covariance;
}

void BlockGaussian::remove(int offset, int count) {
    const int tail = n_ - offset - count, from = offset + count;
    // Every column moves up, and those behind the gap also to the left: forward copies, so overlap does no
    // harm.
    std::copy_n(x_.data() + from, tail, x_.data() + offset);
    for (int j = 0; j < offset; ++j) std::copy_n(&P_(0, j) + from, tail, &P_(0, j) + offset);
    for (int j = 0; j < tail; ++j)
        std::copy_n(&P_(0, from + j) + from + j, tail - j, &P_(0, offset + j) + offset + j);
    n_ -= count;
}

void BlockGaussian::gatherColumns(int first, Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> out) const {
    const int count = static_cast<int>(out.cols());
    out.topRows(first) = P_.block(first, 0, count, first).transpose();
    out.bottomRows(n_ - first) = P_.block(first, first, n_ - first, count);
    for (int j = 1; j < count; ++j)
        for (int i = 0; i < j; ++i) out(first + i, j) = P_(first + j, first + i);
}

void BlockGaussian::scatterColumns(
    int first, const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& columns) {
    const int count = static_cast<int>(columns.cols());
    P_.block(first, 0, count, first) = columns.topRows(first).transpose();
    P_.block(first, first, n_ - first, count) = columns.bottomRows(n_ - first);
}

Eigen::MatrixXd BlockGaussian::jointCovariance(const BlockLayout& layout,
                                               const std::vector<BlockId>& blocks) const {
    int size = 0;
    for (const BlockId id : blocks) size += layout.at(id).size;
    Eigen::MatrixXd out(size, size);
    int row = 0;
    for (const BlockId id_a : blocks) {
        const BlockPlace& a = layout.at(id_a);
        int column = 0;
        for (const BlockId id_b : blocks) {
            const BlockPlace& b = layout.at(id_b);
            out.block(row, column, a.size, b.size) = covariance(a, b);
            column += b.size;
        }
        row += a.size;
    }
    return out;
}

BlockMatrix BlockGaussian::covariance(const BlockPlace& a, const BlockPlace& b) const {
    if (a.offset > b.offset) return P_.block(a.offset, b.offset, a.size, b.size);
    if (a.offset < b.offset) return P_.block(b.offset, a.offset, b.size, a.size).transpose();
    return P_.block(a.offset, a.offset, a.size, a.size).selfadjointView<Eigen::Lower>();
}

void BlockGaussian::augment(const NewBlock& block, int from) {
    const int before = n_, size = static_cast<int>(block.mean.size());
    append(size);
    x_.segment(before, size) = block.mean;
    P_.block(before, before, size, size) = block.own;
    if (before == 0) return;
    auto pose = robot_columns_.topRows(n_);
    gatherColumns(from, pose);
    P_.block(before, 0, size, before).noalias() = block.G * pose.topRows(before).transpose();
    P_.block(before, before, size, size) += P_.block(before, from, size, 3) * block.G.transpose();
}

void BlockGaussian::propagate(const BlockLayout& layout, BlockId id,
                              const Eigen::Ref<const Eigen::VectorXd>& mean,
                              const Eigen::Ref<const Eigen::MatrixXd>& F,
                              const Eigen::Ref<const Eigen::MatrixXd>& Q,
                              const std::vector<Coupling>& couplings) {
    const BlockPlace& b = layout.at(id);
    auto columns = columns_.topLeftCorner(n_, b.size), moved = moved_.topLeftCorner(n_, b.size);
    gatherColumns(b.offset, columns);
    moved.noalias() = columns * F.transpose();
    for (const Coupling& coupling : couplings) {
        const BlockPlace& c = layout.at(coupling.from);
        auto other = columns_.topLeftCorner(n_, c.size);
        gatherColumns(c.offset, other);
        moved.noalias() += other * coupling.F.transpose();
    }
    // The rows of P were taken through the transition; the block's own columns follow.
    BlockMatrix own = F * moved.middleRows(b.offset, b.size);
    for (const Coupling& coupling : couplings) {
        const BlockPlace& c = layout.at(coupling.from);
        own.noalias() += coupling.F * moved.middleRows(c.offset, c.size);
    }
    moved.middleRows(b.offset, b.size) = 0.5 * (own + own.transpose()) + Q;
    scatterColumns(b.offset, moved);
    x_.segment(b.offset, b.size) = mean;
}

void BlockGaussian::reserveBatch(int rows) {
    if (PHt_.rows() < n_ || PHt_.cols() < rows)
        PHt_.resize(std::max(P_.rows(), PHt_.rows()), std::max<Eigen::Index>(rows, PHt_.cols()));
    if (S_.rows() < rows) {
        S_.resize(2 * rows, 2 * rows);
        nu_.resize(2 * rows);
    }
}

BatchLikelihood BlockGaussian::update(const BlockLayout& layout, const std::vector<LinearMeasurement>& batch,
                                      Consistency consistency) {
    constexpr int rows = LinearMeasurement::rows;
    const int m = rows * static_cast<int>(batch.size());
    reserveBatch(m);
    auto S = S_.topLeftCorner(m, m);
    auto nu = nu_.head(m);
    const BatchLikelihood likelihood({S_.data(), m, m, Eigen::OuterStride<>(S_.rows())}, {nu_.data(), m});
    if (m == 0) return likelihood;

    // P H^t: H touches few blocks, so only their columns are looked up.
    auto PHt = PHt_.topLeftCorner(n_, m);
    auto robot_columns = robot_columns_.topRows(n_);
    gatherColumns(0, robot_columns);
    for (std::size_t i = 0; i < batch.size(); ++i) {
        auto out = PHt.middleCols<rows>(rows * static_cast<int>(i));
        out.setZero();
        for (int k = 0; k < batch[i].term_count; ++k) {
            const auto& [id, H] = batch[i].terms[k];
            if (id == robot_block) {
                out.noalias() += robot_columns.leftCols(H.cols()) * H.transpose();
                continue;
            }
            auto columns = columns_.topLeftCorner(n_, H.cols());
            gatherColumns(layout.at(id).offset, columns);
            out.noalias() += columns * H.transpose();
        }
    }

    // S = H P H^t + R = L L^t, of whose lower triangle alone the factor is made.
    for (std::size_t i = 0; i < batch.size(); ++i) {
        const int row = rows * static_cast<int>(i);
        auto out = S.block(row, 0, rows, row + rows);
        out.setZero();
        for (int k = 0; k < batch[i].term_count; ++k) {
            const auto& [id, H] = batch[i].terms[k];
            out.noalias() += H * PHt.block(layout.at(id).offset, 0, H.cols(), row + rows);
        }
        out.middleCols<rows>(row) += batch[i].R;
        nu.segment<rows>(row) = batch[i].residual;
    }
    Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(S);
    if (cholesky.info() != Eigen::Success)
        throw std::domain_error("innovation covariance S is not positive definite");

    // With W = P H^t L^-t and w = L^-1 nu: dx = W w (eq. 46), P -= W W^t (eq. 47).
    solveLowerTransposedFromRight(S, PHt);
    cholesky.matrixL().solveInPlace(nu);
    auto dx = dx_.head(n_);
    dx.noalias() = PHt * nu;
    x_.head(n_) += dx;
    x_(heading) = wrapAngle(x_(heading));
    downdateLower(P_.topLeftCorner(n_, n_), PHt);
    if (consistency == Consistency::invariant) transport(layout, dx);
    return likelihood;
}

void BlockGaussian::transport(const BlockLayout& layout, const Eigen::Ref<const Eigen::VectorXd>& dx) {
    addTransport(layout, *this, dx, 1.0);
}

void BlockGaussian::addTransport(const BlockLayout& layout, const BlockGaussian& from,
                                 const Eigen::Ref<const Eigen::VectorXd>& dx, double weight) {
    // D P D^t = P + d p^t + p d^t + P_tt d d^t with p = P e_theta; as p' = p + P_tt d / 2 it is rank two.
    auto d = shift_.head(n_);
    turnShift(layout, dx, d);
    auto p = robot_columns_.leftCols<1>().topRows(n_);
    from.gatherColumns(heading, p);
    p += 0.5 * from.P_(heading, heading) * d;
    lower().selfadjointView<Eigen::Lower>().rankUpdate(d, p.col(0), weight);
}

void BlockGaussian::deviationFrom(const BlockGaussian& from, Eigen::Ref<Eigen::VectorXd> out) const {
    out = mean() - from.mean();
    out(heading) = wrapAngle(out(heading));
}

void BlockGaussian::setMixture(const BlockLayout& layout, const std::vector<const BlockGaussian*>& modes,
                               const Eigen::Ref<const Eigen::VectorXd>& weights, Consistency consistency) {
    Eigen::Index r = 0;
    weights.maxCoeff(&r);
    const BlockGaussian& reference = *modes[static_cast<std::size_t>(r)];
    n_ = 0;
    append(reference.n_);
    const bool invariant = consistency == Consistency::invariant;

    // dx = sum_i w_i (x_i - x_r); x_ holds it until the end.
    auto dx = x_.head(n_);
    auto deviation = dx_.head(n_);
    for (std::size_t i = 0; i < modes.size(); ++i) {
        if (weights(static_cast<Eigen::Index>(i)) == 0) continue;
        modes[i]->deviationFrom(reference, deviation);
        dx += weights(static_cast<Eigen::Index>(i)) * deviation;
    }
    for (std::size_t i = 0; i < modes.size(); ++i) {
        const double weight = weights(static_cast<Eigen::Index>(i));
        if (weight == 0) continue;
        modes[i]->deviationFrom(reference, deviation);
        for (int j = 0; j < n_; ++j)
            P_.col(j).segment(j, n_ - j) += weight * modes[i]->P_.col(j).segment(j, n_ - j);
        if (invariant) {
            deviation = -deviation;  // from x_i to x_r
            addTransport(layout, *modes[i], deviation, weight);
            deviation = -deviation;
        }
        deviation -= dx;
        lower().selfadjointView<Eigen::Lower>().rankUpdate(deviation, weight);
    }
    if (invariant) transport(layout, dx);
    dx += reference.mean();
    x_(heading) = wrapAngle(x_(heading));
}

}  // namespace slamot
