#pragma once
// Whether objects of unknown kind stand still or move, while they are seen.
#include <map>

#include "slamot/core/objects/RelativeTrack.h"

namespace slamot {

/// Tracks each such object beside the joint state, which knows it as a landmark or as a mover, from the robot
/// alone: as both.
class KindWatch {
  public:
    explicit KindWatch(const MotionChange& change) : change_(change) {}

    void clear() { watched_.clear(); }
    bool watching() const { return !watched_.empty(); }
    /// Objects unseen for some seconds are watched no more.
    void predict(const RelativeStep& step, const TargetModel& model);
    /// The object in `block`, of which P(moving) was believed to be `moving` when it was seen last, is seen;
    /// gives P(moving) now.
    double look(BlockId block, double moving, const RangeBearingDetection& detection, const Pose2& sensor,
                Consistency consistency);
    /// Of an object that is watched: position, velocity and acceleration if it moves.
    RelativeGaussian asMover(BlockId block) const;
    void forget(BlockId block) { watched_.erase(block); }

  private:
    struct Watched {
        RelativeTrack track;
        double unseen;  ///< [s]
    };

    MotionChange change_;
    std::map<BlockId, Watched> watched_;
};

}  // namespace slamot
