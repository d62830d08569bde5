#include "slamot/core/data/Ellipse.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "slamot/core/data/Angle.h"

namespace slamot {

std::vector<Vector2> ellipseOutline(const Vector2& mean, const Matrix2& covariance, double k, int count) {
    if (!mean.allFinite() || !covariance.allFinite()) return {};
    const Eigen::SelfAdjointEigenSolver<Matrix2> eigen(covariance);
    const Vector2 half_axes = k * eigen.eigenvalues().cwiseMax(0).cwiseSqrt();
    std::vector<Vector2> points;
    points.reserve(static_cast<std::size_t>(count) + 1);
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * pi * i / count;
        points.push_back(mean + eigen.eigenvectors() *
                                    Vector2(half_axes[0] * std::cos(angle), half_axes[1] * std::sin(angle)));
    }
    points.push_back(points.front());
    return points;
}

}  // namespace slamot
