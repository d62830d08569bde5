#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "slamot/sim/Scenario.h"

namespace slamot::sim {

struct World {
    std::map<SourceId, Vector2> landmarks;
    /// Loop worlds: points along the middle of the corridor, about 2 m apart, counter-clockwise, from the
    /// origin back to it; the robot that starts at the origin with heading 0 starts along it. Else empty.
    std::vector<Vector2> centre_line;
};

/// Throws ConfigError when `min_distance` leaves no room, LogError for a bad file.
World makeWorld(const WorldParameters& parameters, std::uint64_t seed);

}  // namespace slamot::sim
