#pragma once
// Runs side by side.
#include <string>
#include <vector>

#include "slamot/report/Page.h"
#include "slamot/report/RunFolder.h"

namespace slamot::report {

/// Runs of one configuration: they differ by log or seed alone, the estimator's or that of [clutter].
struct RunGroup {
    std::string name;
    std::vector<RunFolder> runs;
};

/// Groups in the order of their first run. A single run is called by its folder, several by what their
/// folders' names begin with.
std::vector<RunGroup> groupRuns(std::vector<RunFolder> runs);

/// A metric of a group: the mean over its runs that have it, and half the width of its 95 % interval
/// (Student's t; NaN for a single run).
struct GroupValue {
    std::size_t count = 0;  ///< runs that have it
    std::size_t of = 0;     ///< runs there are
    double mean = 0, half_width = 0;
    bool contests = false;  ///< every run is complete and has a value, so that the group can be the best
    bool best = false;      ///< better than every other complete group, or as good as the best of them
};

/// Runs that came to the end of their log.
std::size_t completeRuns(const RunGroup& group);

/// "complete", a single run's status, or "2 of 3 complete".
std::string statusOf(const RunGroup& group);

struct ComparedMetric {
    std::string group, heading;
    std::vector<GroupValue> values;  ///< one for each group of runs
};

/// The metrics that any group has. None is best where only one complete group has a value or all are equal; a
/// group with a run that broke off, or without a value of each run, is never the best: what it lacks may be
/// the worst.
std::vector<ComparedMetric> compareMetrics(const std::vector<RunGroup>& groups);

/// For the terminal: at most 80 columns whatever the numbers are, a star beside the best.
std::string comparisonText(const std::vector<RunGroup>& groups);

Page comparisonPage(const std::vector<RunGroup>& groups);

}  // namespace slamot::report
