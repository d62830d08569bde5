#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "slamot/core/config/Parameters.h"
#include "slamot/rawlog/CsvTable.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/Truth.h"

namespace slamot {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* gap_key = "gap_means_longer_than_seconds";
const std::string target_prefix = "target_", target_suffix = ".csv";

std::vector<TruePose> readRobot(const std::string& file) {
    CsvReader csv(file);
    const int t = csv.column("t"), x = csv.column("x"), y = csv.column("y"), theta = csv.column("theta");
    std::vector<TruePose> poses;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    while (csv.next())
        poses.push_back(
            {csv.risingStamp(t, poses),
             {csv.finite(x), csv.finite(y), csv.empty(theta) ? unknown : wrapAngle(csv.finite(theta))}});
    return poses;
}

std::vector<TrueTarget> readTarget(const std::string& file) {
    CsvReader csv(file);
    const int t = csv.column("t"), x = csv.column("x"), y = csv.column("y");
    const auto optional = [&](const char* name) { return csv.has(name) ? csv.column(name) : -1; };
    const int vx = optional("vx"), vy = optional("vy"), ax = optional("ax"), ay = optional("ay");
    const int mode = optional("mode");
    const auto number = [&](int column) {
        return column < 0 ? std::numeric_limits<double>::quiet_NaN() : csv.number(column);
    };
    std::vector<TrueTarget> samples;
    while (csv.next())
        samples.push_back({csv.risingStamp(t, samples),
                           {csv.number(x), csv.number(y)},
                           {number(vx), number(vy)},
                           {number(ax), number(ay)},
                           mode < 0 ? "" : csv.text(mode)});
    return samples;
}

SourceId idOfTargetFile(const fs::path& file) {
    const std::string name = file.filename().string();
    const std::string digits =
        name.substr(target_prefix.size(), name.size() - target_prefix.size() - target_suffix.size());
    const bool number =
        !digits.empty() && digits.size() <= 18 &&
        std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!number)
        throw LogError(
            fmt::format("{}: expected a name like target_7.csv with the target's id", file.string()));
    return SourceId{std::stoll(digits)};
}

bool isTargetFile(const fs::path& file) {
    const std::string name = file.filename().string();
    return name.size() > target_prefix.size() + target_suffix.size() && name.rfind(target_prefix, 0) == 0 &&
           file.extension() == target_suffix;
}

std::map<SourceId, Vector2> readLandmarks(const std::string& file) {
    CsvReader csv(file);
    const int id = csv.column("id"), x = csv.column("x"), y = csv.column("y");
    std::map<SourceId, Vector2> landmarks;
    while (csv.next())
        if (!landmarks.emplace(SourceId{csv.integer(id)}, Vector2{csv.finite(x), csv.finite(y)}).second)
            csv.fail(id, "an id that is not given twice");
    return landmarks;
}

std::vector<TrueAssociation> readAssociations(const std::string& file) {
    CsvReader csv(file);
    const int t = csv.column("t"), index = csv.column("index"), kind = csv.column("kind"),
              id = csv.column("id");
    std::vector<TrueAssociation> associations;
    while (csv.next()) {
        const std::string word = csv.text(kind);
        if (word != "landmark" && word != "mover" && word != "clutter")
            csv.fail(kind, "landmark, mover or clutter");
        associations.push_back(
            {csv.stamp(t), static_cast<int>(csv.integer(index)), word, SourceId{csv.integer(id)}});
    }
    return associations;
}

void readNotes(const std::string& file, Truth& truth) {
    std::ifstream in(file);
    try {
        const json notes = json::parse(in);
        truth.frame = notes.value("frame", truth.frame);
        truth.source = notes.value("source", truth.source);
        truth.position_std = notes.value("position_std", truth.position_std);
        if (notes.contains("point_on_robot"))
            truth.point = {notes["point_on_robot"].at(0).get<double>(),
                           notes["point_on_robot"].at(1).get<double>()};
        truth.max_interpolation_gap = notes.value(gap_key, truth.max_interpolation_gap);
    } catch (const json::exception& error) {
        // The reason stands after the library's own name for it, in brackets.
        const std::string what = error.what(),
                          reason = what.substr(std::min(what.size(), what.find("] ") + 2));
        throw LogError(
            fmt::format("{}: expected a JSON object with texts 'frame' and 'source', numbers 'position_std' "
                        "and '{}' and a pair of numbers 'point_on_robot' ({})",
                        file, gap_key, reason));
    }
    if (!(truth.max_interpolation_gap > 0))
        throw LogError(fmt::format("{}: '{}' is {}, expected a positive number of seconds", file, gap_key,
                                   truth.max_interpolation_gap));
}

/// A file written whole: an error while writing is reported, not swallowed.
class TextFile {
  public:
    explicit TextFile(const fs::path& file) : name_(file.string()), out_(file) {
        if (!out_) throw LogError(fmt::format("{}: cannot be written", name_));
    }
    void line(const std::string& text) { out_ << text << '\n'; }
    void close() {
        out_.close();
        if (!out_) throw LogError(fmt::format("{}: cannot be written to its end", name_));
    }

  private:
    std::string name_;
    std::ofstream out_;
};

void appendKnown(std::string& line, double value) {
    if (std::isnan(value))
        appendField(line, std::string_view());
    else
        appendField(line, value);
}

void writeRobot(const std::vector<TruePose>& robot, const fs::path& file) {
    TextFile out(file);
    out.line("t,x,y,theta");
    for (const auto& [stamp, pose] : robot) {
        std::string line;
        appendField(line, stamp);
        appendField(line, pose.x);
        appendField(line, pose.y);
        appendKnown(line, pose.theta);
        out.line(line);
    }
    out.close();
}

void writeTarget(const std::vector<TrueTarget>& samples, const fs::path& file) {
    TextFile out(file);
    out.line("t,x,y,vx,vy,ax,ay,mode");
    for (const auto& s : samples) {
        std::string line;
        appendField(line, s.stamp);
        for (const Vector2* v : {&s.position, &s.velocity, &s.acceleration})
            for (const double value : {v->x(), v->y()}) appendKnown(line, value);
        appendField(line, std::string_view(s.mode));
        out.line(line);
    }
    out.close();
}

void writeLandmarks(const std::map<SourceId, Vector2>& landmarks, const fs::path& file) {
    TextFile out(file);
    out.line("id,x,y");
    for (const auto& [id, position] : landmarks) {
        std::string line;
        appendField(line, id.value);
        appendField(line, position.x());
        appendField(line, position.y());
        out.line(line);
    }
    out.close();
}

void writeAssociations(const std::vector<TrueAssociation>& associations, const fs::path& file) {
    TextFile out(file);
    out.line("t,index,kind,id");
    for (const auto& a : associations) {
        std::string line;
        appendField(line, a.stamp);
        appendField(line, static_cast<std::int64_t>(a.index));
        appendField(line, std::string_view(a.kind));
        appendField(line, a.id.value);
        out.line(line);
    }
    out.close();
}

/// Number of samples, and of gaps that are not interpolated across, with the largest.
template <class Sample>
json coverage(const std::vector<Sample>& samples, double max_gap) {
    std::int64_t gaps = 0;
    double largest = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const double step = secondsBetween(samples[i - 1].stamp, samples[i].stamp);
        if (step > max_gap) ++gaps;
        largest = std::max(largest, step);
    }
    return {{"samples", samples.size()}, {"gaps", gaps}, {"largest_step_seconds", largest}};
}

void writeNotes(const Truth& truth, const fs::path& file) {
    json notes = {{"frame", truth.frame},
                  {"source", truth.source},
                  {"position_std", truth.position_std},
                  {"point_on_robot", {truth.point.x(), truth.point.y()}},
                  {gap_key, truth.max_interpolation_gap},
                  {"landmarks", truth.landmarks.size()},
                  {"associations", truth.associations.size()},
                  {"robot", coverage(truth.robot, truth.max_interpolation_gap)},
                  {"targets", json::object()}};
    for (const auto& [id, samples] : truth.targets)
        notes["targets"][std::to_string(id.value)] = coverage(samples, truth.max_interpolation_gap);
    TextFile out(file);
    out.line(notes.dump(2));
    out.close();
}

}  // namespace

Truth readTruth(const std::string& folder) {
    if (!fs::is_directory(folder))
        throw LogError(fmt::format("{}: is no folder, expected one with truth", folder));
    const fs::path in(folder);
    // A run's landmarks.csv has the columns of a true one: taken for truth it would find no error at all.
    if (fs::exists(in / "trajectory.csv"))
        throw LogError(fmt::format("{}: is the output of a run, expected a folder with truth", folder));
    Truth truth;
    bool any = false;
    const auto present = [&](const char* name) { return fs::exists(in / name) && (any = true); };
    if (present("robot.csv")) truth.robot = readRobot((in / "robot.csv").string());
    if (present("landmarks.csv")) truth.landmarks = readLandmarks((in / "landmarks.csv").string());
    if (present("associations.csv"))
        truth.associations = readAssociations((in / "associations.csv").string());
    for (const auto& entry : fs::directory_iterator(in)) {
        if (!isTargetFile(entry.path())) continue;
        any = true;
        truth.targets[idOfTargetFile(entry.path())] = readTarget(entry.path().string());
    }
    if (!any)
        throw LogError(fmt::format(
            "{}: holds no truth, expected robot.csv, target_<id>.csv, landmarks.csv or associations.csv",
            folder));
    if (fs::exists(in / "truth.json")) readNotes((in / "truth.json").string(), truth);
    return truth;
}

void writeTruth(const Truth& truth, const std::string& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw LogError(fmt::format("{}: cannot be made ({})", folder, error.message()));
    const fs::path out(folder);
    // A folder written twice must not keep what the second truth lacks.
    for (const char* name : {"robot.csv", "landmarks.csv", "associations.csv"}) fs::remove(out / name);
    std::vector<fs::path> stale;
    for (const auto& entry : fs::directory_iterator(out))
        if (isTargetFile(entry.path())) stale.push_back(entry.path());
    for (const auto& file : stale) fs::remove(file);

    writeRobot(truth.robot, out / "robot.csv");
    if (!truth.landmarks.empty()) writeLandmarks(truth.landmarks, out / "landmarks.csv");
    if (!truth.associations.empty()) writeAssociations(truth.associations, out / "associations.csv");
    for (const auto& [id, samples] : truth.targets)
        writeTarget(samples, out / (target_prefix + std::to_string(id.value) + target_suffix));
    writeNotes(truth, out / "truth.json");
}

}  // namespace slamot
