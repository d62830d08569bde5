#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "slamot/rawlog/Conventions.h"
#include "slamot/sim/Mover.h"
#include "slamot/sim/Scenario.h"
#include "slamot/sim/World.h"

namespace slamot::sim {

/// One scan, in double precision, and what its detections really came from. Detections stand in the order of
/// their bearings, so that the order tells nothing.
struct Scan {
    RangeBearingReading reading;
    double range_std = 0, bearing_std = 0;  ///< the sensor's claim
    std::vector<TrueAssociation> origins;   ///< one per item; `index` counts within this scan
};

/// A scan of `robot` at `step` from the true `pose`. A robot does not see itself.
Scan scan(const Scenario& scenario, const SensorParameters& sensor, int robot, int step, const Pose2& pose,
          const World& world, const std::vector<Trajectory>& movers, std::uint64_t seed);

}  // namespace slamot::sim
