#pragma once
// A figure as a value: panels of layers. figureSpec (FigureSpec.h) turns it into a Vega specification,
// writeFigure (FigureWriter.h) into files.
#include <optional>
#include <string>
#include <vector>

#include "slamot/report/Layers.h"

namespace slamot::report {

struct Axis {
    std::string label;
    std::string unit;  ///< empty for pure numbers
    bool logarithmic = false;
    /// Where the axis ends; by default where the data end, plus `padding`.
    std::optional<double> min, max;
    double padding = 0.04;  ///< of the data's extent, at each end that is not given
    /// Names of the places 0, 1, 2, ...: bars. Empty on an axis of numbers.
    std::vector<std::string> categories;
};

/// Time [s], from the first to the last sample.
Axis timeAxis(const std::string& label = "Time");

enum class LegendPlace { top, right, none };

struct Panel {
    std::string title;
    Axis x, y;
    /// Maps: a metre is as many pixels in x as in y. The axis with room to spare shows more of the world.
    bool equal_aspect = false;
    double height = 200;  ///< of the plotting area, pixels
    LegendPlace legend = LegendPlace::top;
    /// Drawn in this order, the first at the bottom.
    std::vector<Layer> layers;
    std::string note;  ///< small print below the x axis
};

/// Panels fill the figure row by row; the height follows from theirs.
struct Figure {
    std::string title, subtitle;
    double width = 900;  ///< pixels
    int columns = 1;
    /// One legend above all panels, each label once, beside those that panels have of their own.
    bool shared_legend = false;
    std::vector<Panel> panels;
};

}  // namespace slamot::report
