#pragma once
// Matrices from keyed draws.
#include <Eigen/Core>

#include "slamot/core/random/RandomStream.h"

namespace slamot::test {

/// Standard normal entries.
inline Eigen::MatrixXd randomMatrix(RandomStream& random, int rows, int cols) {
    Eigen::MatrixXd out(rows, cols);
    for (int j = 0; j < cols; ++j)
        for (int i = 0; i < rows; ++i) out(i, j) = random.normal();
    return out;
}

inline Eigen::VectorXd randomVector(RandomStream& random, int size) {
    return randomMatrix(random, size, 1);
}

/// Positive definite, eigenvalues of about `scale`.
inline Eigen::MatrixXd randomCovariance(RandomStream& random, int size, double scale = 1) {
    const Eigen::MatrixXd A = randomMatrix(random, size, size + 2);
    return scale * A * A.transpose() / (size + 2);
}

}  // namespace slamot::test
