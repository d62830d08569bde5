#pragma once
// Fewer points, same picture: figures of long runs stay light. Coordinates here are pixels.
#include <cstddef>
#include <vector>

#include "slamot/report/Layers.h"

namespace slamot::report {

/// For points with rising x: which to keep so that every pixel column of the line between them looks the
/// same: the first, the lowest, the highest and the last of each column. Indices rise.
std::vector<std::size_t> keepColumnExtremes(const Points2& pixels);

/// Ramer-Douglas-Peucker: no dropped point is further than `tolerance` from the line that is left. Indices
/// rise.
std::vector<std::size_t> simplifyPath(const Points2& pixels, double tolerance);

/// The first point of each occupied pixel: marks that would lie on one another exactly. Indices rise.
std::vector<std::size_t> keepOnePerPixel(const Points2& pixels);

}  // namespace slamot::report
