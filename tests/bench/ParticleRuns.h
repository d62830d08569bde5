#pragma once
// The runs of particle_bench: particle filters on a world like RFS-SLAM's, and how a step grows with particles and map.
#include <cstddef>
#include <string>
#include <vector>

#include "StepTimes.h"

namespace slamot::bench {

/// An estimator with the settings it is run with.
struct Contender {
    std::string label, plugin;
    bool known;          ///< whether it is told identities
    std::string config;  ///< INI text of its own sections
};

struct WorldRun {
    std::vector<StepTime> times;
    double rmse = 0, final_landmarks = 0;  ///< [m] of the robot, unaligned; landmarks of 50
};

/// A seeded run over config/scenarios/rfs_world.ini, from the true start, on one thread.
WorldRun runWorld(const Contender& contender, std::uint64_t seed);
/// Landmarks that the scenario has.
int worldLandmarks();

struct ScaleRun {
    int particles, landmarks;
    std::vector<StepTime> times;  ///< of the second pass over the map
    double seen = 0;              ///< detections a step
    std::size_t resident = 0;     ///< bytes that the process grew by
    double end_error = 0;         ///< [m]
};

/// fastslam 2.0, identities known, over the field of LaneWorld: ~40 landmarks in sight, all of the map seen twice.
ScaleRun runScale(int particles, int landmarks);

}  // namespace slamot::bench
