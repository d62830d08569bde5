#pragma once
#include <vector>

#include "slamot/core/data/Pose2.h"

namespace slamot {

/// The closed outline of the points at a Mahalanobis distance of k from the mean: `count` points and the first
/// one again. Eigenvalues below 0 count as 0; empty where a number is not finite.
std::vector<Vector2> ellipseOutline(const Vector2& mean, const Matrix2& covariance, double k, int count);

}  // namespace slamot
