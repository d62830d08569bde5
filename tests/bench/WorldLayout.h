#pragma once
// The ground plans of the benchmarks' world: where the robot drives and where landmarks stand.
#include <vector>

#include "slamot/core/data/Angle.h"
#include "slamot/core/data/Pose2.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot::bench {

constexpr double sensor_reach = 20;        ///< [m], all around
constexpr double landmarks_in_sight = 40;  ///< away from the rim, on average
constexpr double landmark_density = landmarks_in_sight / (pi * sensor_reach * sensor_reach);  ///< [1/m^2]

enum class WorldLayout {
    field,  ///< a square of landmarks, mown in lanes side by side
    road,   ///< a strip of landmarks along a road whose lanes do not see one another
};
const char* nameOf(WorldLayout layout);

/// [m]
struct GroundPlan {
    double side = 0;               ///< all lies within 0 and this, along both axes
    std::vector<Vector2> corners;  ///< of the way out; the way back is the same
    std::vector<Vector2> landmarks;
};
GroundPlan groundPlan(WorldLayout layout, int landmarks, RandomStream& random);

}  // namespace slamot::bench
