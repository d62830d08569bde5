#include "slamot/core/filter/KindWatch.h"

#include <algorithm>

namespace slamot {
namespace {

/// [s] after which odometry says little about whether an object seen again has moved.
constexpr double longest_unseen = 5;
/// P(moving) of an object that is watched anew keeps this far from 0 and 1: it may have changed unseen.
constexpr double least_doubt = 0.01;

}  // namespace

KindWatch::KindWatch(const MotionChange& change, double velocity_std, double acceleration_std)
    : change_(change), velocity_std_(velocity_std), acceleration_std_(acceleration_std) {}

void KindWatch::predict(const RelativeStep& step, const TargetModel& model) {
    for (auto at = watched_.begin(); at != watched_.end();) {
        Watched& watched = at->second;
        watched.unseen += step.dt;
        if (watched.unseen > longest_unseen) {
            at = watched_.erase(at);
        } else {
            watched.track.predict(step, model, change_);
            ++at;
        }
    }
}

double KindWatch::look(BlockId block, double moving, const RangeBearingDetection& detection,
                       const Pose2& sensor, Consistency consistency) {
    const auto known = watched_.find(block);
    if (known == watched_.end()) {
        const double doubted = std::clamp(moving, least_doubt, 1 - least_doubt);
        watched_.emplace(block, Watched{RelativeTrack(firstSight(detection, sensor, consistency), doubted,
                                                      velocity_std_, acceleration_std_),
                                        0});
        return doubted;
    }
    known->second.unseen = 0;
    known->second.track.update(detection, sensor);
    return known->second.track.movingProbability();
}

RelativeGaussian KindWatch::asMover(BlockId block) const {
    return watched_.at(block).track.asMover();
}

}  // namespace slamot
