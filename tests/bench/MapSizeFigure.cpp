#include <utility>

#include "BenchPage.h"
#include "MapSizeReport.h"

namespace slamot::bench {
namespace {

namespace colour = report::colour;

/// One value for every size where there is one.
template <class Value>
report::Points2 curve(const Results& results, const Value& value) {
    report::Points2 points;
    for (const SizeResult& size : results.sizes)
        if (const std::optional<double> y = value(size)) points.emplace_back(size.compressed.landmarks, *y);
    return points;
}

std::optional<double> medianOf(const std::optional<FilledRun>& run) {
    if (!run) return std::nullopt;
    return summarise(run->times).median;
}

report::Panel timePanel(const Results& results) {
    report::Panel panel = logarithmicPanel("Landmarks in the map", "Processor time of a step", "ms");
    const auto compressed = [&](double TimeSummary::*figure) {
        return curve(results, [&](const SizeResult& size) -> std::optional<double> {
            return summarise(size.compressed, [](const auto& step) { return step.second_pass; }).*figure;
        });
    };
    addCurve(panel, "kf-slam", curve(results, [](const auto& s) { return medianOf(s.kf_slam); }),
             colour::green);
    addCurve(panel, "dense engine", curve(results, [](const auto& s) { return medianOf(s.dense); }),
             colour::vermillion);
    addCurve(panel, "compressed engine", compressed(&TimeSummary::median), colour::blue);
    addCurve(panel, "its 99th percentile", compressed(&TimeSummary::p99), colour::blue, report::Dash::dashed);
    addCurve(panel, "its longest step", compressed(&TimeSummary::longest), colour::blue,
             report::Dash::dotted);
    panel.note = "Medians; compressed: all steps of the second pass";
    return panel;
}

report::Panel memoryPanel(const Results& results) {
    report::Panel panel = logarithmicPanel("Landmarks in the map", "Memory", "MB");
    const auto megabytes = [](std::size_t bytes) {
        return std::optional<double>(1e-6 * static_cast<double>(bytes));
    };
    addCurve(
        panel, "one full covariance",
        curve(results, [&](const auto& s) { return megabytes(covarianceBytes(s.compressed.landmarks)); }),
        colour::vermillion);
    addCurve(panel, "compressed engine",
             curve(results, [&](const auto& s) { return megabytes(s.compressed.memory.state); }),
             colour::blue);
    addCurve(panel, "the whole process at its peak",
             curve(results, [&](const auto& s) { return megabytes(s.compressed.memory.resident); }),
             colour::blue, report::Dash::dashed);
    panel.note = "Compressed: one mode, all of the map seen twice";
    return panel;
}

}  // namespace

report::Figure mapSizeFigure(const Results& results) {
    report::Figure figure;
    figure.columns = 2;
    figure.panels = {timePanel(results), memoryPanel(results)};
    return figure;
}

}  // namespace slamot::bench
