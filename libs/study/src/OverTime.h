#pragma once
// A series of many runs as one course over time.
#include <string>
#include <vector>

#include "slamot/study/Analysis.h"

namespace slamot::study {

/// What the runs that have a value at a time say together; `low` and `high` hold the middle 80 % of them.
struct CourseStep {
    double seconds = 0;
    int runs = 0;
    double mean = 0, median = 0, low = 0, high = 0;
};

struct Course {
    std::vector<CourseStep> steps;
    /// [s]. Zero where runs share their times, as simulated ones do. Otherwise each run's values are averaged
    /// over intervals of this length, `seconds` being the middle.
    double interval = 0;
    int runs = 0;
};
Course courseOf(const Cell& cell, const std::string& series);

/// Between order statistics, linearly: 0 is the least, 1 the greatest. `sorted` must not be empty.
double quantileOf(const std::vector<double>& sorted, double part);

}  // namespace slamot::study
