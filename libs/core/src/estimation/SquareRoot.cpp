#include "slamot/core/estimation/SquareRoot.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace slamot {

Eigen::VectorXd SquareRoot::unknown() const {
    return whitener.rowwise().any().cast<double>();
}

SquareRoot squareRoot(const Eigen::Ref<const Eigen::MatrixXd>& P) {
    // Units differ between components: the pivots to be judged are those of the correlations.
    const Eigen::VectorXd std = P.diagonal().cwiseMax(0).cwiseSqrt();
    const Eigen::VectorXd scale = std.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
    const Eigen::LDLT<Eigen::MatrixXd> ldlt(scale.asDiagonal() * P * scale.asDiagonal());
    const double floor = 1e-15 * static_cast<double>(P.rows());
    const Eigen::VectorXd pivots =
        ldlt.vectorD().unaryExpr([floor](double d) { return d > floor ? std::sqrt(d) : 0.0; });
    const Eigen::VectorXd inverse = pivots.unaryExpr([](double d) { return d > 0 ? 1 / d : 0.0; });

    SquareRoot out;
    out.root = ldlt.matrixL();
    out.root = std.asDiagonal() * (ldlt.transpositionsP().transpose() * (out.root * pivots.asDiagonal()));
    out.whitener = ldlt.transpositionsP() * Eigen::MatrixXd(scale.asDiagonal());
    ldlt.matrixL().solveInPlace(out.whitener);
    out.whitener = inverse.asDiagonal() * out.whitener;
    return out;
}

}  // namespace slamot
