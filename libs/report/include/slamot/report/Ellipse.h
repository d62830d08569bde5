#pragma once
#include "slamot/report/Layers.h"

namespace slamot::report {

/// `count` points around the ellipse at Mahalanobis distance k of a Gaussian, and the first again at the end.
/// Empty if the mean or the covariance is not finite. Eigenvalues below zero (rounding) count as zero.
Points2 ellipseOutline(const GaussianPoint& gaussian, double k, int count);

}  // namespace slamot::report
