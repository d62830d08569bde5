#pragma once
// How long a filter's steps take.
#include <cstddef>
#include <vector>

#include "slamot/core/data/Detections.h"
#include "slamot/core/data/Odometry.h"

namespace slamot::bench {

/// [ms]
struct StepTime {
    double processor = 0;  ///< of the calling thread: what others do on this machine does not count
    double wall = 0;
};
StepTime operator-(const StepTime& end, const StepTime& begin);
StepTime timeNow();

/// [ms] of processor time that this process has taken, on all its threads.
double processTime();

/// Prediction and update of anything that has both.
template <class Filter>
StepTime timeStep(Filter& filter, const OdometryIncrement& odometry, const DetectionSet& seen) {
    const StepTime begin = timeNow();
    filter.predict(odometry);
    filter.update(seen);
    return timeNow() - begin;
}

/// [ms]; NaN of no step.
struct TimeSummary {
    std::size_t steps = 0;
    double mean, median, p99, longest;  ///< processor time
    double wall_median, wall_p99, wall_longest;
};
TimeSummary summarise(const std::vector<StepTime>& times);

}  // namespace slamot::bench
