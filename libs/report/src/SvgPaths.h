#pragma once
#include <string>

namespace slamot::report {

/// Rounds the coordinates of paths to hundredths of a pixel: Vega writes sixteen digits, which triples the
/// size of long lines. Nothing else in the picture is touched.
std::string roundPathCoordinates(const std::string& svg);

}  // namespace slamot::report
