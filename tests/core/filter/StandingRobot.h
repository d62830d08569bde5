#pragma once
// A filter whose robot stands at the origin and looks all around: scans made by hand.
#include <cmath>
#include <utility>
#include <vector>

#include "slamot/core/filter/JointFilter.h"
#include "slamot/core/random/RandomStream.h"
#include "support/Scenes.h"

namespace slamot::test {

class StandingRobot {
  public:
    using Scan = std::vector<std::pair<Vector2, ObjectKind>>;

    explicit StandingRobot(const JointFilterParameters& parameters = {}, double dt = 0.2)
        : filter(parameters, {}), dt_(dt) {
        sensor.max_range = 20;
        filter.start({}, {});
    }

    /// The next scan, dt later; deviations 0.1 m and 0.02 rad times `noise`.
    UpdateReport look(const Scan& scan, double noise = 0) {
        pass();
        std::vector<RangeBearingDetection> detections;
        for (const auto& [at, kind] : scan) {
            detections.push_back(seen({}, at, kind, -1, sensor.pose));
            detections.back().range += noise * 0.1 * random.normal();
            detections.back().bearing = wrapAngle(detections.back().bearing + noise * 0.02 * random.normal());
        }
        DetectionSet set = detectionsAt(time(), detections);
        std::get<RangeBearingSet>(set.measurements).sensors[0] = sensor;
        return filter.update(set);
    }
    /// dt without a scan.
    void pass() {
        ++step_;
        filter.predict(odometry(time() - dt_, time(), {}));
    }
    double time() const { return dt_ * step_; }

    JointFilter filter;
    RangeBearingSensor sensor;
    RandomStream random{7, RandomPurpose::test};

  private:
    double dt_;
    int step_ = 0;
};

}  // namespace slamot::test
