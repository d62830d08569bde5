// What became of the detections.
#include <algorithm>
#include <array>
#include <set>

#include "sections/Courses.h"
#include "sections/Sections.h"

namespace slamot::report {
namespace section_outcomes {

constexpr std::size_t most_windows = 120;

std::string absent(const RunFolder& run) {
    return run.run.innovations.empty() ? "innovations.csv is not there or empty ([output] innovations)" : "";
}

/// Stamps with detections, also where nothing was detected: an estimator's update takes time, however little.
/// Without steps.csv those at which something was.
std::vector<Stamp> scanStamps(const RunFolder& run) {
    std::set<Stamp> stamps;
    for (const StepRow& row : run.steps) {
        if (row.update_ms > 0) {
            stamps.insert(row.stamp);
        }
    }
    for (const eval::InnovationRow& row : run.run.innovations) {
        stamps.insert(row.stamp);
    }
    return {stamps.begin(), stamps.end()};
}

std::vector<Block> blocks(const RunFolder& run) {
    const std::array outcomes{Outcome::updated,   Outcome::inflated, Outcome::initiated,
                              Outcome::tentative, Outcome::rejected, Outcome::ignored};
    const std::vector<std::string> colours = {colour::sky,    colour::orange,     colour::blue,
                                              colour::purple, colour::vermillion, colour::grey};
    std::vector<std::string> labels;
    for (const Outcome outcome : outcomes) {
        labels.emplace_back(toText(outcome));
    }
    const std::vector<Stamp> stamps = scanStamps(run);
    const Windows windows = windowsFor(run, stamps.size(), most_windows, 4);
    std::vector<double> scans(windows.count(), 0);
    for (const Stamp stamp : stamps) {
        scans[windows.of(stamp)] += 1;
    }
    std::vector<std::vector<double>> counts(outcomes.size(), std::vector<double>(windows.count(), 0));
    for (const eval::InnovationRow& row : run.run.innovations) {
        for (std::size_t k = 0; k < outcomes.size(); ++k) {
            counts[k][windows.of(row.stamp)] += row.innovation.outcome == outcomes[k];
        }
    }
    Panel panel;
    panel.x = runTimeAxis(run);
    panel.y.label = "Detections at a time";
    panel.y.min = 0;
    for (std::vector<double>& row : counts) {
        for (std::size_t w = 0; w < windows.count(); ++w) {
            row[w] /= std::max(scans[w], 1.0);
        }
    }
    for (Band& band : stackedSteps(windows, counts, labels, colours)) {
        panel.layers.push_back(std::move(band));
    }
    Figure figure;
    figure.panels = {panel};
    const std::string caption =
        run.steps.empty()
            ? "Without steps.csv stamps at which nothing was detected are not known and not counted."
            : "";
    return {PageFigure{"outcomes", "Detections at a time, mean over windows, by what became of them.", figure,
                       caption}};
}

}  // namespace section_outcomes

const ReportSection outcome_section{
    "outcomes", "Association outcomes",
    "How many detections there are at one stamp, mean over a window, by what became of them. Updated: used "
    "at full weight; inflated: used with enlarged noise; initiated: started a landmark or a "
    "track; tentative: of something not known to exist yet; rejected: outside the gate; "
    "ignored: of no use to the estimator.",
    section_outcomes::absent, section_outcomes::blocks};

}  // namespace slamot::report
