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

void FarGroup::orthonormalise() {
    // V V^t as a complex matrix, each pair of rows being y and i y: T = Lambda^-1/2 E^H. Where V has nothing
    // left the direction is dropped; elsewhere W V is unchanged however small it is.
    if (rank() == 0) return;
    const Eigen::Index pairs = rank() / 2;
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(rank(), rank());
    for (const Part& p : parts)
        if (p.far) gram += product(p.V, p.V.transpose());
    Eigen::MatrixXcd G(pairs, pairs);
    for (Eigen::Index j = 0; j < pairs; ++j)
        for (Eigen::Index i = 0; i < pairs; ++i) G(i, j) = {gram(2 * i, 2 * j), gram(2 * i, 2 * j + 1)};
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(G);
    const auto& squared = solver.eigenvalues();
    Eigen::Index none = 0;
    while (none < pairs && squared(none) <= 1e-30) ++none;
    const Eigen::Index kept = pairs - none;
    const Eigen::VectorXd root = squared.tail(kept).cwiseSqrt();
    const Eigen::MatrixXcd E = solver.eigenvectors().rightCols(kept);
    const Eigen::MatrixXd T = onPairs(root.cwiseInverse().asDiagonal() * E.adjoint());
    W = W * onPairs(E * root.asDiagonal());
    for (Part& p : parts) {
        if (!p.far) continue;
        p.V = product(T, p.V);
        pairUp(p.V);
    }
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
