// UTIAS Multi-Robot Cooperative Localization and Mapping dataset (Leung et al., IJRR 30(8), 2011): several
// robots with odometry and a camera that reads bar codes on landmarks and on the other robots; truth by
// motion capture.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <tuple>

#include "Columns.h"
#include "ImportedLog.h"
#include "Importers.h"
#include "slamot/rawlog/LogError.h"

namespace slamot {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t first_landmark_subject = 6;  // those before are the robots, in their order

namespace camera {
// What it claims: spread of its readings against motion capture, rounded up (range 0.07-0.18 m,
// bearing 0.005-0.019 rad over the robots).
constexpr double std_range = 0.15, std_bearing = 0.02;
// Limits that contain every reading of set 6 (0.94 to 8.63 m, -0.592 to 0.572 rad).
constexpr double min_range = 0.5, max_range = 10.0, field_of_view = 1.2;
}  // namespace camera
constexpr double capture_std = 0.001;  // "on the order of 1e-3 m", Leung et al.

constexpr const char* dataset = "the MRCLAM dataset";

/// Subject of each bar code: the measurements give the code, not the subject their header promises.
std::map<std::int64_t, std::int64_t> readBarcodes(const fs::path& folder) {
    std::map<std::int64_t, std::int64_t> subjects;
    forEachRow(folder / "Barcodes.dat", 2, dataset,
               [&](const ColumnRow& row) { subjects[row.integer(1)] = row.integer(0); });
    return subjects;
}

std::map<SourceId, Vector2> readLandmarks(const fs::path& folder) {
    std::map<SourceId, Vector2> landmarks;
    forEachRow(folder / "Landmark_Groundtruth.dat", 3, dataset, [&](const ColumnRow& row) {
        landmarks[SourceId{row.integer(0)}] = {row.number(1), row.number(2)};
    });
    return landmarks;
}

std::vector<TruePose> readTruePoses(const fs::path& file) {
    std::vector<TruePose> poses;
    forEachRow(file, 4, dataset, [&](const ColumnRow& row) {
        const Stamp stamp = row.stamp(0);
        if (!poses.empty() && stamp <= poses.back().stamp) return;
        poses.push_back({stamp, {row.number(1), row.number(2), wrapAngle(row.number(3))}});
    });
    return poses;
}

struct Command {
    Stamp stamp;
    double v, omega;
};

/// The last of those with one stamp; `doubled` counts the others.
std::vector<Command> readCommands(const fs::path& file, std::int64_t& doubled) {
    std::vector<Command> commands;
    forEachRow(file, 3, dataset, [&](const ColumnRow& row) {
        const Command command{row.stamp(0), row.number(1), row.number(2)};
        if (!commands.empty() && command.stamp < commands.back().stamp)
            throw LogError(fmt::format("{}: time goes back to {}, expected rising times", file.string(),
                                       toText(command.stamp)));
        if (!commands.empty() && command.stamp == commands.back().stamp) {
            commands.back() = command;
            ++doubled;
        } else {
            commands.push_back(command);
        }
    });
    return commands;
}

/// A command holds from its stamp to the next one's, where the log's convention wants the velocity noted.
std::vector<OdometryReading> integrate(const std::vector<Command>& commands) {
    std::vector<OdometryReading> readings;
    if (!commands.empty()) readings.push_back({commands.front().stamp, Pose2{}, BodyVelocity{}});
    for (std::size_t i = 1; i < commands.size(); ++i) {
        const BodyVelocity velocity{commands[i - 1].v, 0, commands[i - 1].omega};
        const double dt = secondsBetween(commands[i - 1].stamp, commands[i].stamp);
        readings.push_back({commands[i].stamp, moved(readings.back().pose, velocity, dt), velocity});
    }
    return readings;
}

struct Counts {
    std::int64_t landmarks = 0, movers = 0, unknown = 0, itself = 0;
};

std::vector<ImportedLog::Detection> readDetections(const fs::path& file,
                                                   const std::map<std::int64_t, std::int64_t>& subjects,
                                                   int robot, Counts& counts) {
    std::vector<ImportedLog::Detection> detections;
    forEachRow(file, 4, dataset, [&](const ColumnRow& row) {
        const auto subject = subjects.find(row.integer(1));
        ImportedLog::Detection d{row.stamp(0), "landmarks", row.number(2), row.number(3), {}};
        if (subject == subjects.end()) {
            ++counts.unknown;
        } else if (subject->second == robot) {
            ++counts.itself;
            return;
        } else if (subject->second < first_landmark_subject) {
            d.label = "movers";
            d.id = SourceId{robot_id_base + subject->second};
            ++counts.movers;
        } else {
            d.id = SourceId{subject->second};
            ++counts.landmarks;
        }
        detections.push_back(d);
    });
    return detections;
}

std::vector<TrueAssociation> associations(const std::vector<ImportedLog::Detection>& detections,
                                          const std::vector<int>& indices) {
    std::vector<TrueAssociation> rows;
    for (std::size_t i = 0; i < detections.size(); ++i) {
        const auto& d = detections[i];
        const char* kind = !d.id.valid() ? "clutter" : d.label == "movers" ? "mover" : "landmark";
        rows.push_back({d.stamp, indices[i], kind, d.id});
    }
    std::stable_sort(rows.begin(), rows.end(), [](const TrueAssociation& a, const TrueAssociation& b) {
        return std::tie(a.stamp, a.index) < std::tie(b.stamp, b.index);
    });
    return rows;
}

std::vector<TrueTarget> asTarget(const std::vector<TruePose>& poses) {
    const Vector2 unknown = Vector2::Constant(std::numeric_limits<double>::quiet_NaN());
    std::vector<TrueTarget> samples;
    for (const auto& [stamp, pose] : poses) samples.push_back({stamp, pose.position(), unknown, unknown, ""});
    return samples;
}

}  // namespace

ImportResult importMrclam(const std::string& in, const std::string& out, const ImportProgress& progress) {
    const fs::path folder(in), target(out);
    const auto subjects = readBarcodes(folder);
    Truth shared;
    shared.landmarks = readLandmarks(folder);
    shared.source = "UTIAS MRCLAM, motion capture; velocities are not given";
    shared.position_std = capture_std;

    std::vector<int> robots;
    std::map<int, std::vector<TruePose>> true_poses;
    for (int k = 1; fs::exists(folder / fmt::format("Robot{}_Odometry.dat", k)); ++k) {
        robots.push_back(k);
        true_poses[k] = readTruePoses(folder / fmt::format("Robot{}_Groundtruth.dat", k));
    }
    if (robots.empty())
        throw LogError(fmt::format("{}: holds no Robot1_Odometry.dat, expected an MRCLAM set", in));
    std::error_code error;
    fs::create_directories(target, error);
    if (error) throw LogError(fmt::format("{}: cannot be made ({})", out, error.message()));

    ImportResult result;
    for (const int k : robots) {
        std::int64_t doubled = 0;
        Counts counts;
        ImportedLog log;
        log.odometry = integrate(readCommands(folder / fmt::format("Robot{}_Odometry.dat", k), doubled));
        log.detections =
            readDetections(folder / fmt::format("Robot{}_Measurement.dat", k), subjects, k, counts);
        log.sensor.min_range = camera::min_range;
        log.sensor.max_range = camera::max_range;
        log.sensor.field_of_view = camera::field_of_view;
        log.std_range = camera::std_range;
        log.std_bearing = camera::std_bearing;
        const auto outside = std::count_if(log.detections.begin(), log.detections.end(), [](const auto& d) {
            return d.range < camera::min_range || d.range > camera::max_range ||
                   std::abs(d.bearing) > camera::field_of_view / 2;
        });
        const double share = 1.0 / static_cast<double>(robots.size());
        const std::string file = (target / fmt::format("robot_{}.rawlog", k)).string();
        const auto indices = log.write(file, progress, (k - 1) * share, k * share);

        Truth truth = shared;
        truth.robot = true_poses[k];
        for (const int other : robots)
            if (other != k) truth.targets[SourceId{robot_id_base + other}] = asTarget(true_poses[other]);
        truth.associations = associations(log.detections, indices);
        writeTruth(truth, truthFolderOf(file));

        result.files.push_back(file);
        result.files.push_back(truthFolderOf(file));
        result.notes.push_back(
            fmt::format("robot {}: {} odometry readings ({} commands replaced by a later one of the same "
                        "time; the last command "
                        "has no end and is left out), {} detections of landmarks, {} of robots, {} of "
                        "unknown codes (kept under "
                        "'landmarks' without an id), {} of itself (dropped), {} outside the limits written "
                        "for the sensor",
                        k, log.odometry.size(), doubled, counts.landmarks, counts.movers, counts.unknown,
                        counts.itself, outside));
    }
    return result;
}

}  // namespace slamot
