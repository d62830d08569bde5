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

/// Takes out runs that repeat one before them, with the same settings but for seeds and the same estimates: a
/// seed that nothing was drawn with, or a copy of the log. They say nothing new. Gives a sentence for each.
std::vector<std::string> dropRepeats(std::vector<RunFolder>& runs);

/// Groups in the order of their first run. A single run is called by its folder, several by what their
/// folders' names begin with.
std::vector<RunGroup> groupRuns(std::vector<RunFolder> runs);

/// A setting that is not the same in all groups; an estimator's own only among groups of that estimator.
struct ComparedSetting {
    std::string section, key;
    std::vector<std::string> values;  ///< one for each group; empty where it is not given
};

/// By section and key; seeds are none.
std::vector<ComparedSetting> compareSettings(const std::vector<RunGroup>& groups);

/// What one must know to read the table: runs of different logs, of which none is marked as the best, and
/// runs whose truth is gone. A sentence each.
std::vector<std::string> comparisonNotes(const std::vector<RunGroup>& groups);

/// A metric of a group: the mean over its runs that have it, and half the width of its 95 % interval
/// (Student's t; NaN for a single run). Runs that broke off have none where others of the group are complete.
struct GroupValue {
    std::size_t count = 0;  ///< runs that count
    std::size_t of = 0;     ///< runs there are
    double mean = 0, half_width = 0;
    bool contests = false;  ///< the group can be the best: complete runs of the same logs, a value of each
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

/// The metrics that any group has. None is best where only one complete group has a value, all look equal in
/// the table, or the groups are not of the same logs, nor of times of single runs; a group with a run that
/// broke off, or without a value of each run, is never the best: what it lacks may be the worst.
std::vector<ComparedMetric> compareMetrics(const std::vector<RunGroup>& groups);

/// For the terminal: at most 80 columns whatever the numbers are, a star beside the best; notes at its end.
std::string comparisonText(const std::vector<RunGroup>& groups);

Page comparisonPage(const std::vector<RunGroup>& groups);

}  // namespace slamot::report
