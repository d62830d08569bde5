#pragma once
// What a sensor should have seen: only a look that would have shown an object speaks against it.
// doc/maths/objects.md.
#include <algorithm>

#include "slamot/core/data/Detections.h"
#include "slamot/core/estimation/RangeBearingUpdate.h"

namespace slamot {

/// Whether the object lies within the sensor's limits by two standard deviations of what is expected of its
/// detection. Never for a sensor whose max_range is not known.
bool surelyInView(const RangeBearingSensor& sensor, const ExpectedDetection& expected);

/// Probability that the object lies within the sensor's limits, range and bearing taken as independent. 0 for
/// a sensor whose max_range is not known.
double probabilityInView(const RangeBearingSensor& sensor, const ExpectedDetection& expected);

/// What is detected beside the field of view is in it after all: there a detection may be of an object with
/// this probability at least.
constexpr double least_in_view = 0.02;

/// Whether the sensor reports objects of that kind: a sensor of unknown kind reports both.
bool reports(const RangeBearingSensor& sensor, ObjectKind kind);

/// Whether a sensor that reports `kind` could not but show an object; `expectedBy(sensor)`: its detection.
template <class ExpectedBy>
bool surelySeenByAny(const RangeBearingSet& seen, ObjectKind kind, const ExpectedBy& expectedBy) {
    return std::any_of(seen.sensors.begin(), seen.sensors.end(), [&](const RangeBearingSensor& sensor) {
        return reports(sensor, kind) && sensor.max_range > 0 && surelyInView(sensor, expectedBy(sensor));
    });
}

}  // namespace slamot
