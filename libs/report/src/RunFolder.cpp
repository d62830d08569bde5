#include "slamot/report/RunFolder.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "SummaryFile.h"
#include "slamot/eval/Metrics.h"
#include "slamot/rawlog/CsvTable.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::report {
namespace {

namespace fs = std::filesystem;

constexpr const char* no_truth = "none";

std::string bytesOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
}

double finite(const CsvReader& table, int column) {
    const double value = table.number(column);
    if (!std::isfinite(value)) {
        table.fail(column, "a finite number");
    }
    return value;
}

std::vector<StepRow> readSteps(const std::string& file) {
    CsvReader table(file, LastLine::may_be_cut);
    const int t = table.column("t"), landmarks = table.column("landmarks"), tracks = table.column("tracks");
    const int predict = table.column("ms_predict"), detect = table.column("ms_detect"),
              update = table.column("ms_update");
    std::vector<StepRow> rows;
    while (table.next()) {
        rows.push_back({table.stamp(t), table.integer(landmarks), table.integer(tracks),
                        table.number(predict), table.number(detect), table.number(update)});
    }
    return rows;
}

std::vector<LandmarkSight> readSights(const std::string& file) {
    CsvReader table(file, LastLine::may_be_cut);
    const int t = table.column("t"), id = table.column("id"), x = table.column("x"), y = table.column("y");
    const int xx = table.column("c_xx"), xy = table.column("c_xy"), yy = table.column("c_yy"),
              source = table.column("source_id");
    const int existence = table.has("existence") ? table.column("existence") : -1;
    std::vector<LandmarkSight> sights;
    while (table.next()) {
        LandmarkSight sight;
        sight.stamp = table.stamp(t);
        sight.id = {table.integer(id)};
        sight.source = {table.integer(source)};
        sight.mean = {finite(table, x), finite(table, y)};
        const double covariance = finite(table, xy);
        sight.covariance << finite(table, xx), covariance, covariance, finite(table, yy);
        if (existence >= 0) {
            sight.existence = finite(table, existence);
        }
        sights.push_back(sight);
    }
    return sights;
}

std::vector<ParticleSet> readParticles(const std::string& file) {
    CsvReader table(file, LastLine::may_be_cut);
    const int t = table.column("t"), number = table.column("particle"), weight = table.column("weight");
    const int x = table.column("x"), y = table.column("y"), theta = table.column("theta");
    std::vector<ParticleSet> sets;
    while (table.next()) {
        const Stamp stamp = table.stamp(t);
        if (sets.empty() || sets.back().stamp != stamp) {
            sets.push_back({stamp, {}});
        }
        sets.back().rows.push_back({table.integer(number),
                                    finite(table, weight),
                                    {finite(table, x), finite(table, y), finite(table, theta)}});
    }
    return sets;
}

CorrelationCells readCorrelation(const std::string& file) {
    const std::string bytes = bytesOf(file);
    constexpr std::size_t head = 8 + 3 * sizeof(std::uint32_t);
    std::uint32_t header[3] = {};
    const bool begins = bytes.size() >= head && bytes.compare(0, 8, "SLAMCORR") == 0;
    if (begins) {
        std::memcpy(header, bytes.data() + 8, sizeof header);
    }
    const std::size_t n = header[2];
    if (!begins || header[0] != 1 || n > 512 || header[1] < n ||
        bytes.size() != head + n * n * sizeof(float)) {
        throw LogError(
            fmt::format("{}: is not a correlation matrix of version 1, expected what a run writes", file));
    }
    CorrelationCells correlation;
    correlation.dimension = static_cast<int>(header[1]);
    Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows(n, n);
    std::memcpy(rows.data(), bytes.data() + head, n * n * sizeof(float));
    correlation.cells = rows;
    return correlation;
}

/// The truth that was asked for, with the metrics against it: those of the run may be of another.
void takeGivenTruth(RunFolder& run, const std::string& folder) {
    run.summary["metrics"] = nullptr;
    if (folder == no_truth) {
        run.why_no_truth = "the report was made without";
        return;
    }
    run.truth = readTruth(folder);
    run.truth_folder = folder;
    run.summary["metrics"] = eval::toJson(eval::evaluate(run.run, *run.truth, run.evaluation));
}

/// What the run called `path`, wherever one is now: from the directory it was started in, else, as both may
/// have been moved together, from a folder above its own. `path` itself where nothing is found.
std::string placeOf(const RunFolder& run, const std::string& path) {
    if (path.empty() || fs::path(path).is_absolute()) {
        return path;
    }
    std::vector<fs::path> starts = {run.text("directory")};
    for (fs::path above = fs::absolute(run.folder).lexically_normal(); above.has_relative_path();) {
        above = above.parent_path();
        starts.push_back(above);
    }
    for (const fs::path& start : starts) {
        if (std::error_code error; fs::exists(start / path, error)) {
            return fs::absolute(start / path).lexically_normal().string();
        }
    }
    return path;
}

/// Truth where the run had it. The page is worth having without.
void findTruth(RunFolder& run) {
    const std::string named = run.text("truth"), folder = placeOf(run, named);
    if (named.empty()) {
        run.why_no_truth = "the run had none";
    } else if (!fs::is_directory(folder)) {
        run.why_no_truth = fmt::format("{}, which the run had, is not there; --truth names it", named);
        run.lost_truth = true;
    } else {
        try {
            run.truth = readTruth(folder);
            run.truth_folder = named;
        } catch (const LogError& error) {
            run.why_no_truth = fmt::format("what the run had cannot be used any more ({})", error.what());
            run.lost_truth = true;
        }
    }
}

}  // namespace

double RunFolder::seconds(Stamp stamp) const {
    return run.trajectory.empty() ? 0 : secondsBetween(run.trajectory.front().stamp, stamp);
}

double RunFolder::duration() const {
    return run.trajectory.empty() ? 0 : seconds(run.trajectory.back().stamp);
}

std::optional<double> RunFolder::number(const std::string& path) const {
    const nlohmann::json::json_pointer pointer("/" + path);
    if (!summary.contains(pointer) || !summary.at(pointer).is_number()) {
        return std::nullopt;
    }
    return summary.at(pointer).get<double>();
}

std::string RunFolder::text(const std::string& name) const {
    return summary.contains(name) && summary.at(name).is_string() ? summary.at(name).get<std::string>()
                                                                  : std::string();
}

std::string RunFolder::digits(const std::string& path) const {
    const nlohmann::json::json_pointer pointer("/" + path);
    if (!summary.contains(pointer) || !summary.at(pointer).is_number()) {
        return {};
    }
    const nlohmann::json& value = summary.at(pointer);
    return value.is_number_integer() ? value.dump() : fmt::format("{}", value.get<double>());
}

nlohmann::json RunFolder::list(const std::string& name) const {
    const auto found = summary.find(name);
    return found != summary.end() && found->is_array() ? *found : nlohmann::json::array();
}

RunFolder readRunFolder(const std::string& folder, const std::string& truth_folder) {
    const auto there = [&](const char* name) { return fs::exists(folder + "/" + name); };
    RunFolder run;
    run.folder = folder;
    run.summary = readSummary(folder);
    run.log_file = placeOf(run, run.text("log"));
    run.evaluation = evaluationOf(run.summary, folder);
    run.run = eval::readRun(folder);
    run.map_known = there("landmarks.csv") && !run.failed();
    if (there("steps.csv")) {
        run.steps = readSteps(folder + "/steps.csv");
    }
    if (there("landmarks_history.csv")) {
        run.sights = readSights(folder + "/landmarks_history.csv");
    }
    if (there("tentative.csv")) {
        run.tentative = readSights(folder + "/tentative.csv");
    }
    if (there("particles.csv")) {
        run.particles = readParticles(folder + "/particles.csv");
    }
    if (there("correlation.bin")) {
        run.correlation = readCorrelation(folder + "/correlation.bin");
    }
    if (truth_folder.empty()) {
        findTruth(run);
    } else {
        takeGivenTruth(run, truth_folder);
    }
    if (run.truth) {
        run.pairs = eval::pairWithTruth(run.run.trajectory, *run.truth).pairs;
    }
    return run;
}

}  // namespace slamot::report
