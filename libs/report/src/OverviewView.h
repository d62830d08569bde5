#pragma once
#include "slamot/report/Layers.h"

namespace slamot::report {

struct MapView {
    Eigen::Vector2d low{-1, -1}, high{1, 1};  ///< metres
    std::size_t outside = 0;                  ///< how many of `objects` lie beyond it
};

/// The box that holds all of `ways` and `objects`; but of the furthest 2 % of ten or more objects (at least
/// one) it leaves out those that would make it more than twice as wide or high. Values that are not finite do
/// not count.
MapView mapView(const Points2& ways, const Points2& objects);

}  // namespace slamot::report
