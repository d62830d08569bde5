#include "StepTimes.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <numeric>

namespace slamot::bench {
namespace {

double milliseconds(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// The smallest value that at least this part of all values does not exceed.
double percentile(const std::vector<double>& sorted, double part) {
    if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
    const double rank = std::ceil(part * static_cast<double>(sorted.size()));
    return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

}  // namespace

StepTime operator-(const StepTime& end, const StepTime& begin) {
    return {end.processor - begin.processor, end.wall - begin.wall};
}

StepTime timeNow() {
    return {milliseconds(CLOCK_THREAD_CPUTIME_ID), milliseconds(CLOCK_MONOTONIC)};
}

double processTime() {
    return milliseconds(CLOCK_PROCESS_CPUTIME_ID);
}

TimeSummary summarise(const std::vector<StepTime>& times) {
    std::vector<double> processor, wall;
    for (const StepTime& time : times) {
        processor.push_back(time.processor);
        wall.push_back(time.wall);
    }
    std::sort(processor.begin(), processor.end());
    std::sort(wall.begin(), wall.end());
    const double mean =
        std::accumulate(processor.begin(), processor.end(), 0.0) / static_cast<double>(processor.size());
    return {times.size(),
            mean,
            percentile(processor, 0.5),
            percentile(processor, 0.99),
            percentile(processor, 1),
            percentile(wall, 0.5),
            percentile(wall, 0.99),
            percentile(wall, 1)};
}

}  // namespace slamot::bench
