#pragma once
// Bases for the rows of a matrix whose columns are the coordinates of points, two each.
#include <Eigen/Core>

namespace slamot {

/// Every 2-vector of a row turned by a quarter turn to the left: rows (I x J)^t.
Eigen::MatrixXd turnedRows(const Eigen::Ref<const Eigen::MatrixXd>& rows);

/// Orthonormal rows that span `rows` to within `tolerance` (the length of what is left of any row), closed
/// under the quarter turn: row 2k + 1 is row 2k turned. Gives up and returns no rows beyond `largest`.
Eigen::MatrixXd turningBasis(Eigen::MatrixXd rows, double tolerance, int largest);

}  // namespace slamot
