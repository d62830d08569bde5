#include "slamot/core/particles/PhdScan.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace slamot {

DetectionSet withoutIdentities(DetectionSet set) {
    for (RangeBearingDetection& detection : std::get<RangeBearingSet>(set.measurements).detections)
        detection.source = {};
    return set;
}

PhdView::PhdView(const ScanView& view, const PhdMapParameters& p) : sensor(view.sensor.pose), looks(view.nameless) {
    const RangeBearingSensor& s = view.sensor;
    const auto cosine = [](double half) { return half < pi ? std::cos(std::max(half, 0.0)) : -2.0; };
    outer = {std::max(s.min_range - p.range_margin, 0.0), s.max_range + p.range_margin,
             cosine(0.5 * s.field_of_view + p.bearing_margin)};
    inner = {std::max(s.min_range > 0 ? s.min_range + p.range_margin : 0.0, p.nearest),
             std::max(s.max_range - p.range_margin, 0.0),
             s.field_of_view < 2 * pi ? cosine(0.5 * s.field_of_view - p.bearing_margin) : -2.0};
}

PhdScan::PhdScan(const ParticleScan& scan, const PhdMapParameters& parameters, GaussianTransform transform)
    : now(scan.now), reach(scan.reach + parameters.range_margin) {
    for (const ScanView& view : scan.views) views.emplace_back(view, parameters);
    for (const ScanSight& each : scan.sights) {
        PhdSight sight;
        sight.view = each.view;
        sight.z = each.z;
        sight.R = each.R;
        sight.point = each.z.x() * Vector2(std::cos(each.z.y()), std::sin(each.z.y()));
        sight.variance = each.R(0, 0) + each.z.x() * each.z.x() * each.R(1, 1);
        sight.clutter = std::exp(each.log_unexplained);
        sight.log_clutter = each.log_unexplained;
        // q <= exp(-NIS / 2) / (2 pi sqrt(det R)), and no term of less than prune_below is kept.
        sight.widest = 2 * (std::log(PhdSight::ordinary_weight * parameters.detection_probability /
                                      (2 * pi * parameters.prune_below)) -
                            sight.log_clutter) -
                       std::log(each.R.determinant());
        sight.first = firstSight(placeOf(Vector3::Zero(), scan.sensorOf(each)), each.z, each.R, transform);
        sight.birth = each.birth;
        sights.push_back(sight);
    }
}

}  // namespace slamot
