#include "slamot/core/filter/SensorLimits.h"

#include <algorithm>

namespace slamot {

RangeBearingSet SensorLimits::completed(RangeBearingSet seen) {
    for (const RangeBearingDetection& detection : seen.detections) {
        const RangeBearingSensor& sensor = seen.sensorOf(detection);
        if (sensor.max_range > 0) continue;
        double& farthest = farthest_[sensor.label];
        farthest = std::max(farthest, detection.range);
    }
    for (RangeBearingSensor& sensor : seen.sensors)
        if (!(sensor.max_range > 0)) sensor.max_range = farthest_[sensor.label];
    return seen;
}

}  // namespace slamot
