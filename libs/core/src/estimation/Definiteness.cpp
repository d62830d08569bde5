#include "slamot/core/estimation/Definiteness.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace slamot {

bool isPositiveSemidefinite(const Eigen::Ref<const Eigen::MatrixXd>& matrix, double tolerance) {
    if (matrix.size() == 0) return true;
    if (!matrix.allFinite()) return false;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
    const auto& values = solver.eigenvalues();
    return values.minCoeff() >= -tolerance * std::max(values.maxCoeff(), 0.0);
}

bool isPositiveDefinite(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
    if (!matrix.allFinite()) return false;
    const Eigen::LLT<Eigen::MatrixXd> factor(matrix);
    return factor.info() == Eigen::Success;
}

}  // namespace slamot
