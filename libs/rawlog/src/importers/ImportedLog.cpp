#include "ImportedLog.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "slamot/rawlog/LogError.h"

namespace slamot {

Pose2 moved(const Pose2& pose, const BodyVelocity& velocity, double seconds) {
    const double turn = velocity.omega * seconds;
    // Integral of Rot(omega t) over the time: sin(a)/a and (1 - cos(a))/a, by their series near zero.
    const bool small = std::abs(turn) < 1e-4;
    const double s = small ? 1 - turn * turn / 6 : std::sin(turn) / turn;
    const double c = small ? turn / 2 - turn * turn * turn / 24 : (1 - std::cos(turn)) / turn;
    const double x = velocity.vx * seconds, y = velocity.vy * seconds;
    return pose * Pose2{s * x - c * y, c * x + s * y, turn};
}

std::vector<int> ImportedLog::write(const std::string& file, const std::function<bool(double)>& progress,
                                    double begin, double end) const {
    // Scans in the order of the log, each with its detections.
    std::map<std::pair<Stamp, std::string>, std::vector<std::size_t>> scans;
    for (std::size_t i = 0; i < detections.size(); ++i)
        scans[{detections[i].stamp, detections[i].label}].push_back(i);
    for (const Stamp stamp : empty_scans) scans[{stamp, empty_label}];

    RawlogWriter writer(file);
    std::vector<int> index_in_stamp(detections.size());
    std::size_t next_odometry = 0, written = 0;
    const auto count = [&] {
        constexpr std::size_t report_every = 4096;
        const double part =
            static_cast<double>(written) / static_cast<double>(odometry.size() + detections.size());
        if (written++ % report_every == 0 && progress && !progress(begin + (end - begin) * part))
            throw LogError(
                fmt::format("{}: stopped before its end, the .part file holds what was written", file));
    };
    const auto writeOdometryUpTo = [&](Stamp stamp) {
        for (; next_odometry < odometry.size() && odometry[next_odometry].stamp <= stamp;
             ++next_odometry, count())
            writer.write(*toMrpt(odometry[next_odometry], "odometry"));
    };
    int index = 0;
    const Stamp* last_stamp = nullptr;
    for (const auto& [key, indices] : scans) {
        const auto& [stamp, label] = key;
        if (!last_stamp || *last_stamp != stamp) index = 0;
        last_stamp = &stamp;
        writeOdometryUpTo(stamp);
        RangeBearingReading reading;
        reading.stamp = stamp;
        reading.sensor = sensor;
        reading.sensor.label = label;
        for (const std::size_t i : indices) {
            RangeBearingReading::Item item;
            item.range = detections[i].range;
            item.bearing = detections[i].bearing;
            item.id = detections[i].id;
            reading.items.push_back(item);
            index_in_stamp[i] = index++;
            count();
        }
        writer.write(*toMrpt(reading, std_range, std_bearing));
    }
    if (!odometry.empty()) writeOdometryUpTo(odometry.back().stamp);
    writer.close();
    return index_in_stamp;
}

}  // namespace slamot
