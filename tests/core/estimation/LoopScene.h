#pragma once
// A robot that drives a loop of 240 m again and again among many landmarks, with movers that come and go.
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "slamot/core/random/RandomStream.h"
#include "support/Scenes.h"

namespace slamot::test {

/// A rectangle of 80 m x 40 m at 1 m a step, with landmarks on both sides, that a scanner
/// sees to 12 m, and movers, that a radar sees from anywhere.
class LoopScene {
  public:
    LoopScene(std::uint64_t seed, int landmarks) : random_(seed, RandomPurpose::test) {
        for (int i = 0; i < landmarks; ++i)
            landmarks_.emplace_back(random_.uniform(-15, 95), random_.uniform(-15, 55));
        pose_ = {0, 0, 0};
    }

    OdometryIncrement drive(int step) {
        const int along = step % 240;
        const bool corner = along == 80 || along == 120 || along == 200 || (along == 0 && step > 0);
        const Pose2 increment{1, 0, corner ? pi / 2 : 0};
        // Turns in place before moving on, so that the path stays on the rectangle.
        pose_ = pose_ * Pose2{0, 0, increment.theta} * Pose2{1, 0, 0};
        const Pose2 measured{std::cos(increment.theta) + 0.02 * random_.normal(),
                             std::sin(increment.theta) + 0.01 * random_.normal(),
                             increment.theta + 0.005 * random_.normal()};
        return odometry(dt * step, dt * (step + 1), measured);
    }

    DetectionSet look(int step) {
        std::vector<RangeBearingDetection> detections;
        for (std::size_t i = 0; i < landmarks_.size(); ++i)
            if ((landmarks_[i] - pose_.position()).norm() < range)
                detections.push_back(
                    seen(pose_, landmarks_[i], ObjectKind::landmark, static_cast<std::int64_t>(i)));
        // A mover overtakes the robot every 30 steps; its track has ended in between.
        if (step % 30 < 12)
            detections.push_back(
                seen(pose_, pose_ * Vector2(-6 + step % 30, 3), ObjectKind::mover, 0, {}, 1));
        if (step % 50 > 40)
            detections.push_back(
                seen(pose_, pose_ * Vector2(4, 10 - 2 * (step % 50 - 40)), ObjectKind::mover, 1, {}, 1));
        for (RangeBearingDetection& d : detections) {
            d.range += 0.1 * random_.normal();
            d.bearing = wrapAngle(d.bearing + 0.02 * random_.normal());
        }
        DetectionSet set = detectionsAt(dt * (step + 1), detections, {Pose2{}, Pose2{}});
        auto& sensors = std::get<RangeBearingSet>(set.measurements).sensors;
        sensors[0].max_range = range;
        sensors[1].label = "radar";
        sensors[1].max_range = 1000;
        return set;
    }

  private:
    static constexpr double range = 12, dt = 0.5;  // [m], [s]

    RandomStream random_;
    std::vector<Vector2> landmarks_;
    Pose2 pose_;
};

}  // namespace slamot::test
