#pragma once
// One pass of one filter over one log, as both sides of the comparison report it.
#include <string>
#include <utility>
#include <vector>

#include "slamot/core/data/Pose2.h"

namespace slamot::bench {

/// What both filters are told about the sensor.
struct SensorNoise {
    double range_std = 0, bearing_std = 0;  ///< [m], [rad]
};

struct Trial {
    /// After each frame, the first frame with an action being number 0.
    std::vector<Pose2> poses;
    std::vector<double> seconds;  ///< processor time of each frame
    std::vector<int> landmarks;   ///< in the map after each frame
    std::vector<int> seen;        ///< measurements of each frame
};

/// MRPT's CRangeBearingKFSLAM2D, frame by frame as its program kf-slam does.
Trial runKfSlam(const std::string& log, const SensorNoise& noise);

/// ekf_slamot through the pipeline of `slamot run`, without output files. `settings` are `section.key=value`.
/// With `certain_start` the movements before the first detection bring no noise, as with kf-slam, which does
/// not predict while its map is empty.
Trial runSlamot(const std::string& log, const std::string& config, const std::vector<std::string>& settings,
                bool certain_start);

}  // namespace slamot::bench
