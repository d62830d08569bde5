#include "ImportedLog.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

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

std::vector<int> ImportedLog::write(const std::string& file, const std::function<bool(double)>& progress, double begin,
                                    double end) const {
    std::vector<std::size_t> order(detections.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [this](std::size_t i, std::size_t j) {
        const Detection &a = detections[i], &b = detections[j];
        return std::tie(a.stamp, a.label) < std::tie(b.stamp, b.label);
    });

    RawlogWriter writer(file);
    std::vector<int> index_in_stamp(detections.size());
    std::size_t next_odometry = 0, written = 0;
    const auto count = [&] {
        constexpr std::size_t report_every = 4096;
        const double part = static_cast<double>(written) / static_cast<double>(odometry.size() + detections.size());
        if (written++ % report_every == 0 && progress && !progress(begin + (end - begin) * part))
            throw LogError(fmt::format("{}: stopped before its end, the .part file holds what was written", file));
    };
    const auto writeOdometryUpTo = [&](Stamp stamp) {
        for (; next_odometry < odometry.size() && odometry[next_odometry].stamp <= stamp; ++next_odometry, count())
            writer.write(*toMrpt(odometry[next_odometry], "odometry"));
    };
    int index = 0;
    for (std::size_t i = 0; i < order.size();) {
        const Detection& first = detections[order[i]];
        if (i > 0 && detections[order[i - 1]].stamp != first.stamp) index = 0;
        writeOdometryUpTo(first.stamp);
        RangeBearingReading reading;
        reading.stamp = first.stamp;
        reading.sensor = sensor;
        reading.sensor.label = first.label;
        for (; i < order.size(); ++i, count()) {
            const Detection& d = detections[order[i]];
            if (d.stamp != first.stamp || d.label != first.label) break;
            RangeBearingReading::Item item;
            item.range = d.range;
            item.bearing = d.bearing;
            item.id = d.id;
            reading.items.push_back(item);
            index_in_stamp[order[i]] = index++;
        }
        writer.write(*toMrpt(reading, std_range, std_bearing));
    }
    if (!odometry.empty()) writeOdometryUpTo(odometry.back().stamp);
    writer.close();
    return index_in_stamp;
}

}  // namespace slamot
