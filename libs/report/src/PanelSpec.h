#pragma once
#include <nlohmann/json.hpp>

#include "slamot/report/Figure.h"

namespace slamot::report {

struct PanelSpec {
    double height = 0;     ///< with title, legend, axes and note
    nlohmann::json data;   ///< an array of data sets
    nlohmann::json marks;  ///< an array of the panel's groups
    /// For interactive pages: where the plotting area lies and what its axes show.
    nlohmann::json meta;
};

/// `left`, `top`, `width`: the panel's place in the figure, axes and legend included.
PanelSpec panelSpec(const Panel& panel, std::size_t index, double left, double top, double width);

}  // namespace slamot::report
