#include "slamot/core/estimation/TurningBasis.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "slamot/core/estimation/DenseAlgebra.h"

namespace slamot {
namespace {

/// Real form of a complex matrix that acts on pairs of rows (y, i y).
Eigen::MatrixXd onPairs(const Eigen::MatrixXcd& T) {
    Eigen::MatrixXd out(2 * T.rows(), 2 * T.cols());
    for (Eigen::Index j = 0; j < T.cols(); ++j)
        for (Eigen::Index i = 0; i < T.rows(); ++i)
            out.block<2, 2>(2 * i, 2 * j) << T(i, j).real(), T(i, j).imag(), -T(i, j).imag(), T(i, j).real();
    return out;
}

/// A B^t summed over parts, for rows in pairs: the first row of each pair says all.
Eigen::MatrixXd gram(const CutRowsView& A, const CutRowsView& B) {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(A.front()->rows() / 2, B.front()->rows());
    for (std::size_t t = 0; t < A.size(); ++t) out += productTransposed(firstOfPairs(*A[t]), *B[t]);
    return withTurnedRows(out);
}

/// The complex matrix behind one that is linear over the quarter turn.
Eigen::MatrixXcd ofPairs(const Eigen::MatrixXd& M) {
    Eigen::MatrixXcd out(M.rows() / 2, M.cols() / 2);
    for (Eigen::Index j = 0; j < out.cols(); ++j)
        for (Eigen::Index i = 0; i < out.rows(); ++i) out(i, j) = {M(2 * i, 2 * j), M(2 * i, 2 * j + 1)};
    return out;
}

CutRowsView viewOf(const CutRows& rows) {
    CutRowsView out;
    for (const Eigen::MatrixXd& part : rows) out.push_back(&part);
    return out;
}

/// T V, where T is closed under the quarter turn: of each pair the first row is made and turned, also where
/// scaling up brings rounding forward.
CutRows transformed(const Eigen::MatrixXd& T, const CutRowsView& V) {
    const Eigen::MatrixXd first = firstOfPairs(T);
    CutRows out;
    for (const Eigen::MatrixXd* part : V) out.push_back(withTurnedRows(product(first, *part)));
    return out;
}

/// Eigenvalues above this part of the largest have eigenvectors worth their name.
constexpr double well_known = 1e-8;

/// Of directions with V: taken out, it changes neither their length nor how orthogonal they are to one
/// another beyond what orthonormal means here, half the digits.
constexpr double small_overlap = 1e-5;

/// What the Gram matrix of some rows says of their directions.
struct Directions {
    Eigen::MatrixXd unit;     ///< unit times the rows is orthonormal: directions that are well known
    Eigen::MatrixXd weights;  ///< rows = weights unit rows + rest
    Eigen::MatrixXd others;   ///< the rows' combinations that make up the rest
    double longest;

    explicit Directions(const Eigen::MatrixXd& gram) {
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(ofPairs(gram));
        const Eigen::VectorXd& squared = solver.eigenvalues();
        longest = std::sqrt(std::max(0.0, squared(squared.size() - 1)));
        const auto few = (squared.array() <= well_known * longest * longest).count(),
                   many = squared.size() - few;
        const Eigen::VectorXd length = squared.tail(many).cwiseSqrt();
        const Eigen::MatrixXcd E = solver.eigenvectors().rightCols(many);
        unit = onPairs(length.cwiseInverse().asDiagonal() * E.adjoint());
        weights = onPairs(E * length.asDiagonal());
        others = onPairs(solver.eigenvectors().leftCols(few));
    }
};

}  // namespace

Eigen::MatrixXd turnedRows(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
    Eigen::MatrixXd out(rows.rows(), rows.cols());
    for (Eigen::Index j = 0; j + 1 < rows.cols(); j += 2) {
        out.col(j) = -rows.col(j + 1);
        out.col(j + 1) = rows.col(j);
    }
    return out;
}

Eigen::MatrixXd withTurnedRows(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
    Eigen::MatrixXd out(2 * rows.rows(), rows.cols());
    for (Eigen::Index j = 0; j + 1 < rows.cols(); j += 2)
        for (Eigen::Index i = 0; i < rows.rows(); ++i)
            out.block<2, 2>(2 * i, j) << rows(i, j), rows(i, j + 1), -rows(i, j + 1), rows(i, j);
    return out;
}

Eigen::MatrixXd firstOfPairs(const Eigen::MatrixXd& rows) {
    return rows(Eigen::seqN(0, rows.rows() / 2, 2), Eigen::all);
}

Eigen::MatrixXd turningBasis(Eigen::MatrixXd rows, double tolerance) {
    // Gram-Schmidt with the longest remaining row first, each pivot orthogonalised twice. The other rows
    // follow in panels of pivots; within one their lengths are told by what was taken out.
    constexpr int panel = 32;
    constexpr double told = 1e-6;  // of the longest squared length at the panel's beginning
    const Eigen::Index all = rows.cols();
    Eigen::MatrixXd basis(std::min(all, 2 * rows.rows()), all), along(rows.rows(), panel);
    Eigen::Index rank = 0;
    while (rows.rows() > 0 && rank < basis.rows()) {
        Eigen::VectorXd squared = rows.rowwise().squaredNorm();
        const double enough = std::max(tolerance * tolerance, told * squared.maxCoeff());
        const Eigen::Index start = rank;
        Eigen::Index longest = 0;
        while (rank - start < panel && rank < basis.rows() && squared.maxCoeff(&longest) > enough) {
            const Eigen::Index taken = rank - start;
            const auto found = basis.topRows(rank);
            Eigen::RowVectorXd pivot = rows.row(longest);
            pivot -= along.row(longest).head(taken) * found.bottomRows(taken);
            pivot.normalize();
            pivot -= (pivot * found.transpose()) * found;
            basis.row(rank) = pivot.normalized();
            basis.row(rank + 1) = turnedRows(basis.row(rank));
            auto new_along = along.middleCols<2>(taken);
            new_along = productTransposed(rows, basis.middleRows<2>(rank));
            squared -= new_along.rowwise().squaredNorm();
            squared(longest) = 0;
            rank += 2;
        }
        if (rank == start) break;
        rows -= product(along.leftCols(rank - start), basis.middleRows(start, rank - start));
    }
    return basis.topRows(rank);
}

OrthonormalRows::OrthonormalRows(const Eigen::MatrixXd& W, const CutRowsView& V, double negligible)
    : V_(V), W_(W.rows(), 0), many_(0, W.cols()), few_(V.size()) {
    for (std::size_t t = 0; t < V.size(); ++t) few_[t].resize(0, V[t]->cols());
    if (V.empty() || W.cols() == 0) return;
    const Directions first(gram(V, V));
    if (W.norm() * first.longest <= negligible) return;
    many_ = first.unit;
    W_ = product(W, first.weights);

    // A Gram matrix knows directions of which little is left to half the digits only: they are taken apart
    // and orthonormalised among themselves.
    Eigen::MatrixXd W_rest = product(W, first.others);
    CutRows rest = transformed(first.others.transpose(), V);
    while (W_rest.cols() > 0) {
        W_ += product(W_rest, deflate(rest));
        const Directions next(gram(viewOf(rest), viewOf(rest)));
        if (W_rest.norm() * next.longest <= negligible) return;
        const CutRows unit = transformed(next.unit, viewOf(rest));
        for (std::size_t t = 0; t < V.size(); ++t) {
            few_[t].conservativeResize(few_[t].rows() + unit[t].rows(), Eigen::NoChange);
            few_[t].bottomRows(unit[t].rows()) = unit[t];
        }
        W_.conservativeResize(Eigen::NoChange, W_.cols() + next.weights.cols());
        W_.rightCols(next.weights.cols()) = product(W_rest, next.weights);
        W_rest = product(W_rest, next.others);
        rest = transformed(next.others.transpose(), viewOf(rest));
    }
}

Eigen::MatrixXd OrthonormalRows::deflate(CutRows& rest) const {
    Eigen::MatrixXd along(rest.front().rows(), W_.cols());
    along.leftCols(many_.rows()) = productTransposed(gram(viewOf(rest), V_), many_);
    along.rightCols(few_.front().rows()) = gram(viewOf(rest), viewOf(few_));
    const CutRows found = times(along);
    for (std::size_t t = 0; t < rest.size(); ++t) rest[t] -= found[t];
    return along;
}

CutRows OrthonormalRows::times(const Eigen::MatrixXd& K) const {
    CutRows out = transformed(product(K.leftCols(many_.rows()), many_), V_);
    if (W_.cols() == many_.rows()) return out;
    const CutRows rest = transformed(K.rightCols(W_.cols() - many_.rows()), viewOf(few_));
    for (std::size_t t = 0; t < out.size(); ++t) out[t] += rest[t];
    return out;
}

BeyondBasis::BeyondBasis(const CutRowsView& V, const CutRows& rows, Eigen::Index count, double negligible)
    : along(Eigen::MatrixXd::Zero(count, V.empty() ? 0 : V.front()->rows())), weights(count, 0) {
    if (V.empty()) return;
    weights = Eigen::MatrixXd::Zero(count, 2 * count);
    for (Eigen::Index i = 0; i < count; ++i) weights(i, 2 * i) = 1;
    for (const Eigen::MatrixXd& part : rows) directions.push_back(withTurnedRows(part));
    // V is orthonormal to half the digits, so that much of what lies along V stays in rows it was taken out
    // of; where little else is left of them, that is all there is. Scaled to length one, a direction shows
    // it: it is taken out again, and of a direction that had much of it the little that is left goes, or is
    // scaled and looked at once more.
    for (bool unit = false;; unit = true) {
        const Eigen::MatrixXd overlap = gram(viewOf(directions), V);
        along += product(weights, overlap);
        const Eigen::MatrixXd first = firstOfPairs(overlap);
        for (std::size_t t = 0; t < V.size(); ++t)
            directions[t] = withTurnedRows(firstOfPairs(directions[t]) - product(first, *V[t]));
        if (unit && !(overlap.norm() > small_overlap)) return;
        const OrthonormalRows orthonormal(weights, viewOf(directions), negligible);
        const Eigen::MatrixXd K = turningBasis(orthonormal.W(), negligible);
        directions = orthonormal.times(K);
        weights = productTransposed(orthonormal.W(), K);
    }
}

}  // namespace slamot
