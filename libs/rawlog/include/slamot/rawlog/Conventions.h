#pragma once
// The border between MRPT's observations and this project's values: the log conventions of
// doc/file_formats.md, each way in one place.
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "slamot/core/data/Detections.h"
#include "slamot/core/data/Odometry.h"

namespace slamot {

Stamp toStamp(mrpt::Clock::time_point time);
mrpt::Clock::time_point toMrpt(Stamp stamp);
Pose2 toPose2(const mrpt::poses::CPose2D& pose);

/// One reading of absolute odometry.
struct OdometryReading {
    Stamp stamp;
    Pose2 pose;                            ///< T_odom_robot
    std::optional<BodyVelocity> velocity;  ///< of the interval that ended at `stamp`
};

/// Throws LogError for numbers that are not finite.
OdometryReading fromMrpt(const mrpt::obs::CObservationOdometry& odometry);
mrpt::obs::CObservationOdometry::Ptr toMrpt(const OdometryReading& reading, const std::string& label);

/// One increment of an action-frame log; the caller sets its times.
OdometryIncrement fromMrpt(const mrpt::obs::CActionRobotMovement2D& action);

/// A range-bearing observation before roles and noise overrides are applied.
struct RangeBearingReading {
    Stamp stamp;
    RangeBearingSensor sensor;
    struct Item {
        double range = 0, bearing = 0;
        /// The log's id, or none.
        SourceId id;
        /// Covariance of [range bearing] the log claims: its own where it has one, else from sensor_std_*;
        /// zero where it claims nothing.
        Matrix2 covariance = Matrix2::Zero();
    };
    std::vector<Item> items;
};

/// Throws LogError for a sensor with pitch or roll beyond a degree: this program is planar. Items are passed
/// on as they are, finite or not: the pipeline drops and counts them one by one.
RangeBearingReading fromMrpt(const mrpt::obs::CObservationBearingRange& observation);
/// `std_range`, `std_bearing` are the sensor's own claims, written to sensor_std_*.
mrpt::obs::CObservationBearingRange::Ptr toMrpt(const RangeBearingReading& reading, double std_range,
                                                double std_bearing);

}  // namespace slamot
