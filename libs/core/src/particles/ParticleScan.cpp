#include "slamot/core/particles/ParticleScan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "slamot/core/objects/FieldOfView.h"
#include "slamot/core/objects/TentativeObjects.h"

namespace slamot {
namespace {

std::vector<int> bySensor(const RangeBearingSet& seen) {
    std::vector<int> order(seen.detections.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return seen.detections[static_cast<std::size_t>(a)].sensor <
               seen.detections[static_cast<std::size_t>(b)].sensor;
    });
    return order;
}

}  // namespace

ParticleScan ScanMaker::scan(const DetectionSet& set) {
    const RangeBearingSet seen = limits_.completed(set.rangeBearing());
    ParticleScan out;
    out.now = set.stamp;
    for (const RangeBearingSensor& sensor : seen.sensors)
        out.views.push_back({sensor, sensor.max_range + sensor.pose.position().norm(), false});

    for (const int i : bySensor(seen)) {
        const RangeBearingDetection& d = seen.detections[static_cast<std::size_t>(i)];
        const LandmarkId birth{detections_ + static_cast<std::int64_t>(out.sights.size())};
        if (d.kind == ObjectKind::mover) continue;
        const bool named = d.source.valid() && d.kind == ObjectKind::landmark;
        if (!named && !use_nameless_) continue;

        ScanView& view = out.views[static_cast<std::size_t>(d.sensor)];
        // A reading beyond the stated limit comes from somewhere too.
        view.reach = std::max(view.reach, d.range + view.sensor.pose.position().norm());
        const Vector2 local = inverseRangeBearing<double>(Vector3::Zero(), d.z(), view.sensor.pose);
        ScanSight sight{i, d.z(), d.covariance, local, d.sensor, {}, {}, birth, 0, false};
        sight.may_be_mover = movers_ && d.kind == ObjectKind::unknown;
        if (named) {
            const auto [known, is_new] = named_.try_emplace(d.source, birth);
            // Twice in its first batch: the first has started it, the second says nothing that can be used.
            if (!is_new && known->second.value >= detections_) continue;
            sight.source = d.source;
            if (!is_new) sight.known_as = known->second;
        } else {
            nameless_.insert(view.sensor.label);
            sight.log_unexplained = std::log(unexplainedDensity(life_, view.sensor));
        }
        out.sights.push_back(sight);
    }
    detections_ += static_cast<std::int64_t>(seen.detections.size());
    for (ScanView& view : out.views) {
        view.nameless = reports(view.sensor, ObjectKind::landmark) && nameless_.count(view.sensor.label) > 0;
        out.nameless |= view.nameless;
        out.reach = std::max(out.reach, view.reach);
    }
    return out;
}

}  // namespace slamot
