#pragma once
// The arithmetic of a Gaussian mixture that is a probability hypothesis density (PHD; paper 4, eq. 21 to 30):
// what a component becomes in an update, and which of these are taken for one.
#include <vector>

#include "slamot/core/particles/PointSight.h"

namespace slamot {

/// w N(m; mean, covariance) of the density after an update, and where it comes from.
struct PhdTerm {
    int component;  ///< index of the component before
    int sight;      ///< index of the detection it takes in; -1: the component, not detected
    double weight;  ///< expected number of landmarks
    GaussianPoint point;
};

/// Terms that have become one: those from `first` to before `last` in PhdGroups::order, heaviest first.
struct PhdGroup {
    int first, last;
    double weight;
    double detected;  ///< part of the weight that comes from detections
    GaussianPoint point;
};

/// Room for one merging, used again for the next.
struct PhdGroups {
    std::vector<int> order;  ///< of terms, by index
    std::vector<PhdGroup> groups;
    std::vector<int> left;
};

/// Leaves out terms below `least_weight` and takes those together that lie near a heavier one: for term i and
/// the heaviest that is left, j, when (m_i - m_j)^t P_i^-1 (m_i - m_j) <= within (eq. 30). A group has the
/// first two moments of its members. Groups descend by the weight of their heaviest member; equal weights
/// keep the terms' order.
void mergeTerms(const std::vector<PhdTerm>& terms, double least_weight, double within, PhdGroups& out);

/// N(at; mean, covariance) [1/m^2].
double densityAt(const Vector2& at, const GaussianPoint& point);

}  // namespace slamot
