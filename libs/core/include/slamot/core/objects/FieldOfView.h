#pragma once
// What a sensor should have seen: only a look that could not but show an object counts as a miss.
#include "slamot/core/data/Detections.h"
#include "slamot/core/estimation/RangeBearingUpdate.h"

namespace slamot {

/// Whether the object lies within the sensor's limits by two standard deviations of what is expected of its
/// detection. Never for a sensor whose max_range is not known.
bool surelyInView(const RangeBearingSensor& sensor, const ExpectedDetection& expected);

/// Whether the sensor reports objects of that kind: a sensor of unknown kind reports both.
bool reports(const RangeBearingSensor& sensor, ObjectKind kind);

}  // namespace slamot
