#pragma once
#include "slamot/report/Layers.h"

namespace slamot::report {

struct MapView {
    Eigen::Vector2d low{-1, -1}, high{1, 1};  ///< metres
    std::size_t outside = 0;                  ///< how many of `objects` lie beyond it
};

/// Something drawn on a map; its mark or ellipse covers `reach` in x and y to either side.
struct MapObject {
    Eigen::Vector2d position, reach = Eigen::Vector2d::Zero();
};

/// Of a landmark or track with the 3-sigma ellipse of its covariance.
MapObject mapObject(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance);

/// The box that holds all of `ways` and `objects`; but of the furthest 2 % of ten or more objects (at least
/// one) it leaves out those that would make it more than twice as wide or high, and of the ellipses what lies
/// beyond a tenth of the larger side. Values that are not finite do not count.
MapView mapView(const Points2& ways, const std::vector<MapObject>& objects);

}  // namespace slamot::report
