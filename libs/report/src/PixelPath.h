#pragma once
#include "Domain.h"

namespace slamot::report {

/// The points of a line that make its picture: split at gaps, cut where it leaves the panel by far (a
/// diverged track must not overflow the renderer's coordinates) and decimated. The pieces hold two points or
/// more, or the single point of a piece that had one.
std::vector<Points2> visiblePieces(const Points2& points, const PanelView& view);

/// Whether a mark at `point` can touch the panel; `reach` is its radius in pixels.
bool nearPanel(const Eigen::Vector2d& point, const PanelView& view, double reach);

}  // namespace slamot::report
