#include "slamot/sim/Sensor.h"

#include <algorithm>
#include <cmath>

#include "slamot/core/models/RangeBearing.h"
#include "slamot/core/random/Clutter.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot::sim {
namespace {

/// FNV-1a: a sensor's draws depend on its own label only, not on which other sensors there are.
std::uint64_t hashOf(const std::string& label) {
    std::uint64_t hash = 0xcbf29ce484222325ull;
    for (const char c : label) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    return hash;
}

/// An object's place in the random keys: landmarks, movers and robots never share one.
std::uint32_t keyOf(bool is_mover, SourceId id) {
    const auto low = static_cast<std::uint32_t>(id.value) & 0x7fffffffu;
    return is_mover ? low | 0x80000000u : low;
}

/// The field of view as half a width; a full circle has no rim, so that rounding at +-pi excludes nothing.
bool inView(const SensorParameters& sensor, const Vector2& z) {
    const bool full_circle = sensor.field_of_view >= 2 * pi;
    return z.x() >= sensor.min_range && z.x() <= sensor.max_range &&
           (full_circle || std::abs(z.y()) <= 0.5 * sensor.field_of_view);
}

}  // namespace

Scan scan(const Scenario& scenario, const SensorParameters& sensor, int robot, int step, const Pose2& pose,
          const World& world, const std::vector<Trajectory>& movers, std::uint64_t seed) {
    const Pose2 mounting{sensor.position.x(), sensor.position.y(), sensor.orientation};
    Scan result;
    result.reading.sensor = {sensor.label, mounting, sensor.min_range, sensor.max_range,
                             sensor.field_of_view};
    // Most landmarks of a large world are far away: left out without an arctangent, with a margin for
    // rounding.
    const Vector2 eye = (pose * mounting).position();
    const double beyond = 1.001 * sensor.max_range;
    const std::uint64_t sensor_seed = derivedSeed(seed, hashOf(sensor.label));
    const auto stream = [&](RandomPurpose purpose, std::uint32_t object) {
        return RandomStream(sensor_seed, purpose, static_cast<std::uint32_t>(robot),
                            static_cast<std::uint32_t>(step), object);
    };
    Matrix2 claim = Matrix2::Zero();
    claim.diagonal() << sensor.range_std * sensor.range_std, sensor.bearing_std * sensor.bearing_std;

    struct Detected {
        RangeBearingReading::Item item;
        TrueAssociation origin;
    };
    std::vector<Detected> detected;
    const Stamp stamp = scenario.stampOfStep(step);
    const auto add = [&](const Vector2& z, const char* kind, SourceId id) {
        const SourceId written = sensor.writesIdentities() ? id : SourceId{};
        detected.push_back({{z.x(), z.y(), written, claim}, {stamp, 0, kind, id}});
    };
    const auto look = [&](const Vector2& point, bool is_mover, SourceId id) {
        const char* kind = is_mover ? "mover" : "landmark";
        if ((point - eye).squaredNorm() > beyond * beyond) return;
        const Vector2 z = rangeBearing<double>(pose.vector(), point, mounting);
        if (!inView(sensor, z)) return;
        const std::uint32_t object = keyOf(is_mover, id);
        if (stream(RandomPurpose::detection, object).uniform() >= sensor.detection_probability) return;
        RandomStream noise = stream(RandomPurpose::range_bearing, object);
        if (noise.uniform() < sensor.outlier_probability)
            return add(anywhereInView(result.reading.sensor, noise), kind, id);
        // A range has no sign: what noise takes below zero comes back as its absolute value.
        const double range =
            std::abs(z.x() + noise.normal(0, sensor.true_range_std.value_or(sensor.range_std)));
        const double bearing_noise = noise.normal(0, sensor.true_bearing_std.value_or(sensor.bearing_std));
        add({range, wrapAngle(z.y() + bearing_noise)}, kind, id);
    };

    if (sensor.role != SensorRole::movers) {
        for (const auto& [id, point] : world.landmarks) look(point, false, id);
    }
    if (sensor.role != SensorRole::landmarks) {
        for (const Trajectory& mover : movers) {
            const TrueTarget* state = mover.at(step);
            if (state && mover.id.value != robot_id_base + robot) look(state->position, true, mover.id);
        }
    }
    RandomStream clutter = stream(RandomPurpose::clutter, 0);
    for (const Vector2& z : drawClutter(result.reading.sensor, sensor.clutter_per_scan, clutter))
        add(z, "clutter", SourceId{});

    std::stable_sort(detected.begin(), detected.end(),
                     [](const Detected& a, const Detected& b) { return a.item.bearing < b.item.bearing; });
    result.reading.stamp = stamp;
    result.range_std = sensor.range_std;
    result.bearing_std = sensor.bearing_std;
    for (Detected& d : detected) {
        d.origin.index = static_cast<int>(result.origins.size());
        result.reading.items.push_back(d.item);
        result.origins.push_back(d.origin);
    }
    return result;
}

}  // namespace slamot::sim
