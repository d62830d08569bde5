#pragma once
#include <nlohmann/json.hpp>

#include "slamot/report/Layers.h"

namespace slamot::report {

/// The cells as a PNG inside a `data:` address, row 0 of the values at the bottom; empty cells are
/// transparent.
std::string heatMapImage(const HeatMap& map);

/// The map's colours from bottom to top as a Vega gradient.
nlohmann::json colourGradient(ColourMap colours);

}  // namespace slamot::report
