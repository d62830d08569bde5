#pragma once
// From a scenario and a seed to logs with truth, in memory.
#include <mrpt/obs/CObservation.h>

#include <cstdint>
#include <functional>
#include <vector>

#include "slamot/rawlog/Conventions.h"
#include "slamot/rawlog/Truth.h"
#include "slamot/sim/Scenario.h"
#include "slamot/sim/Sensor.h"

namespace slamot::sim {

/// One robot's log. The values are in double precision; a rawlog keeps ranges and bearings as floats.
struct SimulatedLog {
    int robot = 0;
    std::vector<OdometryReading> odometry;  ///< rising stamps
    std::vector<Scan> scans;                ///< rising stamps; by label within a stamp
    Truth truth;

    /// As MRPT observations in the order of the log: odometry before scans at equal stamps.
    std::vector<mrpt::obs::CObservation::Ptr> observations() const;
};

/// Label of the odometry in simulated logs.
inline constexpr const char* odometry_label = "odometry";

/// Called with the part done, 0 to 1; returns false to stop.
using SimulationProgress = std::function<bool(double)>;

/// One log per robot, in the order of Scenario::robots; all share world and movers. Equal scenario and seed
/// give equal logs. Empty when `progress` stopped it. Throws ConfigError for an impossible scenario.
std::vector<SimulatedLog> simulate(const Scenario& scenario, std::uint64_t seed,
                                   const SimulationProgress& progress = {});

}  // namespace slamot::sim
