// Plain tables: the simplest way in for data of one's own. doc/file_formats.md describes the files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <tuple>

#include "ImportedLog.h"
#include "Importers.h"
#include "slamot/core/config/Config.h"
#include "slamot/core/models/RobotMotion.h"
#include "slamot/rawlog/CsvTable.h"
#include "slamot/rawlog/LogError.h"

namespace slamot {
namespace {

namespace fs = std::filesystem;

/// sensor.ini.
struct SensorFile {
    double range_std = 0, bearing_std = 0;
    double min_range = 0, max_range = 0, field_of_view = 2 * pi;
    double x = 0, y = 0, yaw = 0;
    RobotMotionModel model = RobotMotionModel::differential;
    double wheelbase = 4.0;
};

SensorFile readSensorFile(const std::string& file) {
    SensorFile values;
    ParameterTable sensor("sensor", "The range-bearing sensor.");
    sensor.real("range_std", values.range_std, "m", Interval::positive(), "Standard deviation of ranges.")
        .real("bearing_std_deg", values.bearing_std, "deg", Interval::positive(),
              "Standard deviation of bearings.")
        .real("min_range", values.min_range, "m", Interval::nonNegative(), "Nearest range it reports.")
        .real("max_range", values.max_range, "m", Interval::nonNegative(),
              "Farthest range it reports; 0 unlimited.")
        .real("field_of_view_deg", values.field_of_view, "deg", Interval{0, 360, true, false}, "Full width.")
        .real("x", values.x, "m", Interval::any(), "Position on the robot, forward.")
        .real("y", values.y, "m", Interval::any(), "Position on the robot, to the left.")
        .real("yaw_deg", values.yaw, "deg", Interval::between(-180, 180), "Direction on the robot.");
    ParameterTable vehicle("vehicle", "What odometry.csv's v, gamma and omega mean.");
    vehicle
        .choice("model", values.model,
                {{"steered", RobotMotionModel::steered}, {"differential", RobotMotionModel::differential}},
                "steered reads v and gamma, differential reads v and omega.")
        .real("wheelbase", values.wheelbase, "m", Interval::positive(), "For the steered model.");
    const Config config = Config::fromFile(file);
    requireKnownSections(config, {"sensor", "vehicle"});
    load(sensor, config);
    load(vehicle, config);
    for (const char* key : {"range_std", "bearing_std_deg"})
        if (config.section("sensor").count(key) == 0)
            throw LogError(
                fmt::format("{}: section [sensor] lacks '{}', expected a positive number", file, key));
    return values;
}

/// Velocities of the interval that ends at the row's time.
std::vector<OdometryReading> readVelocities(CsvReader& csv, const SensorFile& values) {
    const bool steered = values.model == RobotMotionModel::steered;
    const int t = csv.column("t"), v = csv.column("v"), turning = csv.column(steered ? "gamma" : "omega");
    std::vector<OdometryReading> readings;
    while (csv.next()) {
        const Stamp stamp = csv.risingStamp(t, readings);
        if (steered && std::abs(csv.finite(turning)) >= pi / 2)
            csv.fail(turning, "a steering angle of less than a quarter turn");
        const BodyVelocity velocity =
            steered ? steeredToBody(csv.finite(v), csv.finite(turning), values.wheelbase)
                    : BodyVelocity{csv.finite(v), 0, csv.finite(turning)};
        const Pose2 pose = readings.empty() ? Pose2{}
                                            : moved(readings.back().pose, velocity,
                                                    secondsBetween(readings.back().stamp, stamp));
        readings.push_back({stamp, pose, velocity});
    }
    return readings;
}

std::vector<OdometryReading> readPoses(CsvReader& csv) {
    const int t = csv.column("t"), x = csv.column("x"), y = csv.column("y"), theta = csv.column("theta");
    std::vector<OdometryReading> readings;
    while (csv.next()) {
        const Stamp stamp = csv.risingStamp(t, readings);
        readings.push_back(
            {stamp, {csv.finite(x), csv.finite(y), wrapAngle(csv.finite(theta))}, std::nullopt});
    }
    return readings;
}

std::vector<OdometryReading> readOdometry(const std::string& file, const SensorFile& values) {
    CsvReader csv(file);
    if (csv.has("v")) return readVelocities(csv, values);
    return readPoses(csv);
}

std::vector<ImportedLog::Detection> readDetections(const std::string& file) {
    CsvReader csv(file);
    const int t = csv.column("t"), kind = csv.column("kind"), id = csv.column("id");
    const int range = csv.column("range"), bearing = csv.column("bearing");
    std::vector<ImportedLog::Detection> detections;
    while (csv.next()) {
        const std::string word = csv.text(kind);
        const char* label = word == "landmark" ? "landmarks" : word == "mover" ? "movers" : "mixed";
        if (word != "landmark" && word != "mover" && word != "unknown")
            csv.fail(kind, "landmark, mover or unknown");
        const SourceId source = csv.empty(id) ? SourceId{} : SourceId{csv.integer(id)};
        if (source.value < -1) csv.fail(id, "an id of at least 0, or -1 or nothing when it is unknown");
        // Not finite ones too: a log shows what a sensor said, and the run counts what it cannot use.
        detections.push_back({csv.stamp(t), label, csv.number(range), csv.number(bearing), source});
    }
    return detections;
}

void requireDetections(const std::vector<TrueAssociation>& associations,
                       const std::vector<ImportedLog::Detection>& detections, const std::string& file) {
    std::map<Stamp, int> in_stamp;
    for (const auto& detection : detections) ++in_stamp[detection.stamp];
    for (const auto& row : associations)
        if (row.index < 0 || row.index >= in_stamp[row.stamp])
            throw LogError(
                fmt::format("{}: the association at t = {} with index {} has no detection in "
                            "observations.csv",
                            file, toText(row.stamp), row.index));
}

/// The n-th detection of a stamp in observations.csv is another one in the log, which is sorted by label.
void renumber(std::vector<TrueAssociation>& associations,
              const std::vector<ImportedLog::Detection>& detections, const std::vector<int>& indices) {
    std::map<Stamp, std::vector<int>> in_log;
    for (std::size_t i = 0; i < detections.size(); ++i) in_log[detections[i].stamp].push_back(indices[i]);
    for (auto& row : associations) row.index = in_log.at(row.stamp)[row.index];
    std::stable_sort(associations.begin(), associations.end(),
                     [](const TrueAssociation& a, const TrueAssociation& b) {
                         return std::tie(a.stamp, a.index) < std::tie(b.stamp, b.index);
                     });
}

bool hasTruth(const fs::path& folder) {
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name == "robot.csv" || name == "landmarks.csv" || name == "associations.csv") return true;
        if (name.rfind("target_", 0) == 0 && entry.path().extension() == ".csv") return true;
    }
    return false;
}

}  // namespace

ImportResult importCsv(const std::string& in, const std::string& out, const ImportProgress& progress) {
    const fs::path folder(in);
    if (!fs::is_directory(folder))
        throw LogError(
            fmt::format("{}: is no folder, expected one with odometry.csv and observations.csv", in));
    const SensorFile values = readSensorFile((folder / "sensor.ini").string());
    ImportedLog log;
    log.odometry = readOdometry((folder / "odometry.csv").string(), values);
    log.detections = readDetections((folder / "observations.csv").string());
    log.sensor.pose = {values.x, values.y, values.yaw};
    log.sensor.min_range = values.min_range;
    log.sensor.max_range = values.max_range;
    log.sensor.field_of_view = values.field_of_view;
    log.std_range = values.range_std;
    log.std_bearing = values.bearing_std;
    if (log.odometry.empty() && log.detections.empty())
        throw LogError(fmt::format("{}: odometry.csv and observations.csv hold no rows, expected data", in));
    // All is read before anything is written.
    std::optional<Truth> truth;
    if (hasTruth(folder)) {
        truth = readTruth(in);
        requireDetections(truth->associations, log.detections, (folder / "associations.csv").string());
    }
    const auto indices = log.write(out, progress, 0, 1);

    ImportResult result;
    result.files.push_back(out);
    result.notes.push_back(
        fmt::format("{} odometry readings, {} detections", log.odometry.size(), log.detections.size()));
    if (truth) {
        renumber(truth->associations, log.detections, indices);
        writeTruth(*truth, truthFolderOf(out));
        result.files.push_back(truthFolderOf(out));
    } else {
        result.notes.push_back("no truth");
    }
    return result;
}

}  // namespace slamot
