#include "slamot/core/estimation/SquareRoot.h"

#include <cmath>
#include <vector>

namespace slamot {

Eigen::VectorXd SquareRoot::unknown() const {
    return whitener.rowwise().any().cast<double>();
}

SquareRoot squareRoot(const Eigen::Ref<const Eigen::MatrixXd>& P) {
    // Cholesky's factors with the largest rest as the next pivot: what is left out is then below the floor in
    // every component, which a factorisation in a fixed order does not promise (nor does Eigen's LDLT, which
    // chooses among the original diagonal). Units differ between components: the pivots to be judged are
    // those of the correlations.
    const Eigen::Index n = P.rows();
    const Eigen::VectorXd std = P.diagonal().cwiseMax(0).cwiseSqrt();
    const Eigen::VectorXd scale = std.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
    const Eigen::MatrixXd C = scale.asDiagonal() * P * scale.asDiagonal();
    const double floor = 1e-15 * static_cast<double>(n);
    Eigen::MatrixXd L = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd rest = C.diagonal();
    std::vector<Eigen::Index> pivots;
    while (static_cast<Eigen::Index>(pivots.size()) < n) {
        Eigen::Index p = 0;
        if (rest.maxCoeff(&p) <= floor) break;
        const auto k = static_cast<Eigen::Index>(pivots.size());
        auto column = L.col(k);
        column = C.col(p);
        column.noalias() -= L.leftCols(k) * L.row(p).head(k).transpose();
        column /= std::sqrt(rest(p));
        column(pivots).setZero();
        column(p) = std::sqrt(rest(p));
        rest -= column.cwiseAbs2();
        rest(p) = 0;
        pivots.push_back(p);
    }

    // On the pivots' rows L is triangular.
    const auto rank = static_cast<Eigen::Index>(pivots.size());
    const Eigen::MatrixXd triangle = L(pivots, Eigen::seqN(0, rank));
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(rank, rank);
    triangle.triangularView<Eigen::Lower>().solveInPlace(inverse);
    SquareRoot out;
    out.root = std.asDiagonal() * L;
    out.whitener = Eigen::MatrixXd::Zero(n, n);
    out.whitener(Eigen::seqN(0, rank), pivots) = inverse * scale(pivots).asDiagonal();
    return out;
}

}  // namespace slamot
