#include "slamot/core/particles/StandingSensor.h"

#include <algorithm>
#include <cmath>

#include "slamot/core/objects/FieldOfView.h"

namespace slamot {
namespace {

/// Standard deviations by which limits are soft.
constexpr double range_rim = 0.3, bearing_rim = 0.04;  // [m], [rad]
/// Where limits are looked at, in standard deviations: what lies farther beyond is not seen.
constexpr double widest = 4;

}  // namespace

StandingSensor::StandingSensor(const PoseBelief& pose, const ScanView& view) : view_(view) {
    const double direction = pose.mean.z() + view.sensor.pose.theta;
    axis_ = {std::cos(direction), std::sin(direction)};
    const Vector2 lever = rotation(pose.mean.z()) * view.sensor.pose.position();
    position_ = pose.mean.head<2>() + lever;
    heading_factor_ = pose.factor.row(2);
    position_factor_ = pose.factor.topRows<2>() + quarterTurn() * lever * heading_factor_;
    half_view_ = 0.5 * view.sensor.field_of_view + widest * bearing_rim;
    cos_half_view_ = half_view_ < pi ? std::cos(half_view_) : -1;
    cos_half_limit_ = view.sensor.field_of_view < 2 * pi ? std::cos(0.5 * view.sensor.field_of_view) : -1;
}

double StandingSensor::reach() const {
    return view_.reach + widest * range_rim;
}

bool StandingSensor::mayShow(const GaussianPoint& point) const {
    const Vector2 rel = point.mean - position_;
    const double spread = widest * std::sqrt(point.covariance.trace()), squared = rel.squaredNorm();
    const double reach = this->reach() + spread;
    if (squared > reach * reach) return false;
    if (cos_half_view_ <= -1) return true;
    // The disc of radius `spread` about the point may reach into the cone of view.
    return axis_.dot(rel) + spread >= cos_half_view_ * std::sqrt(squared);
}

PointSight StandingSensor::sightOf(const GaussianPoint& point) const {
    const Vector2 rel = point.mean - position_;
    const double range = rel.norm(), r = std::max(range, range_floor);
    const Vector2 along = range > 0 ? Vector2(rel / range) : axis_, across(-along.y(), along.x());
    PointSight sight;
    sight.z = {range, std::atan2(axis_.dot(across) * -1, axis_.dot(along))};
    Matrix2 H;
    H << along.transpose(), across.transpose() / r;
    sight.A = -H * position_factor_;
    sight.A.row(1) -= heading_factor_;
    sight.cross = point.covariance * H.transpose();
    sight.covariance = sight.A * sight.A.transpose() + H * sight.cross;
    return sight;
}

bool StandingSensor::covers(const Vector2& point) const {
    const Vector2 rel = point - position_;
    const double squared = rel.squaredNorm(), nearest = view_.sensor.min_range,
                 farthest = view_.sensor.max_range;
    if (squared > farthest * farthest || squared < nearest * nearest) return false;
    return cos_half_limit_ <= -1 || axis_.dot(rel) >= cos_half_limit_ * std::sqrt(squared);
}

Vector2 StandingSensor::pointOf(const Vector2& z) const {
    const double c = std::cos(z.y()), s = std::sin(z.y());
    return position_ + z.x() * Vector2(c * axis_.x() - s * axis_.y(), c * axis_.y() + s * axis_.x());
}

double StandingSensor::inView(const PointSight& sight) const {
    const RangeBearingSensor& sensor = view_.sensor;
    Matrix2 spread = sight.covariance;
    spread(0, 0) += range_rim * range_rim;
    spread(1, 1) += bearing_rim * bearing_rim;
    const double range = widest * std::sqrt(spread(0, 0)), bearing = widest * std::sqrt(spread(1, 1));
    const bool well_inside =
        sight.z.x() + range <= sensor.max_range &&
        (sensor.min_range <= 0 || sight.z.x() - range >= sensor.min_range) &&
        (sensor.field_of_view >= 2 * pi || std::abs(sight.z.y()) + bearing <= 0.5 * sensor.field_of_view);
    if (well_inside) return 1;
    return probabilityInView(sensor, {sight.z, spread});
}

}  // namespace slamot
