// What a step costs.
#include <fmt/format.h>

#include <algorithm>

#include "MetricRows.h"
#include "sections/Courses.h"
#include "sections/Sections.h"

namespace slamot::report {
namespace section_times {

constexpr std::size_t most_windows = 150;

std::string absent(const RunFolder& run) {
    return run.steps.empty() ? "steps.csv is not there or empty ([output] steps)" : "";
}

PageTable timeTable(const RunFolder& run) {
    PageTable table{"Wall time", {{"", false}, {"value"}}, {}};
    const std::tuple<const char*, const char*, const char*> rows[] = {
        {"whole run", "time/wall_s", "s"},          {"of it prediction", "time/predict_s", "s"},
        {"of it detection", "time/detect_s", "s"},  {"of it update", "time/update_s", "s"},
        {"step, mean", "time/step_ms/mean", "ms"},  {"step, median", "time/step_ms/p50", "ms"},
        {"step, 95 %", "time/step_ms/p95", "ms"},   {"step, 99 %", "time/step_ms/p99", "ms"},
        {"step, longest", "time/step_ms/max", "ms"}};
    for (const auto& [name, path, unit] : rows) {
        if (const auto value = run.number(path)) {
            table.rows.push_back({{{fmt::format("{} [{}]", name, unit)}, {shortNumber(*value)}}});
        }
    }
    return table;
}

std::vector<Block> blocks(const RunFolder& run) {
    const auto count =
        std::count_if(run.steps.begin(), run.steps.end(), [](const StepRow& s) { return s.update_ms > 0; });
    const Windows windows = windowsFor(run, static_cast<std::size_t>(count), most_windows, 8);
    std::vector<std::vector<double>> steps(windows.count());
    double pending = 0;
    for (const StepRow& row : run.steps) {
        pending += row.predict_ms + row.detect_ms + row.update_ms;
        if (row.update_ms > 0) {  // a step is everything from one set of detections to the next
            steps[windows.of(row.stamp)].push_back(pending);
            pending = 0;
        }
    }
    Band range{"5 % to 95 % within a window", {}, colour::sky, 0.35};
    Line median{"median", {}, colour::blue, 1.6}, longest{"longest", {}, colour::grey, 0.9, Dash::dotted};
    for (std::size_t w = 0; w < windows.count(); ++w) {
        const double t = windows.middle(w);
        range.rows.push_back({t, quantile(steps[w], 0.05), quantile(steps[w], 0.95)});
        median.points.emplace_back(t, quantile(steps[w], 0.5));
        longest.points.emplace_back(t, quantile(steps[w], 1));
    }
    Panel panel;
    panel.x = runTimeAxis(run);
    panel.y.label = "Time of a step";
    panel.y.unit = "ms";
    panel.y.logarithmic = true;
    panel.layers = {range, longest, median};
    Figure figure;
    figure.panels = {panel};
    return {
        PageFigure{"step_time", "Wall time of a step over the run: median, range and longest within windows.",
                   figure, ""},
        timeTable(run)};
}

}  // namespace section_times

const ReportSection time_section{
    "step-time", "Step time",
    "A step is everything from one set of detections to the next, prediction included.",
    section_times::absent, section_times::blocks};

}  // namespace slamot::report
