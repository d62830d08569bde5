#pragma once
#include <optional>
#include <vector>

#include "slamot/core/data/Pose2.h"

namespace slamot::sim {

/// Hands out one waypoint of a path after the other. A waypoint is done when it is near, or when it has been
/// passed (the line through it, across the leg that leads to it, has been crossed): a vehicle whose turning
/// circle is wider than the path asks for never circles around a waypoint.
class PathFollower {
  public:
    /// `loops` 0 goes round for ever.
    PathFollower(std::vector<Vector2> path, const Vector2& start, int loops, double reach_distance);

    /// Where to head for from `position`; nothing at the end of the path.
    std::optional<Vector2> next(const Vector2& position);

  private:
    bool done(const Vector2& position) const;

    std::vector<Vector2> path_;
    Vector2 leg_start_;
    int loops_left_;
    bool endless_;
    double reach_distance_;
    std::size_t index_ = 0;
};

}  // namespace slamot::sim
