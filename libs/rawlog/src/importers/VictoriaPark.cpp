// The Victoria Park dataset (Guivant and Nebot, IEEE Transactions on Robotics and Automation 17(3), 2001), as
// RFS-SLAM has it: a utility car among trees, detections of trunks made from a laser's scans, speed and
// steering, GPS.
#include "VictoriaPark.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "ImportedLog.h"
#include "Importers.h"
#include "slamot/rawlog/LogError.h"

namespace slamot {

namespace fs = std::filesystem;

namespace {

// The encoder is at the left rear wheel, half_track off the middle of the axle.
constexpr double wheelbase = 2.83, half_track = 0.76;
namespace laser {
// Contain every reading (1.48 to 75.3 m); the laser sees half a turn and its makers say 80 m.
constexpr double min_range = 1.0, max_range = 80.0, field_of_view = pi;
// What the log claims for a trunk's centre; see doc/file_formats.md.
constexpr double std_range = 0.2, std_bearing = 0.014;
}  // namespace laser
constexpr const char* label = "landmarks";
constexpr int laser_in_manager = 3;

// GPS comes every 0.2 s. A fix is wild that the car, at most 6.7 m/s fast, could reach neither from the one
// before nor the one after from it: the noise of two fixes and twice its speed are allowed for.
constexpr double longest_gps_step = 0.25;
constexpr double allowed_jump = 10.0, allowed_speed = 10.0;

void requireRising(const ColumnRow& row, Stamp stamp, const Stamp* last) {
    if (last && stamp <= *last) row.fail(0, "a time later than the row before, which has " + toText(*last));
}

/// v of the middle of the rear axle from the speed of its left wheel.
BodyVelocity bodyVelocity(double wheel_speed, double steering) {
    const double v = wheel_speed / (1 - std::tan(steering) * half_track / wheelbase);
    return {v, 0, v * std::tan(steering) / wheelbase};
}

/// A row's speed and steering are taken for the interval that ends at its time.
std::vector<OdometryReading> readOdometry(const fs::path& file) {
    std::vector<OdometryReading> readings;
    forEachRow(file, 3, victoria_park::dataset, [&](const ColumnRow& row) {
        const Stamp stamp = row.stamp(0);
        requireRising(row, stamp, readings.empty() ? nullptr : &readings.back().stamp);
        constexpr double largest_steering = 1.0;
        if (std::abs(row.number(2)) > largest_steering) row.fail(2, "a steering angle within 1 rad");
        const BodyVelocity velocity = bodyVelocity(row.number(1), row.number(2));
        const Pose2 pose = readings.empty() ? Pose2{}
                                            : moved(readings.back().pose, velocity,
                                                    secondsBetween(readings.back().stamp, stamp));
        readings.push_back({stamp, pose, velocity});
    });
    if (readings.empty())
        throw LogError(fmt::format("{}: holds no rows, expected speed and steering", file.string()));
    return readings;
}

std::vector<ImportedLog::Detection> readDetections(const fs::path& file) {
    std::vector<ImportedLog::Detection> detections;
    forEachRow(file, 4, victoria_park::dataset, [&](const ColumnRow& row) {
        const Stamp stamp = row.stamp(0);
        if (!detections.empty() && stamp < detections.back().stamp)
            row.fail(0, "a time not before the row before, which has " + toText(detections.back().stamp));
        const double range = row.number(1), bearing = row.number(2);
        if (range <= 0) row.fail(1, "a range above 0");
        if (bearing < 0 || bearing > pi) row.fail(2, "a bearing from 0 to pi, pi / 2 being straight ahead");
        detections.push_back({stamp, label, range, bearing - pi / 2, {}});
    });
    return detections;
}

/// Scans that saw no tree are in the list of all sensors' readings alone.
std::vector<Stamp> readEmptyScans(const fs::path& file,
                                  const std::vector<ImportedLog::Detection>& detections) {
    std::set<Stamp> seen;
    for (const auto& d : detections) seen.insert(d.stamp);
    std::vector<Stamp> empty;
    if (!fs::exists(file)) return empty;
    forEachRow(file, 3, victoria_park::dataset, [&](const ColumnRow& row) {
        const Stamp stamp = row.stamp(0);
        if (row.integer(1) == laser_in_manager && seen.insert(stamp).second) empty.push_back(stamp);
    });
    return empty;
}

bool isOutOfReach(const TruePose& a, const TruePose& b) {
    return (b.pose.position() - a.pose.position()).norm() >
           allowed_jump + allowed_speed * secondsBetween(a.stamp, b.stamp);
}

/// Without wild fixes, which are counted. The heading is not known.
std::vector<TruePose> readGps(const fs::path& file, std::vector<Stamp>& wild) {
    std::vector<TruePose> fixes;
    forEachRow(file, 3, victoria_park::dataset, [&](const ColumnRow& row) {
        const Stamp stamp = row.stamp(0);
        requireRising(row, stamp, fixes.empty() ? nullptr : &fixes.back().stamp);
        fixes.push_back({stamp, {row.number(1), row.number(2), std::numeric_limits<double>::quiet_NaN()}});
    });
    std::vector<TruePose> kept;
    for (std::size_t i = 0; i < fixes.size(); ++i) {
        const bool is_wild = i > 0 && i + 1 < fixes.size() && isOutOfReach(fixes[i - 1], fixes[i]) &&
                             isOutOfReach(fixes[i], fixes[i + 1]);
        if (is_wild)
            wild.push_back(fixes[i].stamp);
        else
            kept.push_back(fixes[i]);
    }
    return kept;
}

/// What is labelled, for associations.csv: of the others nobody knows the tree.
std::vector<TrueAssociation> associations(const ImportedLog& log, const std::vector<int>& indices) {
    std::vector<TrueAssociation> rows;
    for (std::size_t i = 0; i < log.detections.size(); ++i)
        if (const auto& d = log.detections[i]; d.id.valid())
            rows.push_back({d.stamp, indices[i], "landmark", d.id});
    return rows;
}

}  // namespace

ImportResult importVictoriaPark(const std::string& in, const std::string& out,
                                const ImportProgress& progress) {
    const fs::path folder(in);
    ImportedLog log;
    log.odometry = readOdometry(folder / "inputs.dat");
    log.detections = readDetections(folder / "measurements.dat");
    log.empty_scans = readEmptyScans(folder / "Sensors_manager.txt", log.detections);
    log.empty_label = label;
    log.sensor.pose = victoria_park::laser;
    log.sensor.min_range = laser::min_range;
    log.sensor.max_range = laser::max_range;
    log.sensor.field_of_view = laser::field_of_view;
    log.std_range = laser::std_range;
    log.std_bearing = laser::std_bearing;
    Truth truth;
    std::vector<Stamp> wild;
    truth.robot = readGps(folder / "gps.dat", wild);
    truth.max_interpolation_gap = longest_gps_step;
    truth.source =
        "Victoria Park, GPS: position of the antenna, taken to be the laser's; no heading; accuracy not "
        "stated, jumps "
        "of several metres occur; wild fixes are left out";
    truth.point = victoria_park::laser.position();
    const fs::path isam = folder / "isam_associations.txt";
    std::string labels = "no isam_associations.txt, no detection has an id";
    if (fs::exists(isam)) {
        const victoria_park::LabelCounts counts = victoria_park::labelFromIsam(isam, log);
        labels = fmt::format(
            "{} of the {} landmark observations in isam_associations.txt are detections of their scan within "
            "{} m, "
            "which have their ids; the other detections have none",
            counts.found, counts.total, victoria_park::label_distance);
    }

    const auto indices = log.write(out, progress, 0, 1);
    truth.associations = associations(log, indices);
    writeTruth(truth, truthFolderOf(out));

    ImportResult result;
    result.files = {out, truthFolderOf(out)};
    std::set<Stamp> scans(log.empty_scans.begin(), log.empty_scans.end());
    for (const auto& d : log.detections) scans.insert(d.stamp);
    result.notes.push_back(fmt::format(
        "{} odometry readings; {} scans with {} detections, {} of the scans empty; diameters are left out, "
        "MRPT's detections have no place for them",
        log.odometry.size(), scans.size(), log.detections.size(), log.empty_scans.size()));
    std::string left_out;
    for (const Stamp stamp : wild) left_out += (left_out.empty() ? " (t = " : ", ") + toText(stamp);
    result.notes.push_back(fmt::format("{} GPS fixes as weak truth, {} wild ones left out{}",
                                       truth.robot.size(), wild.size(),
                                       left_out.empty() ? "" : left_out + ")"));
    result.notes.push_back(labels);
    return result;
}

}  // namespace slamot
