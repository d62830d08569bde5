#include "slamot/run/DetectionBuilder.h"

#include <fmt/format.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

#include "slamot/core/data/Angle.h"

namespace slamot::run {
namespace {

const char* whyUnusable(const RangeBearingReading::Item& item) {
    if (!std::isfinite(item.range) || !std::isfinite(item.bearing)) return "not-finite";
    if (item.range <= 0) return "range-not-positive";
    return nullptr;
}

ObjectKind kindOf(SensorRole role) {
    if (role == SensorRole::landmarks) return ObjectKind::landmark;
    return role == SensorRole::movers ? ObjectKind::mover : ObjectKind::unknown;
}

struct NumberedItem {
    RangeBearingReading::Item item;
    int log_number;
};

}  // namespace

DetectionBuilder::DetectionBuilder(const RunConfig& config, DropTable& drops, ClutterCounts& counts)
    : config_(config), drops_(drops), clutter_(config.clutter, config.seed, counts) {}

void DetectionBuilder::append(const HeldReading& held, RangeBearingSet& set, std::vector<int>& log_numbers) {
    const RangeBearingReading& reading = held.reading;
    std::vector<NumberedItem> items;
    for (std::size_t i = 0; i < reading.items.size(); ++i) {
        if (const char* reason = whyUnusable(reading.items[i]))
            drops_.add(reading.sensor.label, reason);
        else if (clutter_.keeps(held, i))
            items.push_back({reading.items[i], held.first_number + static_cast<int>(i)});
    }
    for (const RangeBearingReading::Item& item : clutter_.falseDetections(held)) items.push_back({item, -1});
    for (NumberedItem& numbered : items) numbered.item.bearing = wrapAngle(numbered.item.bearing);
    // False ones among the others: the order must not tell an estimator which is which.
    if (clutter_.adds())
        std::stable_sort(items.begin(), items.end(),
                         [](const auto& a, const auto& b) { return a.item.bearing < b.item.bearing; });

    const ObjectKind kind = kindOf(*config_.sensors.of(reading.sensor.label));
    const Identities shown =
        kind == ObjectKind::mover ? config_.mover_identities : config_.landmark_identities;
    const int sensor = static_cast<int>(set.sensors.size());
    set.sensors.push_back(reading.sensor);
    set.sensors.back().kind = kind;
    for (const auto& [item, log_number] : items) {
        RangeBearingDetection detection;
        detection.range = item.range;
        detection.bearing = item.bearing;
        detection.covariance = noiseOf(reading, item);
        detection.kind = kind;
        if (shown == Identities::log && kind != ObjectKind::unknown) detection.source = item.id;
        detection.sensor = sensor;
        set.detections.push_back(detection);
        log_numbers.push_back(log_number);
    }
}

Matrix2 DetectionBuilder::noiseOf(const RangeBearingReading& reading,
                                  const RangeBearingReading::Item& item) const {
    NoiseOverride noise = config_.noise;
    if (const auto found = config_.noise_by_label.find(reading.sensor.label);
        found != config_.noise_by_label.end()) {
        if (found->second.range_std) noise.range_std = found->second.range_std;
        if (found->second.range_std_per_m) noise.range_std_per_m = found->second.range_std_per_m;
        if (found->second.bearing_std) noise.bearing_std = found->second.bearing_std;
    }
    Matrix2 covariance = item.covariance;
    const auto replace = [&covariance](int i, double deviation) {
        covariance(0, 1) = covariance(1, 0) = 0;
        covariance(i, i) = deviation * deviation;
    };
    if (noise.range_std || noise.range_std_per_m)
        replace(0, noise.range_std.value_or(std::sqrt(covariance(0, 0))) +
                       noise.range_std_per_m.value_or(0) * item.range);
    if (noise.bearing_std) replace(1, *noise.bearing_std);
    if (!(covariance(0, 0) > 0 && covariance(1, 1) > 0 && covariance.determinant() > 0))
        throw ConfigError(
            fmt::format("sensor '{}' claims no usable noise at t = {}: set range_std and bearing_std_deg "
                        "in [noise{}] of the config",
                        reading.sensor.label, slamot::toText(reading.stamp),
                        reading.sensor.label.empty() ? "" : "." + reading.sensor.label));
    return covariance;
}

}  // namespace slamot::run
