#pragma once
// Runs side by side.
#include <string>
#include <vector>

#include "slamot/report/Page.h"
#include "slamot/report/RunFolder.h"

namespace slamot::report {

/// Runs of one configuration: they differ by seed or log alone.
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
    std::size_t count = 0;
    double mean = 0, half_width = 0;
    bool best = false;  ///< better than every other group, or as good as the best of them
};

struct ComparedMetric {
    std::string group, heading;
    std::vector<GroupValue> values;  ///< one for each group of runs
};

/// The metrics that any group has. None is best where only one group has a value or all are equal.
std::vector<ComparedMetric> compareMetrics(const std::vector<RunGroup>& groups);

/// For the terminal: at most 80 columns, a star beside the best.
std::string comparisonText(const std::vector<RunGroup>& groups);

Page comparisonPage(const std::vector<RunGroup>& groups);

}  // namespace slamot::report
