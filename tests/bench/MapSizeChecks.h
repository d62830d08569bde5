#pragma once
// What the engines are asked for at scale, beside what was measured.
#include "MapSizeReport.h"

namespace slamot::bench {

/// One line for each demand; "not run" where the sizes of this run do not cover it.
study::Table checksTable(const Results& results);

}  // namespace slamot::bench
