// The correlation matrix at the end of the run.
#include <fmt/format.h>

#include <algorithm>

#include "sections/Sections.h"

namespace slamot::report {
namespace section_correlation {

constexpr int robot_dimensions = 3, track_dimensions = 6;

std::string absent(const RunFolder& run) {
    return run.correlation && run.correlation->cells.size() > 0 ? ""
           : run.failed()
               ? "a run that failed leaves no covariance of its end"
               : "correlation.bin is not there ([output] correlation, or an estimator without joint "
                 "covariance)";
}

std::vector<Block> blocks(const RunFolder& run) {
    const CorrelationCells& correlation = *run.correlation;
    const auto n = static_cast<double>(correlation.cells.rows());
    const double cells_per_component = n / correlation.dimension;
    HeatMap map;
    map.label = "|correlation|";
    // Row 0 at the top, as matrices are written.
    map.values = correlation.cells.cast<double>().cwiseAbs().colwise().reverse();
    map.x_min = map.y_min = -0.5;
    map.x_max = map.y_max = n - 0.5;
    map.colours = ColourMap::grey;
    Panel panel;
    panel.x.categories.resize(static_cast<std::size_t>(n));
    panel.y.categories = panel.x.categories;
    panel.height = 470;
    panel.layers = {map};
    const auto tracks = static_cast<int>(run.number("counts/tracks_at_end").value_or(0));
    const int first_landmark = robot_dimensions + track_dimensions * tracks;
    const auto addBlock = [&](const std::string& name, int begin, int end) {
        const double middle = 0.5 * (begin + end) * cells_per_component;
        const auto cell = static_cast<std::size_t>(std::min(middle, n - 1));
        panel.y.categories[panel.y.categories.size() - 1 - cell] = name;
        if (end - begin > correlation.dimension / 10) {  // there is room for it
            panel.x.categories[cell] = name;
        }
        if (end < correlation.dimension) {
            const double border = end * cells_per_component - 0.5;
            panel.layers.push_back(Rule{"", border, true, colour::vermillion, Dash::solid, 1});
            panel.layers.push_back(Rule{"", n - 1 - border, false, colour::vermillion, Dash::solid, 1});
        }
    };
    if (correlation.dimension >= first_landmark) {
        // A few rows have no room for names of their own.
        const bool few = track_dimensions * tracks * cells_per_component < n / 30;
        if (few) {
            addBlock("robot", 0, first_landmark);
        } else {
            addBlock("robot", 0, robot_dimensions);
            addBlock("tracks", robot_dimensions, first_landmark);
        }
        if (correlation.dimension > first_landmark) {
            addBlock("landmarks", first_landmark, correlation.dimension);
        }
    }
    Figure figure;
    figure.width = 640;
    figure.panels = {panel};
    const std::string caption = fmt::format(
        "{} components: the robot's 3, 6 of each track, 2 of each landmark in the order of first sight; "
        "lines "
        "stand between these parts.{}",
        correlation.dimension,
        correlation.cells.rows() < correlation.dimension ? " Each cell is the strongest of those it covers."
                                                         : "");
    return {
        PageFigure{"correlation",
                   fmt::format("Heat map of the correlation matrix of {} components.", correlation.dimension),
                   figure, caption}};
}

}  // namespace section_correlation

const ReportSection correlation_section{
    "correlation", "Correlations",
    "At the end of the run. A map holds together by its correlations: blocks near 1 move as one. The sign is "
    "left out: it says only where the robot stood.",
    section_correlation::absent, section_correlation::blocks};

}  // namespace slamot::report
