// Normalized innovations squared by sensor and kind.
#include "slamot/eval/Nis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "sections/Courses.h"
#include "sections/Sections.h"
#include "slamot/eval/Consistency.h"

namespace slamot::report {
namespace section_nis {

constexpr int degrees = 2;  // range and bearing
constexpr std::size_t most_windows = 80, most_groups = 4;
constexpr double lowest_shown = 0.01;  // 0.5 % of innovations should lie below

std::string wordsOf(ObjectKind kind) {
    return kind == ObjectKind::unknown ? "landmarks or movers" : std::string(toText(kind)) + "s";
}

using Group = std::pair<std::string, ObjectKind>;
using Rows = std::vector<const eval::InnovationRow*>;

std::map<Group, Rows> groupsOf(const RunFolder& run) {
    std::map<Group, Rows> groups;
    for (const eval::InnovationRow& row : run.run.innovations) {
        if (eval::countsForNis(row.innovation)) {
            groups[{row.sensor, row.innovation.kind}].push_back(&row);
        }
    }
    return groups;
}

/// The mean NIS of each window, and the band it should lie in.
void addMeans(Panel& panel, const std::vector<std::vector<double>>& values, const Windows& windows,
              double probability) {
    Line mean{"mean over a window", {}, colour::black, 1.8};
    Band band{fmt::format("{:.0f} % band of that mean", 100 * probability), {}, colour::green, 0.45};
    for (std::size_t w = 0; w < windows.count(); ++w) {
        const auto n = static_cast<double>(values[w].size());
        const double sum = std::accumulate(values[w].begin(), values[w].end(), 0.0);
        const eval::Band b =
            n > 0 ? eval::chiSquareBand(probability, degrees * n, n) : eval::Band{std::nan(""), std::nan("")};
        mean.points.emplace_back(windows.middle(w), n > 0 ? sum / n : std::nan(""));
        for (const double end : {windows.begin(w), windows.begin(w + 1)}) {
            band.rows.push_back({end, b.low, b.high});
        }
    }
    panel.layers.push_back(std::move(band));
    panel.layers.push_back(std::move(mean));
}

/// Of very many innovations the middle as an area, and only the outermost as points.
void addMany(Panel& panel, const std::vector<std::vector<double>>& values, const Windows& windows,
             double probability, Points used) {
    Band middle{
        fmt::format("the middle {:.3g} % of the innovations", 100 * probability), {}, colour::sky, 0.35};
    std::vector<double> low(windows.count()), high(windows.count());
    const double tail = (1 - probability) / 2;
    for (std::size_t w = 0; w < windows.count(); ++w) {
        middle.rows.push_back({windows.middle(w), quantile(values[w], tail), quantile(values[w], 1 - tail)});
        low[w] = quantile(values[w], 0.005);
        high[w] = quantile(values[w], 0.995);
    }
    const auto inside = [&](const Eigen::Vector2d& p) {
        const std::size_t w = windows.at(p.x());
        return low[w] <= p.y() && p.y() <= high[w];
    };
    used.label = "the outermost 1 %";
    used.points.erase(std::remove_if(used.points.begin(), used.points.end(), inside), used.points.end());
    panel.layers = {middle, used};
}

Panel panelOf(const RunFolder& run, const Group& group, const Rows& rows) {
    constexpr std::size_t many = 5000;
    const double probability = run.evaluation.probability;
    const Windows windows = windowsFor(run, rows.size(), most_windows, 20);
    std::vector<std::vector<double>> values(windows.count());
    Points used{"innovations used", {}, colour::sky, Symbol::dot, 3, 0.8};
    Points rejected{"rejected or down-weighted", {}, colour::vermillion, Symbol::times, 5, 0.8};
    double inside = 0, below = 0;
    const eval::Band single = eval::chiSquareBand(probability, degrees);
    for (const eval::InnovationRow* row : rows) {
        const double nis = row->innovation.nis;
        const bool ordinary = row->innovation.outcome == Outcome::updated;
        (ordinary ? used : rejected).points.emplace_back(run.seconds(row->stamp), nis);
        inside += single.contains(nis);
        below += nis < lowest_shown;
        values[windows.of(row->stamp)].push_back(nis);
    }
    Panel panel;
    panel.title =
        fmt::format("sensor '{}', {}: {:.1f} % of {} within {:.2g} to {:.2g}, expected {:.3g} %", group.first,
                    wordsOf(group.second), 100 * inside / static_cast<double>(rows.size()), rows.size(),
                    single.low, single.high, 100 * probability);
    panel.x = runTimeAxis(run);
    panel.y.label = "NIS";
    panel.y.logarithmic = true;
    panel.y.min = lowest_shown;
    panel.note = fmt::format("{:.1f} % lie below the axis, expected 0.5 %.",
                             100 * below / static_cast<double>(rows.size()));
    panel.height = 200;
    if (used.points.size() > many) {
        addMany(panel, values, windows, probability, std::move(used));
    } else {
        panel.layers = {used};
    }
    panel.layers.push_back(Rule{fmt::format("where the middle {:.3g} % should lie", 100 * probability),
                                single.low, false, colour::blue});
    panel.layers.push_back(Rule{"", single.high, false, colour::blue});
    if (!rejected.points.empty()) {
        panel.layers.push_back(rejected);
    }
    addMeans(panel, values, windows, probability);
    return panel;
}

std::string absent(const RunFolder& run) {
    return run.run.innovations.empty() ? "innovations.csv is not there or empty ([output] innovations)"
           : groupsOf(run).empty()     ? "no detection had a prediction"
                                       : "";
}

std::vector<Block> blocks(const RunFolder& run) {
    Figure figure;
    const std::map<Group, Rows> groups = groupsOf(run);
    std::vector<const std::pair<const Group, Rows>*> largest;
    for (const auto& group : groups) {
        largest.push_back(&group);
    }
    std::stable_sort(largest.begin(), largest.end(),
                     [](const auto* a, const auto* b) { return a->second.size() > b->second.size(); });
    largest.resize(std::min(largest.size(), most_groups));
    for (const auto* group : largest) {
        figure.panels.push_back(panelOf(run, group->first, group->second));
    }
    const std::string caption = groups.size() > largest.size()
                                    ? fmt::format("The {} groups with the most innovations, of {} groups.",
                                                  largest.size(), groups.size())
                                    : "";
    const std::string alt = fmt::format(
        "NIS over time for {} groups of sensor and kind, with the mean over windows and its chi-square band.",
        figure.panels.size());
    return {PageFigure{"nis", alt, figure, caption}};
}

}  // namespace section_nis

const ReportSection nis_section{
    "nis", "NIS",
    "Do the innovations fit their covariances? The one test of consistency that needs no truth. Each "
    "innovation should be of chi-square law "
    "with two degrees of freedom (mean 2); the thick line is the mean over a window of time, the "
    "green band where it should lie.",
    section_nis::absent, section_nis::blocks};

}  // namespace slamot::report
