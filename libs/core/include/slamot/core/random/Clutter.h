#pragma once
// False detections of range-bearing sensors: the simulator's and those that a run adds to a recorded log.
#include <vector>

#include "slamot/core/data/Detections.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot {

/// Anywhere in the field of view, uniform in range and bearing: [m, rad]. The sensor must have a max_range.
Vector2 anywhereInView(const RangeBearingSensor& sensor, RandomStream& random);

/// The false detections of one scan: a Poisson number of mean `per_scan`, below 500, anywhere in view.
std::vector<Vector2> drawClutter(const RangeBearingSensor& sensor, double per_scan, RandomStream& random);

/// Largest `per_scan` that parameter tables take; RandomStream::poisson needs a mean below 500.
inline constexpr double max_clutter_per_scan = 400;

}  // namespace slamot
