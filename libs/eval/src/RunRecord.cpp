#include "slamot/eval/RunRecord.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "slamot/rawlog/CsvTable.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::eval {
namespace {

double finite(const CsvReader& table, int column) {
    const double value = table.number(column);
    if (!std::isfinite(value)) table.fail(column, "a finite number");
    return value;
}

/// The number of `column`, or `none` where the file has no such column.
std::int64_t idOrNone(const CsvReader& table, const std::optional<int>& column) {
    return column && !table.empty(*column) ? table.integer(*column) : -1;
}

std::optional<int> columnIfAny(const CsvReader& table, const std::string& name) {
    return table.has(name) ? std::optional<int>(table.column(name)) : std::nullopt;
}

/// The value of `all` whose toText is in the field.
template <class Enum, std::size_t N>
Enum word(const CsvReader& table, int column, const std::array<Enum, N>& all) {
    std::string expected;
    for (const Enum value : all) {
        if (table.text(column) == toText(value)) return value;
        expected += fmt::format("{}{}", expected.empty() ? "one of " : ", ", toText(value));
    }
    table.fail(column, expected);
}

/// Columns of a symmetric matrix's upper triangle, row by row.
template <int N>
class SymmetricColumns {
  public:
    template <class NameOf>
    SymmetricColumns(const CsvReader& table, NameOf name_of) {
        for (int r = 0; r < N; ++r)
            for (int c = r; c < N; ++c) columns_.push_back(table.column(name_of(r, c)));
    }
    Eigen::Matrix<double, N, N> read(const CsvReader& table) const {
        Eigen::Matrix<double, N, N> m;
        auto column = columns_.begin();
        for (int r = 0; r < N; ++r)
            for (int c = r; c < N; ++c) m(r, c) = m(c, r) = finite(table, *column++);
        return m;
    }

  private:
    std::vector<int> columns_;
};

std::vector<RobotRow> readTrajectory(const std::string& file) {
    CsvReader table(file, LastLine::may_be_cut);
    const int t = table.column("t"), x = table.column("x"), y = table.column("y"),
              theta = table.column("theta");
    const SymmetricColumns<3> covariance(
        table, [](int r, int c) { return fmt::format("c_{}{}", "xyt"[r], "xyt"[c]); });
    std::vector<RobotRow> rows;
    while (table.next()) {
        const Stamp stamp = table.stamp(t);
        if (!rows.empty() && stamp <= rows.back().stamp)
            table.fail(t,
                       fmt::format("a time after the row before ({} s)", slamot::toText(rows.back().stamp)));
        const Pose2 pose{finite(table, x), finite(table, y), wrapAngle(finite(table, theta))};
        rows.push_back({stamp, {pose, covariance.read(table)}});
    }
    return rows;
}

void readTracks(const std::string& file, RunRecord& run) {
    CsvReader table(file, LastLine::may_be_cut);
    const int t = table.column("t"), id = table.column("track"), existence = table.column("existence");
    std::array<int, 6> state{};
    const std::array<const char*, 6> names{"x", "y", "vx", "vy", "ax", "ay"};
    for (std::size_t i = 0; i < 6; ++i) state[i] = table.column(names[i]);
    const SymmetricColumns<6> covariance(table, [](int r, int c) { return fmt::format("c_{}_{}", r, c); });
    const auto source = columnIfAny(table, "source_id"), moving = columnIfAny(table, "moving");
    std::vector<int> modes;
    for (const std::string& name : table.header())
        if (name.rfind("p_", 0) == 0) {
            run.mode_names.push_back(name.substr(2));
            modes.push_back(table.column(name));
        }

    while (table.next()) {
        TrackEstimate track;
        track.id = {table.integer(id)};
        track.source = {idOrNone(table, source)};
        for (std::size_t i = 0; i < 6; ++i)
            track.mean(static_cast<Eigen::Index>(i)) = finite(table, state[i]);
        track.covariance = covariance.read(table);
        track.existence = finite(table, existence);
        if (moving) track.moving = finite(table, *moving);
        for (const int mode : modes) track.mode_probabilities.push_back(finite(table, mode));
        run.tracks[table.stamp(t)].push_back(std::move(track));
    }
}

std::vector<LandmarkEstimate> readLandmarks(const std::string& file) {
    CsvReader table(file, LastLine::may_be_cut);
    const int id = table.column("id"), x = table.column("x"), y = table.column("y"),
              seen = table.column("seen");
    const int first = table.column("first_t"), last = table.column("last_t");
    const SymmetricColumns<2> covariance(
        table, [](int r, int c) { return fmt::format("c_{}{}", "xy"[r], "xy"[c]); });
    const auto source = columnIfAny(table, "source_id"), existence = columnIfAny(table, "existence"),
               moving = columnIfAny(table, "moving");
    std::vector<LandmarkEstimate> landmarks;
    while (table.next()) {
        LandmarkEstimate landmark;
        landmark.id = {table.integer(id)};
        landmark.source = {idOrNone(table, source)};
        landmark.mean = {finite(table, x), finite(table, y)};
        landmark.covariance = covariance.read(table);
        landmark.seen = table.integer(seen);
        landmark.first_seen = table.stamp(first);
        landmark.last_seen = table.stamp(last);
        if (existence) landmark.existence = finite(table, *existence);
        if (moving) landmark.moving = finite(table, *moving);
        landmarks.push_back(landmark);
    }
    return landmarks;
}

std::vector<InnovationRow> readInnovations(const std::string& file) {
    CsvReader table(file, LastLine::may_be_cut);
    const int t = table.column("t"), sensor = table.column("sensor"), kind = table.column("kind");
    const int landmark = table.column("landmark"), track = table.column("track"),
              outcome = table.column("outcome");
    const int r_range = table.column("r_range"), r_bearing = table.column("r_bearing"),
              nis = table.column("nis");
    const int s_rr = table.column("s_rr"), s_rb = table.column("s_rb"), s_bb = table.column("s_bb");
    const auto detection = columnIfAny(table, "detection"), log_number = columnIfAny(table, "log_number"),
               log_count = columnIfAny(table, "log_count");
    const std::array kinds{ObjectKind::landmark, ObjectKind::mover, ObjectKind::unknown};
    const std::array outcomes{Outcome::updated,   Outcome::inflated,  Outcome::rejected,
                              Outcome::initiated, Outcome::tentative, Outcome::ignored};
    std::vector<InnovationRow> rows;
    while (table.next()) {
        InnovationRow row;
        row.stamp = table.stamp(t);
        row.sensor = table.text(sensor);
        Innovation& i = row.innovation;
        i.detection = static_cast<int>(idOrNone(table, detection));
        i.kind = word(table, kind, kinds);
        i.landmark = {idOrNone(table, landmark)};
        i.track = {idOrNone(table, track)};
        i.outcome = word(table, outcome, outcomes);
        i.residual = {table.number(r_range), table.number(r_bearing)};
        const double rb = table.number(s_rb);
        i.covariance << table.number(s_rr), rb, rb, table.number(s_bb);
        i.nis = table.number(nis);
        if (log_number && log_count)
            row.log = LogNumber{static_cast<int>(table.integer(*log_number)),
                                static_cast<int>(table.integer(*log_count))};
        rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace

RunRecord readRun(const std::string& folder) {
    const std::filesystem::path path(folder);
    const auto file = [&path](const char* name) { return (path / name).string(); };
    const auto there = [&path](const char* name) { return std::filesystem::exists(path / name); };
    RunRecord run;
    run.trajectory = readTrajectory(file("trajectory.csv"));
    if (there("tracks.csv")) readTracks(file("tracks.csv"), run);
    if (there("landmarks.csv")) run.landmarks = readLandmarks(file("landmarks.csv"));
    if (there("innovations.csv")) run.innovations = readInnovations(file("innovations.csv"));
    return run;
}

}  // namespace slamot::eval
