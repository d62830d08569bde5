#pragma once
// What the two source files of the Victoria Park importer share.
#include <filesystem>

#include "Columns.h"
#include "ImportedLog.h"

namespace slamot::victoria_park {

inline constexpr const char* dataset = "the Victoria Park dataset";

/// T_robot_sensor; the robot's frame is in the middle of the rear axle.
inline constexpr Pose2 laser{3.78, 0.5, 0};

/// Largest distance of a detection from the landmark observation that labels it [m].
inline constexpr double label_distance = 0.5;

/// Landmark observations in the file; those whose detection was found.
struct LabelCounts {
    std::int64_t total = 0, found = 0;
};

/// Gives detections of `log` the ids of iSAM's own detections and association. LogError when the file is of
/// other odometry.
LabelCounts labelFromIsam(const std::filesystem::path& file, ImportedLog& log);

}  // namespace slamot::victoria_park
