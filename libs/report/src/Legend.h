#pragma once
#include <nlohmann/json.hpp>

#include "slamot/report/Figure.h"

namespace slamot::report {

/// A panel's legend, outside the plotting area: rows above it or a column at its right. Its size is known
/// before it is drawn, since the panel must leave room.
struct LegendSpec {
    double width = 0, height = 0;  ///< zero without entries
    nlohmann::json marks = nlohmann::json::array();
};

/// Entries in the order of the layers that have a label, from the upper left corner at (0, 0), rows at most
/// `width` pixels wide.
LegendSpec legendSpec(const Panel& panel, double width);

/// What the legend calls a layer; empty for none.
std::string labelOf(const Layer& layer);

/// Of several panels, each label once.
LegendSpec sharedLegendSpec(const std::vector<Panel>& panels, double width);

}  // namespace slamot::report
