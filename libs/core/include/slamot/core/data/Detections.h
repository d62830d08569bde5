#pragma once
// What a sensor reports at one instant, after the log's conventions have been resolved.
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "slamot/core/data/Identities.h"
#include "slamot/core/data/Pose2.h"
#include "slamot/core/data/Stamp.h"

namespace slamot {

enum class ObjectKind { landmark, mover, unknown };

const char* toText(ObjectKind kind);

/// The sensor behind a detection.
struct RangeBearingSensor {
    std::string label;
    /// T_robot_sensor, planar.
    Pose2 pose;
    /// [m]; max_range 0 means no limit is known.
    double min_range = 0, max_range = 0;
    /// Full width of the field of view [rad], centred on the sensor's x axis.
    double field_of_view = 2 * pi;
    /// What it reports; unknown: landmarks and movers alike.
    ObjectKind kind = ObjectKind::unknown;
};

/// One range-bearing reading, z = [range bearing] in [m, rad], in the sensor's frame.
struct RangeBearingDetection {
    double range = 0, bearing = 0;
    /// Covariance of [range bearing]; positive definite.
    Matrix2 covariance = Matrix2::Identity();
    ObjectKind kind = ObjectKind::unknown;
    /// Identity given by the log, none when unknown or hidden by `[identities]`.
    SourceId source;
    /// Index into RangeBearingSet::sensors.
    int sensor = 0;

    Vector2 z() const { return {range, bearing}; }
};

struct RangeBearingSet {
    std::vector<RangeBearingSensor> sensors;
    std::vector<RangeBearingDetection> detections;

    const RangeBearingDetection& detection(int number) const {
        return detections[static_cast<std::size_t>(number)];
    }
    const RangeBearingSensor& sensorOf(const RangeBearingDetection& detection) const {
        return sensors[static_cast<std::size_t>(detection.sensor)];
    }
    /// Of the detection of that number.
    const RangeBearingSensor& sensorOf(int number) const { return sensorOf(detection(number)); }
};

/// All detections of one stamp: one batch, whatever number of sensors they came from. An empty one is legal:
/// the sensors looked and saw nothing. Range-only or 3-D sets would be further alternatives of the variant.
struct DetectionSet {
    Stamp stamp;
    std::variant<RangeBearingSet> measurements;

    const RangeBearingSet& rangeBearing() const { return std::get<RangeBearingSet>(measurements); }
};

}  // namespace slamot
