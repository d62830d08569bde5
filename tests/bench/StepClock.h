#pragma once
#include <ctime>

namespace slamot::bench {

/// Processor time of the calling thread [s]: what other programs on the machine do is not counted.
inline double threadSeconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace slamot::bench
