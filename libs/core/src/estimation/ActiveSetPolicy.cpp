#include "slamot/core/estimation/ActiveSetPolicy.h"

#include <algorithm>
#include <cmath>

namespace slamot {
namespace {

/// After a commit of the invariant core active state and base together have three times the active
/// dimensions.
constexpr int dividing_factor = 4;
/// Parts of the margins. When the first is used up, what was chosen before is activated; that is chosen a
/// step later at the earliest, and has to do until the first is used up once more: both make one.
constexpr double due_after = 0.45, plan_holds = 0.55;

}  // namespace

ParameterTable describe(ActiveSetParameters& p, const std::string& name) {
    ParameterTable table(name,
                         "What the compressed engine keeps within reach, and when it puts landmarks away.");
    table
        .optionalReal(
            "range", p.range, "m", Interval::positive(),
            "How far the sensors see landmarks; auto: their own limits, or the longest range one was met "
            "at. Sensors that see movers only do not count.")
        .real("activate_margin", p.activate_margin, "-", Interval::nonNegative(),
              "Landmarks are brought in up to (1 + this) ranges away, every half of this in travel.")
        .real("keep_margin", p.keep_margin, "-", Interval::nonNegative(),
              "They are kept up to (1 + this) ranges away; at least activate_margin is taken.")
        .real("view_margin_deg", p.view_margin, "deg", Interval::between(0, 180),
              "The same beyond the edges of a field of view below 360 deg; twice that for keeping.")
        .real("base_growth", p.base_growth, "-", Interval::atLeast(2.1),
              "Commit when the base has more than this times the active state's dimensions.")
        .real("retirable_part", p.retirable_part, "-", Interval::probability(),
              "Commit when this part of the active landmarks is out of reach.")
        .integer("keep_at_least", p.keep_at_least, Interval::nonNegative(),
                 "Active landmarks that are kept in any case, unless the base grows too large.");
    return table;
}

void ActiveSetPolicy::look(const Attention& attention) {
    for (const RangeBearingSensor& seen : attention.seen.sensors) {
        Sensor& sensor = of(seen);
        sensor.now = attention.robot * seen.pose;
    }
    for (const RangeBearingDetection& detection : attention.seen.detections) {
        if (detection.kind != ObjectKind::landmark) continue;
        const RangeBearingSensor& seen = attention.seen.sensorOf(detection);
        const double limit = parameters_.range.value_or(seen.max_range);
        const double range = limit > 0 ? limit : detection.range;
        Sensor& sensor = of(seen);
        if (range <= sensor.range) continue;
        sensor.range = range;
        sensor.at_refresh = sensor.at_plan = std::nullopt;
        range_ = std::max(range_, range);
    }
}

ActiveSetPolicy::Sensor& ActiveSetPolicy::of(const RangeBearingSensor& seen) {
    const auto same = [&seen](const Sensor& s) { return s.label == seen.label; };
    auto sensor = std::find_if(sensors_.begin(), sensors_.end(), same);
    if (sensor == sensors_.end())
        sensor = sensors_.insert(sensor, Sensor{seen.label, 0, seen.field_of_view, {}, {}, {}});
    return *sensor;
}

bool ActiveSetPolicy::used(double part, const Sensor& s, const std::optional<Pose2>& since) const {
    if (s.range == 0) return false;
    if (!since) return true;
    const double moved = (s.now.position() - since->position()).norm();
    const double turned = std::abs(angleDifference(s.now.theta, since->theta));
    return moved >= part * parameters_.activate_margin * s.range ||
           (s.field_of_view < 2 * pi && turned >= part * parameters_.view_margin);
}

bool ActiveSetPolicy::due() const {
    return std::any_of(sensors_.begin(), sensors_.end(),
                       [this](const Sensor& s) { return used(due_after, s, s.at_refresh); });
}

void ActiveSetPolicy::refreshed() {
    for (Sensor& sensor : sensors_) sensor.at_refresh = sensor.now;
}

bool ActiveSetPolicy::planHolds() const {
    return std::none_of(sensors_.begin(), sensors_.end(),
                        [this](const Sensor& s) { return used(plan_holds, s, s.at_plan); });
}

void ActiveSetPolicy::planned() {
    for (Sensor& sensor : sensors_) sensor.at_plan = sensor.now;
}

bool ActiveSetPolicy::within(const Vector2& landmark, double margin, double view_margins) const {
    return std::any_of(sensors_.begin(), sensors_.end(), [&](const Sensor& s) {
        const Vector2 to = landmark - s.now.position();
        const double distance = to.norm();
        if (s.range == 0 || distance > (1 + margin) * s.range) return false;
        // A sensor that moves by its margin sees what stood beside it from another side.
        if (s.field_of_view >= 2 * pi || distance <= margin * s.range) return true;
        const double aside = std::abs(angleDifference(std::atan2(to.y(), to.x()), s.now.theta));
        return aside <= 0.5 * s.field_of_view + view_margins * parameters_.view_margin;
    });
}

bool ActiveSetPolicy::worthCommit(int active_dimension, int active_landmarks, int retirable,
                                  int base_dimension) const {
    if (base_dimension > parameters_.base_growth * active_dimension) return true;
    if (active_landmarks <= parameters_.keep_at_least || retirable == 0 ||
        retirable < parameters_.retirable_part * active_landmarks)
        return false;
    // The base comes on top of what is kept: a map that is whole is divided only when both are fewer by far.
    return base_dimension > 0 || active_dimension > dividing_factor * (active_dimension - 2 * retirable);
}

}  // namespace slamot
