#include "slamot/core/association/LinearInnovations.h"

#include <cmath>
#include <limits>

namespace slamot {

Vector2 LinearInnovations::residual(int candidate) const {
    return measurements_[static_cast<std::size_t>(candidate)].residual;
}

Matrix2 LinearInnovations::covariance(int a, int b) {
    if (a < b) return covariance(b, a).transpose();
    auto& row = rows_[static_cast<std::size_t>(a)];
    if (row.empty())
        row.assign(static_cast<std::size_t>(a) + 1,
                   Matrix2::Constant(std::numeric_limits<double>::quiet_NaN()));
    Matrix2& S = row[static_cast<std::size_t>(b)];
    if (std::isnan(S(0, 0))) S = compute(a, b);
    return S;
}

Matrix2 LinearInnovations::compute(int a, int b) const {
    const LinearMeasurement& m = measurements_[static_cast<std::size_t>(a)];
    const LinearMeasurement& n = measurements_[static_cast<std::size_t>(b)];
    Matrix2 S = a == b ? m.R : Matrix2::Zero();
    for (int i = 0; i < m.term_count; ++i) {
        for (int j = 0; j < n.term_count; ++j) {
            const auto& [block_i, H_i] = m.terms[static_cast<std::size_t>(i)];
            const auto& [block_j, H_j] = n.terms[static_cast<std::size_t>(j)];
            const BlockMatrix P = state_.covariance(block_i, block_j);
            S += H_i * P.topLeftCorner(H_i.cols(), H_j.cols()) * H_j.transpose();
        }
    }
    return S;
}

}  // namespace slamot
