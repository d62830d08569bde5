#pragma once
// One particle with a map, and the scans it is shown, for tests of the maps by themselves.
#include <utility>
#include <vector>

#include "slamot/core/particles/ParticleScan.h"
#include "slamot/core/particles/PoseBelief.h"
#include "support/Scenes.h"

namespace slamot::test {

inline RangeBearingDetection nameless(const Vector2& point, const Pose2& robot = {},
                                      const Pose2& mount = {}) {
    return seen(robot, point, ObjectKind::landmark, -1, mount);
}

inline RangeBearingSensor& sensorOf(DetectionSet& set) {
    return std::get<RangeBearingSet>(set.measurements).sensors.front();
}

/// One sensor of 20 m all around.
inline DetectionSet scanAt(double t, std::vector<RangeBearingDetection> detections) {
    DetectionSet set = detectionsAt(t, std::move(detections));
    RangeBearingSensor& sensor = sensorOf(set);
    sensor.label = "landmarks";
    sensor.kind = ObjectKind::landmark;
    sensor.max_range = 20;
    return set;
}

/// Nothing is seen, by a sensor that looks at the half plane behind.
inline DetectionSet scanBehind(double t) {
    DetectionSet set = scanAt(t, {});
    sensorOf(set).field_of_view = pi;
    sensorOf(set).pose.theta = pi;
    return set;
}

/// Two sensors of one kind look at once; the last detection is the second one's.
inline DetectionSet scanOfTwo(double t, std::vector<RangeBearingDetection> detections) {
    DetectionSet set = scanAt(t, std::move(detections));
    auto& both = std::get<RangeBearingSet>(set.measurements);
    both.sensors.push_back(both.sensors.front());
    both.sensors.back().label = "other";
    both.detections.back().sensor = 1;
    return set;
}

/// Feature: what the map is made of.
template <class Map, class Feature>
struct OneParticle {
    OneParticle(typename Map::Settings s, ScanMaker maker) : settings(std::move(s)), scans(std::move(maker)) {
        map.renew(1);
    }

    /// The log likelihood of a scan from a pose that is known.
    double take(const DetectionSet& set, const Pose2& pose = {}) {
        const ParticleScan scan = scans.scan(set);
        work = {};
        map.pairUp(settings, PoseBelief{pose.vector(), Matrix3::Zero()}, scan, work, records);
        return map.update(settings, pose.vector(), drawn, scan, work, records);
    }
    std::vector<Feature> all() const {
        std::vector<Feature> out;
        map.features().forEach([&](const Feature& feature) { out.push_back(feature); });
        return out;
    }

    typename Map::Settings settings;
    ScanMaker scans;
    Map map;
    typename Map::Work work;
    std::vector<SightRecord> records;  ///< by sight, of the last scan
    bool drawn = false;                ///< what update is told; the pose is the same
};

}  // namespace slamot::test
