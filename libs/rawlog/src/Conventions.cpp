#include "slamot/rawlog/Conventions.h"

#include <fmt/format.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "slamot/rawlog/LogError.h"

namespace slamot {
namespace {

/// MRPT counts ticks from 1601-01-01, as Windows does; this many lie before the Unix epoch.
constexpr std::int64_t ticks_before_unix_epoch = 116'444'736'000'000'000;
constexpr double largest_tilt = radians(1.0);

bool allFinite(std::initializer_list<double> values) {
    for (const double value : values)
        if (!std::isfinite(value)) return false;
    return true;
}

/// An enumeration that MRPT has read from a log unchecked: of a broken log it may hold any number.
template <class Enum>
int rawValue(const Enum& value) {
    static_assert(sizeof(Enum) == sizeof(int));
    int raw = 0;
    std::memcpy(&raw, &value, sizeof raw);
    return raw;
}

Matrix2 diagonal(double std_range, double std_bearing) {
    return Vector2(std_range * std_range, std_bearing * std_bearing).asDiagonal();
}

}  // namespace

Stamp toStamp(mrpt::Clock::time_point time) {
    return {time.time_since_epoch().count() - ticks_before_unix_epoch};
}

mrpt::Clock::time_point toMrpt(Stamp stamp) {
    return mrpt::Clock::time_point(mrpt::Clock::duration(stamp.ticks + ticks_before_unix_epoch));
}

Pose2 toPose2(const mrpt::poses::CPose2D& pose) {
    return {pose.x(), pose.y(), wrapAngle(pose.phi())};
}

OdometryReading fromMrpt(const mrpt::obs::CObservationOdometry& odometry) {
    OdometryReading reading{toStamp(odometry.timestamp), toPose2(odometry.odometry), std::nullopt};
    const auto& v = odometry.velocityLocal;
    const bool pose_finite = allFinite({reading.pose.x, reading.pose.y, reading.pose.theta});
    if (!pose_finite || (odometry.hasVelocities && !allFinite({v.vx, v.vy, v.omega})))
        throw LogError(fmt::format("odometry '{}' at t = {} is not finite, expected numbers",
                                   odometry.sensorLabel, toText(reading.stamp)));
    if (odometry.hasVelocities) reading.velocity = BodyVelocity{v.vx, v.vy, v.omega};
    return reading;
}

mrpt::obs::CObservationOdometry::Ptr toMrpt(const OdometryReading& reading, const std::string& label) {
    auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->timestamp = toMrpt(reading.stamp);
    odometry->sensorLabel = label;
    odometry->odometry = mrpt::poses::CPose2D(reading.pose.x, reading.pose.y, reading.pose.theta);
    odometry->hasVelocities = reading.velocity.has_value();
    if (const auto& v = reading.velocity) odometry->velocityLocal = {v->vx, v->vy, v->omega};
    return odometry;
}

OdometryIncrement fromMrpt(const mrpt::obs::CActionRobotMovement2D& action) {
    using mrpt::obs::CActionRobotMovement2D;
    const bool odometry = rawValue(action.estimationMethod) == CActionRobotMovement2D::emOdometry;
    OdometryIncrement increment;
    increment.increment =
        toPose2(odometry ? action.rawOdometryIncrementReading : action.poseChange->getMeanVal());
    // Thrun's model is drawn afresh with each reading of the log: no covariance that two runs would agree on.
    const bool sampled =
        odometry && rawValue(action.motionModelConfiguration.modelSelection) == CActionRobotMovement2D::mmThrun;
    if (!sampled) increment.covariance = action.poseChange->getCovariance().asEigen();
    const auto& v = action.velocityLocal;
    if (action.hasVelocities) increment.velocity = BodyVelocity{v.vx, v.vy, v.omega};

    const Pose2& pose = increment.increment;
    if (!allFinite({pose.x, pose.y, pose.theta}) ||
        (increment.covariance && !increment.covariance->allFinite()) ||
        (increment.velocity && !allFinite({v.vx, v.vy, v.omega})))
        throw LogError("the odometry of an action is not finite, expected numbers");
    return increment;
}

RangeBearingReading fromMrpt(const mrpt::obs::CObservationBearingRange& observation) {
    const auto& sensor = observation.sensorLocationOnRobot;
    const Stamp stamp = toStamp(observation.timestamp);
    const auto refuse = [&](const std::string& what) {
        throw LogError(fmt::format("sensor '{}' at t = {} {}, expected a planar range-bearing sensor",
                                   observation.sensorLabel, toText(stamp), what));
    };
    if (!allFinite({sensor.x(), sensor.y(), sensor.yaw()}))
        refuse("has a pose on the robot that is not finite");
    if (std::abs(sensor.pitch()) > largest_tilt || std::abs(wrapAngle(sensor.roll())) > largest_tilt)
        refuse("is tilted by more than a degree");

    RangeBearingReading reading;
    reading.stamp = stamp;
    reading.sensor = {observation.sensorLabel,
                      {sensor.x(), sensor.y(), wrapAngle(sensor.yaw())},
                      observation.minSensorDistance,
                      observation.maxSensorDistance,
                      observation.fieldOfView_yaw};
    for (const auto& measurement : observation.sensedData) {
        if (std::abs(measurement.pitch) > largest_tilt) refuse("reports elevations of more than a degree");
        RangeBearingReading::Item item;
        item.range = measurement.range;
        item.bearing = measurement.yaw;
        if (measurement.landmarkID >= 0) item.id = SourceId{measurement.landmarkID};
        item.covariance = observation.validCovariances
                              ? Matrix2(measurement.covariance.asEigen().topLeftCorner<2, 2>())
                              : diagonal(observation.sensor_std_range, observation.sensor_std_yaw);
        reading.items.push_back(item);
    }
    return reading;
}

mrpt::obs::CObservationBearingRange::Ptr toMrpt(const RangeBearingReading& reading, double std_range,
                                                double std_bearing) {
    auto observation = mrpt::obs::CObservationBearingRange::Create();
    observation->timestamp = toMrpt(reading.stamp);
    observation->sensorLabel = reading.sensor.label;
    observation->sensorLocationOnRobot = mrpt::poses::CPose3D(
        mrpt::poses::CPose2D(reading.sensor.pose.x, reading.sensor.pose.y, reading.sensor.pose.theta));
    observation->minSensorDistance = static_cast<float>(reading.sensor.min_range);
    observation->maxSensorDistance = static_cast<float>(reading.sensor.max_range);
    observation->fieldOfView_yaw = static_cast<float>(reading.sensor.field_of_view);
    observation->fieldOfView_pitch = 0;
    observation->sensor_std_range = static_cast<float>(std_range);
    observation->sensor_std_yaw = static_cast<float>(std_bearing);
    observation->sensor_std_pitch = static_cast<float>(std_bearing);

    // Covariances of their own are written only where they say more than the sensor's claim.
    const Matrix2 claim = diagonal(observation->sensor_std_range, observation->sensor_std_yaw);
    observation->validCovariances = false;
    for (const auto& item : reading.items)
        if (!item.covariance.isZero(0) && item.covariance != claim &&
            item.covariance != diagonal(std_range, std_bearing))
            observation->validCovariances = true;

    for (const auto& item : reading.items) {
        if (item.id.value > std::numeric_limits<std::int32_t>::max())
            throw LogError(
                fmt::format("id {} of a detection by '{}' is too large, MRPT's logs hold at most {}",
                            item.id.value, reading.sensor.label, std::numeric_limits<std::int32_t>::max()));
        mrpt::obs::CObservationBearingRange::TMeasurement measurement;
        measurement.range = static_cast<float>(item.range);
        measurement.yaw = static_cast<float>(item.bearing);
        measurement.pitch = 0;
        measurement.landmarkID =
            item.id.valid() ? static_cast<std::int32_t>(item.id.value) : mrpt::obs::INVALID_LANDMARK_ID;
        const Matrix2 covariance = item.covariance.isZero(0) ? claim : item.covariance;
        measurement.covariance.setZero();
        measurement.covariance.asEigen().topLeftCorner<2, 2>() = covariance;
        measurement.covariance(2, 2) = covariance(1, 1);
        observation->sensedData.push_back(measurement);
    }
    return observation;
}

}  // namespace slamot
