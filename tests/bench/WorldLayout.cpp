#include "WorldLayout.h"

#include <algorithm>
#include <cmath>

namespace slamot::bench {
namespace {

/// Lanes there and back, from the left and from the right by turns. `first`: where the first one begins.
std::vector<Vector2> lanes(int count, double length, double apart, const Vector2& first) {
    std::vector<Vector2> corners;
    for (int i = 0; i < count; ++i)
        for (const bool end : {false, true})
            corners.push_back(first + Vector2((i % 2 == 0) == end ? length : 0.0, i * apart));
    return corners;
}

/// The point so far along a path, and so far to its left.
Vector2 beside(const std::vector<Vector2>& corners, double along, double left) {
    std::size_t piece = 0;
    for (; piece + 2 < corners.size(); ++piece) {
        const double length = (corners[piece + 1] - corners[piece]).norm();
        if (along <= length) break;
        along -= length;
    }
    const Vector2 ahead = (corners[piece + 1] - corners[piece]).normalized();
    return corners[piece] + along * ahead + left * Vector2(-ahead.y(), ahead.x());
}

GroundPlan field(int landmarks, RandomStream& random) {
    GroundPlan plan;
    plan.side = std::sqrt(landmarks / landmark_density);
    // A lane is 36 m wide where that comes out even, and never wider than the sensor sees.
    const int count = static_cast<int>(
        std::max(std::round(plan.side / (1.8 * sensor_reach)), std::ceil(plan.side / (2 * sensor_reach))));
    const double width = plan.side / count;
    plan.corners = lanes(count, plan.side, width, {0, 0.5 * width});
    for (int i = 0; i < landmarks; ++i)
        plan.landmarks.emplace_back(random.uniform(0, plan.side), random.uniform(0, plan.side));
    return plan;
}

GroundPlan road(int landmarks, RandomStream& random) {
    constexpr double apart = 4 * sensor_reach;
    const double length = landmarks / (landmark_density * 2 * sensor_reach);
    const int count = std::max(1, static_cast<int>(std::round(std::sqrt(length / apart))));
    const double lane = (length - (count - 1) * apart) / count;
    GroundPlan plan;
    plan.side = std::max(lane, (count - 1) * apart) + 2 * sensor_reach;
    plan.corners = lanes(count, lane, apart, {sensor_reach, sensor_reach});
    for (int i = 0; i < landmarks; ++i) {
        const double along = random.uniform(0, length);
        plan.landmarks.push_back(beside(plan.corners, along, random.uniform(-sensor_reach, sensor_reach)));
    }
    return plan;
}

}  // namespace

const char* nameOf(WorldLayout layout) {
    return layout == WorldLayout::field ? "field" : "road";
}

GroundPlan groundPlan(WorldLayout layout, int landmarks, RandomStream& random) {
    return layout == WorldLayout::field ? field(landmarks, random) : road(landmarks, random);
}

}  // namespace slamot::bench
