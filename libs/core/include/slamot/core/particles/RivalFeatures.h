#pragma once
// Two features that may be one: what a scan says of that. Features that are one share each detection; two that are
// close to one another are both detected sooner or later.
#include <vector>

#include "slamot/core/particles/PointSight.h"

namespace slamot {

/// A detection that may be of either. P_D N(z; .) / c given that the feature is there, c the density of all else that
/// it may come from.
struct RivalSight {
    double first, second;
    double one;  ///< of the feature that both are, if they are one
};

/// Log of how much likelier a scan is if they are one, given that it shows something of them. The sums go over all ways
/// in which the detections may be theirs. `first` and `second` are their probabilities of detection, within (0, 1).
double logOneAgainstTwo(double first, double second, const std::vector<RivalSight>& sights);

/// What two points are together if they are one. Where they contradict one another, more than their covariances allow,
/// the covariance grows as much.
GaussianPoint fused(const GaussianPoint& a, const GaussianPoint& b);

}  // namespace slamot
