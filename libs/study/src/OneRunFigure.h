#pragma once
// Figures of one run of a study: the kind `one_run`.
#include "slamot/report/Figure.h"
#include "slamot/study/AnalysisFile.h"
#include "slamot/study/OneRun.h"

namespace slamot::study {

report::Figure oneRunFigure(const PlotSpec& spec, const OneRun& run);

}  // namespace slamot::study
