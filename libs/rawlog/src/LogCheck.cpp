#include "slamot/rawlog/LogCheck.h"

#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>

namespace slamot {
namespace {

std::string shortName(const char* class_name) {
    const std::string name = class_name;
    const auto colon = name.rfind(':');
    return colon == std::string::npos ? name : name.substr(colon + 1);
}

/// One row per class and label, in alphabetical order.
class SensorTable {
   public:
    void add(const LogEntry& entry) {
        if (entry.increment) {
            SensorSummary& row = rowOf("CActionRobotMovement2D", "", entry.stamp);
            row.has_velocities = row.has_velocities && entry.increment->velocity.has_value();
            return;
        }
        const auto& observation = *entry.observation;
        SensorSummary& row =
            rowOf(shortName(observation.GetRuntimeClass()->className), observation.sensorLabel, entry.stamp);
        if (const auto* odometry = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation))
            row.has_velocities = row.has_velocities && odometry->hasVelocities;
        if (const auto* detections = dynamic_cast<const mrpt::obs::CObservationBearingRange*>(&observation))
            count(*detections, row);
    }

    std::vector<SensorSummary> rows() const {
        std::vector<SensorSummary> rows;
        for (const auto& [key, row] : rows_) {
            rows.push_back(row);
            const bool odometry = row.class_name == "CObservationOdometry" || row.class_name == "CActionRobotMovement2D";
            rows.back().has_velocities = odometry && row.has_velocities;
        }
        return rows;
    }

   private:
    SensorSummary& rowOf(const std::string& class_name, const std::string& label, Stamp stamp) {
        SensorSummary& row = rows_[{class_name, label}];
        if (row.count++ == 0) {
            row.class_name = class_name;
            row.label = label;
            row.first = row.last = stamp;
            row.has_velocities = true;  // until an entry lacks them
        }
        row.first = std::min(row.first, stamp);
        row.last = std::max(row.last, stamp);
        return row;
    }

    static void count(const mrpt::obs::CObservationBearingRange& observation, SensorSummary& row) {
        row.detections += static_cast<std::int64_t>(observation.sensedData.size());
        for (const auto& measurement : observation.sensedData) {
            if (measurement.landmarkID >= 0) ++row.identified;
            const bool noise = observation.validCovariances
                                   ? measurement.covariance(0, 0) > 0 && measurement.covariance(1, 1) > 0
                                   : observation.sensor_std_range > 0 && observation.sensor_std_yaw > 0;
            row.has_noise = row.has_noise && noise;
        }
    }

    std::map<std::pair<std::string, std::string>, SensorSummary> rows_;
};

}  // namespace

LogSummary summarise(const std::string& file, const LogParameters& parameters) {
    RawlogReader reader(file, parameters);
    SensorTable sensors;
    while (const auto entry = reader.next()) sensors.add(*entry);

    LogSummary summary;
    summary.format = reader.format();
    summary.timed_by_step = reader.timedByStep();
    summary.end = reader.end();
    summary.end_message = reader.endMessage();
    summary.objects = reader.objects();
    summary.sensors = sensors.rows();
    summary.drops = reader.drops();
    return summary;
}

}  // namespace slamot
