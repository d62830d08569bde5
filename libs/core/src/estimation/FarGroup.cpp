#include "slamot/core/estimation/FarGroup.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "slamot/core/estimation/DenseAlgebra.h"
#include "slamot/core/estimation/TurningBasis.h"

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

/// The complex matrix behind a product of pairs of rows.
Eigen::MatrixXcd ofPairs(const Eigen::MatrixXd& M) {
    Eigen::MatrixXcd out(M.rows() / 2, M.cols() / 2);
    for (Eigen::Index j = 0; j < out.cols(); ++j)
        for (Eigen::Index i = 0; i < out.rows(); ++i) out(i, j) = {M(2 * i, 2 * j), M(2 * i, 2 * j + 1)};
    return out;
}

/// Rows over all far tiles, cut into tiles.
using Rows = std::vector<Eigen::MatrixXd>;

Eigen::MatrixXd gram(const Rows& a, const Rows& b) {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(a.front().rows(), b.front().rows());
    for (std::size_t t = 0; t < a.size(); ++t) out += product(a[t], b[t].transpose());
    return out;
}

/// Eigenvalues above this part of the largest have eigenvectors worth their name.
constexpr double well_known = 1e-8;

/// Makes every second row exactly the turned one before it: where little is left of a direction, scaling it
/// up brings rounding forward.
void pairUp(Eigen::MatrixXd& V) {
    for (Eigen::Index k = 0; k + 1 < V.rows(); k += 2) V.row(k + 1) = turnedRows(V.row(k));
}

}  // namespace

int FarGroup::width(int tile) const {
    if (tile >= static_cast<int>(parts.size())) return 0;
    return static_cast<int>(part(tile).far ? part(tile).V.cols() : part(tile).C.rows());
}

Eigen::MatrixXd FarGroup::left(int s, int first, int count) const {
    const Part& p = part(s);
    if (!p.far) return p.C.middleRows(first, count);
    return p.V.middleCols(first, count).transpose() * zeta;
}

void FarGroup::end(double negligible) {
    if (rank() == 0) return;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(zeta);
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < rank(); ++i)
        if (std::abs(solver.eigenvalues()(i)) > negligible) kept.push_back(i);
    lambda = solver.eigenvalues()(kept);
    const Eigen::MatrixXd Q = solver.eigenvectors()(Eigen::all, kept), along = Q.transpose();
    for (Part& p : parts)
        if (p.far) p.E = product(along, p.V);
    zeta = Q * lambda.asDiagonal() * Q.transpose();
}

Eigen::MatrixXd FarGroup::waiting(int s, int t) const {
    if (!part(t).far) return part(s).far ? Eigen::MatrixXd(waiting(t, s).transpose()) : Eigen::MatrixXd();
    if (part(s).far) {
        Eigen::MatrixXd out(width(s), width(t));
        const Eigen::MatrixXd scaled = lambda.asDiagonal() * part(t).E;
        multiplyTransposed(part(s).E, scaled, out);
        return out;
    }
    return product(part(s).C, part(t).V);
}

double FarGroup::cost(int s, int t) const {
    const bool both = part(s).far && part(t).far;
    return 1.0 * static_cast<double>(both ? lambda.size() : rank()) * width(s) * width(t);
}

void FarGroup::orthonormalise(double negligible) {
    // Eigenvectors of V V^t as a complex matrix, each pair of rows being y and i y. It knows directions of
    // which little is left to half the digits only: they are taken apart and orthonormalised among
    // themselves.
    Rows rest, found;
    for (Part& p : parts)
        if (p.far) rest.push_back(std::move(p.V));
    for (const Eigen::MatrixXd& rows : rest) found.emplace_back(0, rows.cols());
    if (rest.empty()) return void(W.resize(W.rows(), 0));
    Eigen::MatrixXd W_rest = W;
    W.resize(W.rows(), 0);
    while (W_rest.cols() > 0) {
        if (W.cols() > 0) {
            const Eigen::MatrixXd along = gram(rest, found);
            for (std::size_t t = 0; t < rest.size(); ++t) rest[t] -= product(along, found[t]);
            W += product(W_rest, along);
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(ofPairs(gram(rest, rest)));
        const Eigen::VectorXd& squared = solver.eigenvalues();
        const double largest = squared(squared.size() - 1);
        if (largest <= 0 || W_rest.norm() * std::sqrt(largest) <= negligible) break;
        const auto few = (squared.array() <= well_known * largest).count(), many = squared.size() - few;
        const Eigen::VectorXd length = squared.tail(many).cwiseSqrt();
        const Eigen::MatrixXcd E = solver.eigenvectors().rightCols(many);
        const Eigen::MatrixXd T = onPairs(length.cwiseInverse().asDiagonal() * E.adjoint()),
                              left = onPairs(solver.eigenvectors().leftCols(few));
        for (std::size_t t = 0; t < rest.size(); ++t) {
            Eigen::MatrixXd unit = product(T, rest[t]);
            pairUp(unit);
            found[t].conservativeResize(W.cols() + unit.rows(), Eigen::NoChange);
            found[t].bottomRows(unit.rows()) = unit;
            rest[t] = product(left.transpose(), rest[t]);
        }
        W.conservativeResize(Eigen::NoChange, W.cols() + 2 * many);
        W.rightCols(2 * many) = product(W_rest, onPairs(E * length.asDiagonal()));
        W_rest = product(W_rest, left);
    }
    std::size_t t = 0;
    for (Part& p : parts)
        if (p.far) p.V = std::move(found[t++]);
}

void FarGroup::extend(int directions) {
    const auto pad = [directions](Eigen::MatrixXd& M, int rows, int cols) {
        const auto r = M.rows(), c = M.cols();
        M.conservativeResize(r + rows * directions, c + cols * directions);
        M.bottomRows(rows * directions).setZero();
        M.rightCols(cols * directions).setZero();
    };
    pad(W, 0, 1);
    pad(zeta, 1, 1);
    for (Part& p : parts) p.far ? pad(p.V, 1, 0) : pad(p.C, 0, 1);
    shift.conservativeResize(shift.size() + directions);
    shift.tail(directions).setZero();
}

void FarGroup::dropColumns(int tile, const std::vector<int>& kept) {
    if (tile >= static_cast<int>(parts.size())) return;
    std::vector<int> known;
    for (const int i : kept)
        if (i < width(tile)) known.push_back(i);
    Part& p = part(tile);
    if (p.far && p.E.size() == 0) p.E.resize(0, p.V.cols());
    if (p.far)
        for (Eigen::MatrixXd* M : {&p.V, &p.E}) *M = Eigen::MatrixXd((*M)(Eigen::all, known));
    else
        p.C = Eigen::MatrixXd(p.C(known, Eigen::all));
}

}  // namespace slamot
