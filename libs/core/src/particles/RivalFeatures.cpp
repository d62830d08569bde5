#include "slamot/core/particles/RivalFeatures.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace slamot {

double logOneAgainstTwo(double first, double second, const std::vector<RivalSight>& sights) {
    double a = 0, b = 0, both = 0, one = 0;
    for (const RivalSight& sight : sights) {
        a += sight.first;
        b += sight.second;
        both += sight.first * sight.second;
        one += sight.one;
    }
    const double largest = std::max(first, second), missed = (1 - first) * (1 - second);
    const double if_one = 1 - largest + one;
    const double if_two = missed + a * (1 - second) + b * (1 - first) + std::max(a * b - both, 0.0);
    return std::log(if_one / largest) - std::log(if_two / (1 - missed));
}

GaussianPoint fused(const GaussianPoint& a, const GaussianPoint& b) {
    const Matrix2 K = a.covariance * (a.covariance + b.covariance).inverse();
    const Vector2 apart = b.mean - a.mean;
    const double contradiction = apart.dot((a.covariance + b.covariance).inverse() * apart) / 2;
    Matrix2 P = a.covariance - K * a.covariance;
    P(0, 1) = P(1, 0) = 0.5 * (P(0, 1) + P(1, 0));
    return {a.mean + K * apart, std::max(contradiction, 1.0) * P};
}

}  // namespace slamot
