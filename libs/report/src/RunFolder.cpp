#include "slamot/report/RunFolder.h"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "slamot/rawlog/CsvTable.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::report {
namespace {

namespace fs = std::filesystem;

std::string bytesOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
}

nlohmann::json readSummary(const std::string& folder) {
    const std::string file = folder + "/summary.json";
    if (!fs::exists(file)) {
        throw LogError(fmt::format("{}: has no summary.json, expected the output folder of a run", folder));
    }
    nlohmann::json summary = nlohmann::json::parse(bytesOf(file), nullptr, false);
    if (!summary.is_object() || summary.value("program", "") != "slamot") {
        throw LogError(fmt::format("{}: is not what slamot writes, expected the summary of a run", file));
    }
    return summary;
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
    std::vector<LandmarkSight> sights;
    while (table.next()) {
        LandmarkSight sight;
        sight.stamp = table.stamp(t);
        sight.id = {table.integer(id)};
        sight.source = {table.integer(source)};
        sight.mean = {table.number(x), table.number(y)};
        const double covariance = table.number(xy);
        sight.covariance << table.number(xx), covariance, covariance, table.number(yy);
        sights.push_back(sight);
    }
    return sights;
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
    if (!begins || header[0] != 1 || n > 512 || bytes.size() != head + n * n * sizeof(float)) {
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

/// Where the run's truth is: as given, or as the run had it.
void findTruth(RunFolder& run, const std::string& given) {
    if (given == "none") {
        run.why_no_truth = "the report was made without";
        return;
    }
    const std::string folder = given.empty() ? run.text("truth") : given;
    if (folder.empty()) {
        run.why_no_truth = "the run had none";
    } else if (given.empty() && !fs::is_directory(folder)) {
        run.why_no_truth = fmt::format("{}, which the run had, is not there; --truth names it", folder);
    } else {
        run.truth = readTruth(folder);
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

RunFolder readRunFolder(const std::string& folder, const std::string& truth_folder) {
    const auto there = [&](const char* name) { return fs::exists(folder + "/" + name); };
    RunFolder run;
    run.folder = folder;
    run.summary = readSummary(folder);
    run.run = eval::readRun(folder);
    if (there("steps.csv")) {
        run.steps = readSteps(folder + "/steps.csv");
    }
    if (there("landmarks_history.csv")) {
        run.sights = readSights(folder + "/landmarks_history.csv");
    }
    if (there("correlation.bin")) {
        run.correlation = readCorrelation(folder + "/correlation.bin");
    }
    findTruth(run, truth_folder);
    if (run.truth) {
        run.pairs = eval::pairWithTruth(run.run.trajectory, *run.truth).pairs;
    }
    return run;
}

}  // namespace slamot::report
