#include "slamot/core/objects/FieldOfView.h"

#include <algorithm>
#include <cmath>

namespace slamot {
namespace {

/// Probability that a normal variable lies within [low, high].
double within(double low, double high, double mean, double deviation) {
    // All but 2e-9, and as a rule.
    if (mean - low > 6 * deviation && high - mean > 6 * deviation) return 1;
    const double scale = std::sqrt(2.0) * std::max(deviation, 1e-12);
    return 0.5 * (std::erf((high - mean) / scale) - std::erf((low - mean) / scale));
}

}  // namespace

bool surelyInView(const RangeBearingSensor& sensor, const ExpectedDetection& expected) {
    if (!(sensor.max_range > 0)) return false;
    const Vector2 spread = 2.0 * expected.covariance.diagonal().cwiseSqrt();
    const bool near_enough = expected.z.x() + spread.x() <= sensor.max_range;
    const bool far_enough = sensor.min_range <= 0 || expected.z.x() - spread.x() >= sensor.min_range;
    const bool ahead =
        sensor.field_of_view >= 2 * pi || std::abs(expected.z.y()) + spread.y() <= 0.5 * sensor.field_of_view;
    return near_enough && far_enough && ahead;
}

double probabilityInView(const RangeBearingSensor& sensor, const ExpectedDetection& expected) {
    if (!(sensor.max_range > 0)) return 0;
    const Vector2 deviation = expected.covariance.diagonal().cwiseSqrt();
    // Without a limit below, ranges that the Gaussian puts below 0 are near ones.
    const double nearest = sensor.min_range > 0 ? sensor.min_range : -sensor.max_range;
    const double in_range = within(nearest, sensor.max_range, expected.z.x(), deviation.x());
    if (sensor.field_of_view >= 2 * pi) return in_range;
    // A bearing close behind may lie on the other side of +-pi.
    double ahead = 0;
    for (const double turns : {-1.0, 0.0, 1.0})
        ahead += within(-0.5 * sensor.field_of_view, 0.5 * sensor.field_of_view,
                        expected.z.y() + turns * 2 * pi, deviation.y());
    return in_range * std::min(ahead, 1.0);
}

bool reports(const RangeBearingSensor& sensor, ObjectKind kind) {
    return sensor.kind == ObjectKind::unknown || sensor.kind == kind;
}

}  // namespace slamot
