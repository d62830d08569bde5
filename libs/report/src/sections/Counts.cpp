// How many landmarks and tracks there are.
#include <fmt/format.h>

#include <algorithm>

#include "sections/Courses.h"
#include "sections/Sections.h"

namespace slamot::report {
namespace section_counts {

std::string absent(const RunFolder& run) {
    return run.steps.empty() ? "steps.csv is not there or empty ([output] steps)" : "";
}

Panel countPanel(const RunFolder& run, const std::string& label, std::int64_t StepRow::*count,
                 const std::string& colour) {
    Panel panel;
    panel.x = runTimeAxis(run);
    panel.y.label = label;
    panel.y.min = 0;
    panel.height = 150;
    Line line{"in the estimate", {}, colour, 1.5};
    // Only where the number changes: a run of equal ones is a straight line.
    for (std::size_t i = 0; i < run.steps.size(); ++i) {
        const bool ends = i + 1 == run.steps.size();
        const bool same = i > 0 && run.steps[i].*count == run.steps[i - 1].*count;
        const double t = run.seconds(run.steps[i].stamp);
        if (!same && i > 0) {
            line.points.emplace_back(t, static_cast<double>(run.steps[i - 1].*count));
        }
        if (!same || ends) {
            line.points.emplace_back(t, static_cast<double>(run.steps[i].*count));
        }
    }
    double most = 5;  // so that the axis has whole numbers
    for (const Eigen::Vector2d& p : line.points) {
        most = std::max(most, p.y());
    }
    panel.y.max = 1.05 * most;
    panel.layers = {line};
    return panel;
}

std::vector<Block> blocks(const RunFolder& run) {
    Figure figure;
    figure.panels = {countPanel(run, "Landmarks", &StepRow::landmarks, colour::black)};
    if (!run.run.tracks.empty()) {
        figure.panels.push_back(countPanel(run, "Tracks", &StepRow::tracks, colour::vermillion));
    }
    if (const auto seen = run.number("metrics/map_cardinality/seen/landmarks")) {
        figure.panels[0].layers.push_back(Rule{"true ones that were seen in the run", *seen});
        figure.panels[0].y.max = std::max(*figure.panels[0].y.max, 1.05 * *seen);
    } else if (run.truth && !run.truth->landmarks.empty()) {
        const auto count = static_cast<double>(run.truth->landmarks.size());
        figure.panels[0].layers.push_back(Rule{"true ones in the world", count});
        figure.panels[0].y.max = std::max(*figure.panels[0].y.max, 1.05 * count);
    }
    const StepRow& last = run.steps.back();
    return {PageFigure{"counts",
                       fmt::format("Number of landmarks and tracks over time; {} and {} at the end.",
                                   last.landmarks, last.tracks),
                       figure, ""}};
}

}  // namespace section_counts

const ReportSection count_section{"counts", "Landmark and track counts", "", section_counts::absent,
                                  section_counts::blocks};

}  // namespace slamot::report
