#pragma once
#include <string>

#include "slamot/report/RunFolder.h"

namespace slamot::report {

/// The run as assets/replay.js plays it: at most 2000 frames evenly over the time, and so many places of
/// landmarks that the page stays small however long the run was.
std::string replayData(const RunFolder& run);

/// The places of landmarks over time that are kept of `sights`: one for each change that is seen at `pixel`
/// metres a pixel; the first and last of each landmark in any case.
std::vector<LandmarkSight> visibleChanges(const std::vector<LandmarkSight>& sights, double pixel);

}  // namespace slamot::report
