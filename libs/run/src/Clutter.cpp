#include "slamot/run/Clutter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "slamot/core/config/Config.h"
#include "slamot/core/random/Clutter.h"

namespace slamot::run {

Clutter::Clutter(const ClutterParameters& parameters, std::uint64_t run_seed, ClutterCounts& counts)
    : per_scan_(parameters.per_scan),
      detection_probability_(parameters.detection_probability),
      seed_(parameters.seed.value_or(run_seed)),
      counts_(counts) {}

bool Clutter::keeps(const HeldReading& held, std::size_t item) {
    if (detection_probability_ >= 1) return true;
    RandomStream random(seed_, RandomPurpose::withheld_detection, 0, held.observation,
                        static_cast<std::uint32_t>(item));
    const bool kept = random.uniform() < detection_probability_;
    counts_.withheld += !kept;
    return kept;
}

std::vector<RangeBearingReading::Item> Clutter::falseDetections(const HeldReading& held) {
    if (!adds()) return {};
    const RangeBearingReading& reading = held.reading;
    if (!(reading.sensor.max_range > reading.sensor.min_range))
        throw ConfigError(
            fmt::format("sensor '{}' has no largest range at t = {}, so there is no saying where its false "
                        "detections would lie, expected [clutter] per_scan = 0 for this log",
                        reading.sensor.label, slamot::toText(reading.stamp)));
    const auto claimAt = [&](double range) {
        const auto distance = [range](const RangeBearingReading::Item& item) {
            const double d = std::abs(item.range - range);
            return std::isfinite(d) ? d : std::numeric_limits<double>::infinity();
        };
        const auto nearest =
            std::min_element(reading.items.begin(), reading.items.end(),
                             [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
        return nearest == reading.items.end() ? held.claim : nearest->covariance;
    };
    RandomStream random(seed_, RandomPurpose::added_clutter, 0, held.observation);
    std::vector<RangeBearingReading::Item> items;
    for (const Vector2& z : drawClutter(reading.sensor, per_scan_, random))
        items.push_back({z.x(), z.y(), SourceId{}, claimAt(z.x())});
    counts_.added += static_cast<std::int64_t>(items.size());
    return items;
}

}  // namespace slamot::run
