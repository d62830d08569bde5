#include "slamot/core/particles/PhdScan.h"

#include <Eigen/LU>
#include <algorithm>

namespace slamot {

DetectionSet withoutIdentities(DetectionSet set) {
    for (RangeBearingDetection& detection : std::get<RangeBearingSet>(set.measurements).detections)
        detection.source = {};
    return set;
}

PhdView::PhdView(const ScanView& view, const PhdMapParameters& p)
    : sensor(view.sensor.pose), looks(view.nameless) {
    const RangeBearingSensor& s = view.sensor;
    const auto cosine = [](double half) { return half < pi ? std::cos(std::max(half, 0.0)) : -2.0; };
    outer_ = {std::max(s.min_range - p.range_margin, 0.0), s.max_range + p.range_margin,
              cosine(0.5 * s.field_of_view + p.bearing_margin)};
    inner_ = {std::max(s.min_range > 0 ? s.min_range + p.range_margin : 0.0, p.nearest),
              std::max(s.max_range - p.range_margin, 0.0),
              s.field_of_view < 2 * pi ? cosine(0.5 * s.field_of_view - p.bearing_margin) : -2.0};
}

PhdScan::PhdScan(const ParticleScan& scan, const PhdMapParameters& p, GaussianTransform transform)
    : now(scan.now), reach(scan.reach + p.range_margin) {
    for (const ScanView& view : scan.views) views.emplace_back(view, p);
    for (const ScanSight& each : scan.sights) {
        PhdSight sight(each);
        const double range = each.z.x(), bearing = each.z.y();
        sight.point = range * Vector2(std::cos(bearing), std::sin(bearing));
        sight.variance = each.R(0, 0) + range * range * each.R(1, 1);
        sight.clutter = std::exp(each.log_unexplained);
        // q <= exp(-NIS / 2) / (2 pi sqrt(det R)), and a term of less than prune_below is not kept.
        const double most = PhdSight::ordinary_weight * p.detection_probability / (2 * pi * p.prune_below);
        sight.widest = 2 * (std::log(most) - each.log_unexplained) - std::log(each.R.determinant());
        sight.start = firstSight(placeOf(Vector3::Zero(), scan.sensorOf(each)), each.z, each.R, transform);
        sights.push_back(sight);
    }
}

}  // namespace slamot
