#pragma once
#include <cstdint>

#include "slamot/rawlog/Conventions.h"

namespace slamot::run {

/// A range-bearing observation that waits for odometry.
struct HeldReading {
    RangeBearingReading reading;
    /// Covariance of [range bearing] that the sensor as a whole claims; zero where it claims nothing.
    Matrix2 claim = Matrix2::Zero();
    /// Counts the log's range-bearing observations.
    std::uint32_t observation = 0;
    /// Number of its first detection among all that the log has at its stamp.
    int first_number = 0;
};

}  // namespace slamot::run
