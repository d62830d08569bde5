#include "slamot/core/filter/KindWatch.h"

#include <algorithm>

namespace slamot {
namespace {

/// [s] after which odometry says little about whether an object seen again has moved.
constexpr double longest_unseen = 5;
/// P(moving) of an object that is watched anew keeps this far from 0 and 1: it may have changed unseen.
constexpr double least_doubt = 0.01;

}  // namespace

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
        MotionChange believed = change_;
        believed.moving_probability = std::clamp(moving, least_doubt, 1 - least_doubt);
        const RelativeGaussian point = firstSight(detection, sensor, consistency);
        watched_.emplace(block, Watched{RelativeTrack::unknown(point, believed)});
        return believed.moving_probability;
    }
    known->second.unseen = 0;
    known->second.aside = 0;
    known->second.track.update(detection, sensor);
    return known->second.track.movingProbability();
}

std::optional<double> KindWatch::nisAsMover(BlockId block, const RangeBearingDetection& detection,
                                            const Pose2& sensor) const {
    const auto known = watched_.find(block);
    if (known == watched_.end()) return std::nullopt;
    return known->second.track.nisAsMover(detection, sensor);
}

double KindWatch::lookAside(BlockId block, const RangeBearingDetection& detection, const Pose2& sensor,
                            double detection_probability, double density) {
    Watched& watched = watched_.at(block);
    const double before = watched.track.movingProbability();
    watched.track.updateAsMover(detection, sensor, detection_probability, density);
    return ++watched.aside > 1 ? watched.track.movingProbability() : before;
}

RelativeGaussian KindWatch::asMover(BlockId block) const {
    return watched_.at(block).track.asMover();
}

}  // namespace slamot
