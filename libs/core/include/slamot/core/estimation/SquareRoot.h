#pragma once
// A square root of a covariance that may know some components exactly.
#include <Eigen/Core>

namespace slamot {

/// P = root root^t. Components that P knows exactly have a zero column in root and a zero row in whitener; on
/// the others whitener P whitener^t is the identity.
struct SquareRoot {
    Eigen::MatrixXd root, whitener;

    /// The diagonal of whitener P whitener^t: 1, or 0 for a known component.
    Eigen::VectorXd unknown() const;
};

SquareRoot squareRoot(const Eigen::Ref<const Eigen::MatrixXd>& P);

}  // namespace slamot
