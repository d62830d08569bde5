#include "slamot/core/estimation/LinearMeasurement.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace slamot {
namespace {

double logDensity(double mahalanobis, double half_log_determinant, int rows) {
    return -0.5 * mahalanobis - half_log_determinant - 0.5 * rows * std::log(2.0 * pi);
}

}  // namespace

double BatchLikelihood::logConditional(int first, int count) const {
    double logs = 0;
    for (int i = first; i < first + count; ++i) logs += std::log(L_(i, i));
    return logDensity(w_.segment(first, count).squaredNorm(), logs, count);
}

double BatchLikelihood::logMarginal(int first, int count) const {
    if (first == 0) return logConditional(0, count);
    // Rows of S = L L^t and of nu = L w. L's upper triangle is not its own, hence row by row.
    const auto row = [this, first](int i) { return L_.row(first + i).head(first + i + 1); };
    Eigen::MatrixXd S(count, count);
    Eigen::VectorXd nu(count);
    for (int i = 0; i < count; ++i) {
        nu(i) = row(i).dot(w_.head(first + i + 1));
        for (int j = 0; j <= i; ++j) S(i, j) = row(i).head(first + j + 1).dot(row(j));
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(S);
    const auto diagonal = factor.matrixLLT().diagonal().array();
    return logDensity(factor.matrixL().solve(nu).squaredNorm(), diagonal.log().sum(), count);
}

}  // namespace slamot
