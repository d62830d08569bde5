#include "slamot/core/estimation/Definiteness.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace slamot {
namespace {

/// Covariances of poses, targets and measurements: checked at every step, so kept off the heap.
constexpr int small_size = 6;
using SmallMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, small_size, small_size>;

template <class Matrix>
bool semidefinite(const Matrix& matrix, double tolerance) {
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(matrix, Eigen::EigenvaluesOnly);
    const auto& values = solver.eigenvalues();
    return values.minCoeff() >= -tolerance * std::max(values.maxCoeff(), 0.0);
}

template <class Matrix>
bool definite(const Matrix& matrix) {
    const Eigen::LLT<Matrix> factor(matrix);
    return factor.info() == Eigen::Success;
}

}  // namespace

bool isPositiveSemidefinite(const Eigen::Ref<const Eigen::MatrixXd>& matrix, double tolerance) {
    if (matrix.size() == 0) return true;
    if (!matrix.allFinite()) return false;
    return matrix.rows() <= small_size ? semidefinite<SmallMatrix>(matrix, tolerance)
                                       : semidefinite<Eigen::MatrixXd>(matrix, tolerance);
}

bool isPositiveDefinite(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
    if (!matrix.allFinite()) return false;
    return matrix.rows() <= small_size ? definite<SmallMatrix>(matrix) : definite<Eigen::MatrixXd>(matrix);
}

}  // namespace slamot
