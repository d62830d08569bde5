#pragma once
// One picture of a whole run.
#include <string>

#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/Truth.h"
#include "slamot/report/Figure.h"

namespace slamot::report {

struct OverviewText {
    std::string title = "Run overview";
    /// Replaces the line that says how long the run was and, with truth, the robot's RMSE.
    std::string subtitle;
};

/// The map with landmarks and their 3-sigma ellipses and the ways of robot and tracks; with `truth` (may be
/// null) also the true ones, and a second panel: the robot's position error and its 3-sigma bound. Run and
/// truth must be in one frame (align first otherwise). A few far-off landmarks and tracks do not shrink the
/// view; a note counts what lies outside.
Figure overviewFigure(const eval::RunRecord& run, const Truth* truth, const OverviewText& text = {});

}  // namespace slamot::report
