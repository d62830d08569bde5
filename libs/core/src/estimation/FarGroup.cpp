#include "slamot/core/estimation/FarGroup.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace slamot {

Eigen::MatrixXd FarGroup::left(int s, int first, int count) const {
    const Part& p = part(s);
    if (!p.far) return p.C.middleRows(first, count);
    return transposedProduct(p.V.middleCols(first, count), zeta);
}

void FarGroup::extend(int directions) {
    if (directions == 0) return;
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
    Part& p = part(tile);
    if (p.far) {
        cut |= static_cast<Eigen::Index>(kept.size()) < p.V.cols();
        p.V = Eigen::MatrixXd(p.V(Eigen::all, kept));
        return;
    }
    p.C = Eigen::MatrixXd(p.C(kept, Eigen::all));
}

WaitingTerm FarGroup::aboutTwoFar(double negligible) const {
    WaitingTerm out;
    if (rank() == 0) return out;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(zeta);
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < rank(); ++i)
        if (std::abs(solver.eigenvalues()(i)) > negligible) kept.push_back(i);
    out.scale = solver.eigenvalues()(kept);
    const Eigen::MatrixXd Q = solver.eigenvectors()(Eigen::all, kept);
    for (const Part& p : parts)
        out.parts.push_back({p.far, p.far ? transposedProduct(Q, p.V) : Eigen::MatrixXd()});
    return out;
}

WaitingTerm FarGroup::takeNearAndFar() {
    WaitingTerm out;
    out.about = WaitingTerm::About::near_and_far;
    out.scale = Eigen::VectorXd::Ones(rank());
    for (Part& p : parts)
        out.parts.push_back({p.far, p.far ? std::move(p.V) : Eigen::MatrixXd(p.C.transpose())});
    return out;
}

}  // namespace slamot
