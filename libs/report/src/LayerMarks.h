#pragma once
#include <nlohmann/json.hpp>

#include "Domain.h"

namespace slamot::report {

struct LayerSpec {
    nlohmann::json data;   ///< rows of the data set, null if the layer has none
    nlohmann::json marks;  ///< an array, to be placed in the panel's group
};

LayerSpec layerSpec(const Layer& layer, const std::string& data_name, const PanelView& view);

// Pieces shared with the legend's swatches.
nlohmann::json dashPattern(Dash dash, double width);
/// Vega's `shape` and how it is painted; `size` is Vega's: the square of the diameter.
nlohmann::json symbolEncoding(const Points& points);
/// {"value": v}: Vega's way to write a constant.
nlohmann::json constant(nlohmann::json value);

}  // namespace slamot::report
