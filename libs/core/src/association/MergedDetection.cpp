#include "slamot/core/association/MergedDetection.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace slamot {

MergedInnovation mergedInnovation(const Matrix2& P_y, const std::vector<WeighedInnovation>& innovations,
                                  double most_noise) {
    // Moments of the mixture, the prior first.
    double none = 1;
    Vector2 mean = Vector2::Zero();
    Matrix2 second = Matrix2::Zero();
    for (const WeighedInnovation& i : innovations) {
        const Matrix2 K = (P_y + i.noise).llt().solve(P_y).transpose();
        const Vector2 m = K * i.residual;
        mean += i.probability * m;
        second += i.probability * (P_y - K * P_y + m * m.transpose());
        none -= i.probability;
    }
    const Matrix2 C = second + none * P_y - mean * mean.transpose();

    // In coordinates where P_y = L L^t is 1: noise r_k with 1 / c_k = 1 + 1 / r_k along the axes of C.
    const Matrix2 L = P_y.llt().matrixL();
    const auto lower = L.triangularView<Eigen::Lower>();
    const Matrix2 half = lower.solve(C);
    const Matrix2 whitened = lower.solve(half.transpose());
    const Eigen::SelfAdjointEigenSolver<Matrix2> axes(0.5 * (whitened + whitened.transpose()));
    Vector2 r;
    for (int k = 0; k < 2; ++k) {
        // Rounding must not turn what is all but certain into what knows nothing.
        const double information = 1 / std::max(axes.eigenvalues()(k), 1e-12) - 1;
        r(k) = information * most_noise > 1 ? 1 / information : most_noise;
    }
    const Matrix2 V = L * axes.eigenvectors();
    const Vector2 m = axes.eigenvectors().transpose() * lower.solve(mean);
    return {V * (1 + r.array()).matrix().cwiseProduct(m), V * r.asDiagonal() * V.transpose()};
}

}  // namespace slamot
