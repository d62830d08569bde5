// Normalized innovations squared by sensor and kind.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "sections/Courses.h"
#include "sections/Sections.h"
#include "slamot/eval/Consistency.h"

namespace slamot::report {
namespace {

constexpr int degrees = 2;  // range and bearing
constexpr std::size_t most_windows = 80, most_groups = 4;

using Group = std::pair<std::string, ObjectKind>;
using Rows = std::vector<const eval::InnovationRow*>;

std::map<Group, Rows> groupsOf(const RunFolder& run) {
    std::map<Group, Rows> groups;
    for (const eval::InnovationRow& row : run.run.innovations) {
        if (std::isfinite(row.innovation.nis) && row.innovation.outcome != Outcome::tentative) {
            groups[{row.sensor, row.innovation.kind}].push_back(&row);
        }
    }
    return groups;
}

Panel panelOf(const RunFolder& run, const Group& group, const Rows& rows) {
    const double probability = bandProbability(run);
    const Windows windows = windowsFor(run, rows.size(), most_windows);
    std::vector<double> sums(windows.count(), 0), counts(windows.count(), 0);
    Points used{"innovations used", {}, colour::sky, Symbol::dot, 2.5, 0.5};
    Points rejected{"rejected or down-weighted", {}, colour::vermillion, Symbol::times, 5, 0.8};
    double inside = 0;
    const eval::Band single = eval::chiSquareBand(probability, degrees);
    for (const eval::InnovationRow* row : rows) {
        const double nis = row->innovation.nis;
        const bool ordinary = row->innovation.outcome == Outcome::updated;
        (ordinary ? used : rejected).points.emplace_back(run.seconds(row->stamp), nis);
        inside += single.contains(nis);
        const std::size_t window = windows.of(row->stamp);
        sums[window] += nis;
        counts[window] += 1;
    }
    Line mean{"mean over a window", {}, colour::black, 1.8};
    Band band{fmt::format("{:.0f} % band of that mean", 100 * probability), {}, colour::green, 0.35};
    for (std::size_t w = 0; w < windows.count(); ++w) {
        const bool any = counts[w] > 0;
        mean.points.emplace_back(windows.middle(w), any ? sums[w] / counts[w] : std::nan(""));
        const eval::Band b = any ? eval::chiSquareBand(probability, degrees * counts[w], counts[w])
                                 : eval::Band{std::nan(""), std::nan("")};
        for (const double end : {windows.begin(w), windows.begin(w + 1)}) {
            band.rows.push_back({end, b.low, b.high});
        }
    }
    Panel panel;
    panel.title = fmt::format("{}: {}, {:.1f} % of {} within {:.2g} to {:.2g}", group.first.empty() ? "(no label)" : group.first,
                              toText(group.second), 100 * inside / static_cast<double>(rows.size()), rows.size(),
                              single.low, single.high);
    panel.x = runTimeAxis(run);
    panel.y.label = "NIS";
    panel.y.logarithmic = true;
    panel.y.min = 0.01;
    panel.height = 200;
    panel.layers = {used};
    if (!rejected.points.empty()) {
        panel.layers.push_back(rejected);
    }
    panel.layers.insert(panel.layers.end(), {Layer(band), Layer(mean)});
    return panel;
}

std::string absent(const RunFolder& run) {
    return run.run.innovations.empty() ? "innovations.csv is not there or empty ([output] innovations)"
           : groupsOf(run).empty()     ? "no detection had a prediction"
                                       : "";
}

std::vector<Block> blocks(const RunFolder& run) {
    Figure figure;
    for (const auto& [group, rows] : groupsOf(run)) {
        if (figure.panels.size() < most_groups) {
            figure.panels.push_back(panelOf(run, group, rows));
        }
    }
    const std::string alt = fmt::format(
        "NIS over time for {} groups of sensor and kind, with the mean over windows and its chi-square band.",
        figure.panels.size());
    return {PageFigure{"nis", alt, figure, ""}};
}

}  // namespace

const ReportSection nis_section{"nis", "NIS",
                                "Do the innovations fit their covariances? The one test of consistency that needs no truth. Each innovation should be of chi-square law "
                                "with two degrees of freedom (mean 2); the black line is the mean over a window of time, the "
                                "green band where it should lie.",
                                absent, blocks};

}  // namespace slamot::report
