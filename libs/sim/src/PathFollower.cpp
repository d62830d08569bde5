#include "slamot/sim/PathFollower.h"

namespace slamot::sim {

PathFollower::PathFollower(std::vector<Vector2> path, const Vector2& start, int loops, double reach_distance)
    : path_(std::move(path)),
      leg_start_(start),
      loops_left_(loops),
      endless_(loops == 0),
      reach_distance_(reach_distance) {}

bool PathFollower::done(const Vector2& position) const {
    const Vector2 beyond = position - path_[index_], leg = path_[index_] - leg_start_;
    return beyond.norm() <= reach_distance_ || (leg.norm() > 0 && beyond.dot(leg) >= 0);
}

std::optional<Vector2> PathFollower::next(const Vector2& position) {
    // At most one round per call, so that a path that is near as a whole ends too.
    for (std::size_t tried = 0; tried < path_.size(); ++tried) {
        if (!endless_ && loops_left_ == 0) return std::nullopt;
        if (!done(position)) return path_[index_];
        leg_start_ = path_[index_];
        if (++index_ == path_.size()) {
            index_ = 0;
            if (!endless_) --loops_left_;
        }
    }
    if (path_.empty() || (!endless_ && loops_left_ == 0)) return std::nullopt;
    return path_[index_];
}

}  // namespace slamot::sim
