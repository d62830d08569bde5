#include "slamot/core/random/Clutter.h"

#include "slamot/core/data/Angle.h"

namespace slamot {

Vector2 anywhereInView(const RangeBearingSensor& sensor, RandomStream& random) {
    const double range = random.uniform(sensor.min_range, sensor.max_range);
    return {range, wrapAngle(random.uniform(-0.5, 0.5) * sensor.field_of_view)};
}

std::vector<Vector2> drawClutter(const RangeBearingSensor& sensor, double per_scan, RandomStream& random) {
    std::vector<Vector2> clutter(static_cast<std::size_t>(random.poisson(per_scan)));
    for (Vector2& z : clutter) z = anywhereInView(sensor, random);
    return clutter;
}

}  // namespace slamot
