#pragma once
// Figures of a study.
#include "slamot/study/Tables.h"

namespace slamot::report {
struct Figure;
}

namespace slamot::study {

/// A panel for each figure or series, source and point of the scenario's grid; a line for each config and
/// point of the configs' grid. The parameter along the axis counts for neither, and `against` is one panel of
/// all cells.
report::Figure makeFigure(const PlotSpec& spec, const Findings& findings);

}  // namespace slamot::study
