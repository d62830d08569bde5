#pragma once
#include "slamot/report/Page.h"
#include "slamot/report/RunFolder.h"

namespace slamot::report {

/// The run as assets/replay.js plays it, without words for what is seen.
ReplayView replayOf(const RunFolder& run);

}  // namespace slamot::report
