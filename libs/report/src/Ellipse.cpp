#include "slamot/report/Ellipse.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace slamot::report {

Points2 ellipseOutline(const GaussianPoint& gaussian, double k, int count) {
    if (!gaussian.mean.allFinite() || !gaussian.covariance.allFinite()) {
        return {};
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(gaussian.covariance);
    const Eigen::Vector2d half_axes = k * eigen.eigenvalues().cwiseMax(0).cwiseSqrt();
    Points2 points;
    points.reserve(static_cast<std::size_t>(count) + 1);
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * M_PI * i / count;
        points.push_back(gaussian.mean +
                         eigen.eigenvectors() *
                             Eigen::Vector2d(half_axes[0] * std::cos(angle), half_axes[1] * std::sin(angle)));
    }
    points.push_back(points.front());
    return points;
}

}  // namespace slamot::report
