#pragma once
// Whether objects of unknown kind stand still or move, while they are seen.
#include <map>
#include <optional>

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
    /// Of a landmark that is watched and was missed: how far a detection lies from it (NIS) if it moves; none
    /// where it is not watched.
    std::optional<double> nisAsMover(BlockId block, const RangeBearingDetection& detection,
                                     const Pose2& sensor) const;
    /// As RelativeTrack::updateAsMover, of an object that is watched; gives P(moving) now. A single look
    /// aside gives what was believed before: where many landmarks stand in clutter, some false detection lies
    /// beside one that was missed every few seconds, and scarcely ever twice.
    double lookAside(BlockId block, const RangeBearingDetection& detection, const Pose2& sensor,
                     double detection_probability, double density);
    /// Of an object that is watched: position, velocity and acceleration if it moves.
    RelativeGaussian asMover(BlockId block) const;
    void forget(BlockId block) { watched_.erase(block); }

  private:
    struct Watched {
        RelativeTrack track;
        double unseen = 0;  ///< [s]
        int aside = 0;      ///< looks since it was last seen in its place
    };

    MotionChange change_;
    std::map<BlockId, Watched> watched_;
};

}  // namespace slamot
