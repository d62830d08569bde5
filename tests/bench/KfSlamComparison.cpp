// Time and accuracy beside MRPT's kf-slam: same logs, same noise, same process, one thread, the filters
// taking turns. Prints JSON; scripts/results/kf_slam.py makes the logs and the tables.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "Trial.h"
#include "slamot/core/data/Angle.h"
#include "slamot/rawlog/RawlogReader.h"
#include "slamot/rawlog/Truth.h"
#include "slamot/report/FigureWriter.h"

namespace slamot::bench {
namespace {

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// True poses at the end of each frame, by the stamps the log's reader gives the frames.
std::vector<std::optional<Pose2>> trueFrames(const std::string& log) {
    const std::string folder = truthFolderOf(log);
    if (!std::filesystem::is_directory(folder)) return {};
    const Truth truth = readTruth(folder);
    std::vector<std::optional<Pose2>> out;
    RawlogReader reader(log, {});
    while (const auto entry = reader.next())
        if (entry->increment) out.push_back(truth.robotAt(entry->increment->t1));
    return out;
}

/// Root mean square of position and heading errors, unaligned: both filters start at the true pose.
nlohmann::json rmse(const std::vector<Pose2>& poses, const std::vector<std::optional<Pose2>>& truth) {
    double position = 0, heading = 0;
    int matched = 0;
    for (std::size_t i = 0; i < std::min(poses.size(), truth.size()); ++i) {
        if (!truth[i]) continue;
        position += (poses[i].position() - truth[i]->position()).squaredNorm();
        heading += std::pow(angleDifference(poses[i].theta, truth[i]->theta), 2);
        ++matched;
    }
    if (matched == 0) return nullptr;
    return {{"position_m", std::sqrt(position / matched)},
            {"heading_rad", std::sqrt(heading / matched)},
            {"matched", matched}};
}

nlohmann::json toJson(const Trial& trial, const std::vector<std::optional<Pose2>>& truth) {
    const auto quarter = static_cast<std::ptrdiff_t>(trial.seconds.size() / 4);
    const std::vector<double> last(trial.seconds.end() - quarter, trial.seconds.end());
    const std::vector<double> seen(trial.seen.begin(), trial.seen.end());
    return {{"frames", trial.poses.size()},
            {"landmarks", trial.landmarks.back()},
            {"landmarks_mean", mean({trial.landmarks.begin(), trial.landmarks.end()})},
            {"seen_median", median(seen)},
            {"mean_ms", 1e3 * mean(trial.seconds)},
            {"median_ms", 1e3 * median(trial.seconds)},
            {"last_quarter_mean_ms", 1e3 * mean(last)},
            {"rmse", rmse(trial.poses, truth)}};
}

/// Median time of a frame by map size, in classes that grow by a sixth.
report::Points2 timeBySize(const std::vector<Trial>& trials) {
    std::map<int, std::vector<std::pair<double, double>>> classes;
    for (const Trial& trial : trials)
        for (std::size_t i = 0; i < trial.seconds.size(); ++i)
            if (trial.landmarks[i] >= 10)
                classes[static_cast<int>(std::log(trial.landmarks[i]) / std::log(7.0 / 6))].push_back(
                    {trial.landmarks[i], 1e3 * trial.seconds[i]});
    report::Points2 points;
    for (const auto& [size_class, frames] : classes) {
        std::vector<double> sizes, times;
        for (const auto& [size, time] : frames) {
            sizes.push_back(size);
            times.push_back(time);
        }
        points.emplace_back(median(sizes), median(times));
    }
    return points;
}

void drawTimes(const std::map<std::string, std::vector<Trial>>& trials, const std::string& stem) {
    report::Panel panel;
    panel.x.label = "Landmarks in the map";
    panel.y.label = "Median processor time of a frame";
    panel.y.unit = "ms";
    panel.x.logarithmic = panel.y.logarithmic = true;
    panel.height = 300;
    std::size_t index = 0;
    for (const auto& [name, label] :
         {std::pair("kf-slam", "MRPT kf-slam"), std::pair("classic", "slamot, classic"),
          std::pair("invariant", "slamot, invariant")}) {
        const report::SeriesStyle style = report::seriesStyle(index++);
        panel.layers.push_back(
            report::Line{label, timeBySize(trials.at(name)), style.colour, 1.5, style.dash});
    }
    report::Figure figure;
    figure.title = "Time of a frame by map size";
    figure.width = 640;
    figure.panels.push_back(panel);
    report::FigureFormats formats;
    formats.spec = formats.png = false;
    writeFigure(figure, stem, formats);
}

}  // namespace
}  // namespace slamot::bench

int main(int argc, char** argv) try {
    using namespace slamot::bench;
    CLI::App app(
        "Runs MRPT's kf-slam and ekf_slamot on the same action-frame logs and prints their times and errors");
    std::vector<std::string> logs;
    std::string config, figure;
    SensorNoise noise{0.03, 0.1 * M_PI / 180};
    double bearing_std_deg = 0.1;
    int repetitions = 5;
    bool certain_start = false;
    app.add_option("logs", logs)->required()->check(CLI::ExistingFile);
    app.add_option("--config", config, "run config of slamot")->required()->check(CLI::ExistingFile);
    app.add_option("--range-std", noise.range_std, "[m], given to both");
    app.add_option("--bearing-std-deg", bearing_std_deg, "given to both");
    app.add_option("--repetitions", repetitions, "passes of each filter over each log, taking turns");
    app.add_option("--figure", figure, "draws time by map size into this file, .svg being added");
    app.add_flag("--certain-start", certain_start,
                 "slamot too takes the movements before the first detection as certain");
    CLI11_PARSE(app, argc, argv);
    noise.bearing_std = bearing_std_deg * M_PI / 180;

    const std::vector<std::string> told{fmt::format("noise.range_std={}", noise.range_std),
                                        fmt::format("noise.bearing_std_deg={}", bearing_std_deg)};
    nlohmann::json results = nlohmann::json::array();
    std::map<std::string, std::vector<Trial>> all_trials;
    for (const std::string& log : logs) {
        const auto truth = trueFrames(log);
        nlohmann::json trials = nlohmann::json::array();
        for (int repetition = 0; repetition < repetitions; ++repetition) {
            std::map<std::string, Trial> by_filter;
            by_filter["kf-slam"] = runKfSlam(log, noise);
            for (const std::string consistency : {"classic", "invariant"}) {
                std::vector<std::string> settings = told;
                settings.push_back("ekf_slamot.consistency=" + consistency);
                by_filter[consistency] = runSlamot(log, config, settings, certain_start);
            }
            nlohmann::json row;
            for (const auto& [name, trial] : by_filter) {
                row[name] = toJson(trial, truth);
                all_trials[name].push_back(trial);
            }
            trials.push_back(row);
            std::cerr << fmt::format("{} {}/{}: kf-slam {:.3f} ms, classic {:.3f} ms, invariant {:.3f} ms\n",
                                     std::filesystem::path(log).filename().string(), repetition + 1,
                                     repetitions, row["kf-slam"]["mean_ms"].get<double>(),
                                     row["classic"]["mean_ms"].get<double>(),
                                     row["invariant"]["mean_ms"].get<double>());
        }
        results.push_back({{"log", std::filesystem::path(log).filename().string()}, {"trials", trials}});
    }
    if (!figure.empty()) drawTimes(all_trials, figure);
    std::cout << nlohmann::json{{"range_std", noise.range_std},
                                {"bearing_std_deg", bearing_std_deg},
                                {"repetitions", repetitions},
                                {"logs", results}}
                     .dump(1)
              << '\n';
    return 0;
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
