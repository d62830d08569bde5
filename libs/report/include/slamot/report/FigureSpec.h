#pragma once
// Figures as Vega 5 specifications: what the SVG is drawn from and what an interactive page can show as well.
#include <nlohmann/json_fwd.hpp>

#include "slamot/report/Figure.h"

namespace slamot::report {

/// A complete specification with its data inside. Its `width` and `height` are the picture's in pixels.
/// Each panel is a group mark `panel_<i>` with scales `x` and `y`; layer j of it reads the data `p<i>_l<j>`
/// and is drawn by the mark `mark_p<i>_l<j>`. `usermeta` says where panels lie, what their axes show and
/// which marks a label of the legend stands for: an interactive page moves axes and hides layers by it.
nlohmann::json figureSpec(const Figure& figure);

}  // namespace slamot::report
