#pragma once
#include <Eigen/Core>

namespace slamot {

/// Whether a symmetric matrix has no eigenvalue below -tolerance times its largest (decided on the lower
/// triangle). Exactly known components (zero rows) are legal; numbers that are not finite are not.
bool isPositiveSemidefinite(const Eigen::Ref<const Eigen::MatrixXd>& matrix, double tolerance);

/// Strictly positive definite, by Cholesky.
bool isPositiveDefinite(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

}  // namespace slamot
