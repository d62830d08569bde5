#pragma once
// Short hand-made scenes for filters.
#include <utility>
#include <vector>

#include "slamot/core/data/Detections.h"
#include "slamot/core/data/Odometry.h"
#include "slamot/core/models/RangeBearing.h"

namespace slamot::test {

inline OdometryIncrement odometry(double t0, double t1, const Pose2& increment) {
    OdometryIncrement out;
    out.t0 = Stamp::fromSeconds(t0);
    out.t1 = Stamp::fromSeconds(t1);
    out.increment = increment;
    out.entry_seconds = t1 - t0;
    return out;
}

/// A detection of `point` as seen without noise, with deviations 0.1 m and 0.02 rad.
inline RangeBearingDetection seen(const Pose2& robot, const Vector2& point, ObjectKind kind,
                                  std::int64_t source, const Pose2& sensor = {}, int sensor_index = 0) {
    const Vector2 z = rangeBearing<double>(robot.vector(), point, sensor);
    RangeBearingDetection out;
    out.range = z.x();
    out.bearing = z.y();
    out.covariance = Vector2(0.01, 0.0004).asDiagonal();
    out.kind = kind;
    out.source = {source};
    out.sensor = sensor_index;
    return out;
}

inline DetectionSet detectionsAt(double t, std::vector<RangeBearingDetection> detections,
                                 std::vector<Pose2> sensors = {Pose2{}}) {
    RangeBearingSet set;
    for (const Pose2& pose : sensors) {
        RangeBearingSensor sensor;
        sensor.pose = pose;
        set.sensors.push_back(sensor);
    }
    set.detections = std::move(detections);
    return {Stamp::fromSeconds(t), std::move(set)};
}

}  // namespace slamot::test
