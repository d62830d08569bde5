#include "slamot/sim/Mover.h"

#include <algorithm>
#include <cmath>

#include "slamot/core/random/RandomStream.h"
#include "slamot/sim/PathFollower.h"

namespace slamot::sim {
namespace {

/// A mover between two steps.
struct Body {
    Vector6 x = Vector6::Zero();  ///< [p v a]
    double heading = 0;           ///< where it points, also when it stands still
    double speed = 0;             ///< unicycle: without jitter
    double turn_rate = 0;         ///< unicycle: without jitter
};

const char* modeName(TargetModelKind kind) {
    switch (kind) {
        case TargetModelKind::cv:
            return "cv";
        case TargetModelKind::ca:
            return "ca";
        case TargetModelKind::ct:
            return "ct";
        case TargetModelKind::unicycle:
            break;
    }
    return "unicycle";
}

/// The schedule of any mover that is not a waypoint mover.
std::vector<ScheduleEntry> scheduleOf(const MoverParameters& mover) {
    switch (mover.model) {
        case MoverModel::schedule:
            return mover.schedule;
        case MoverModel::ca:
            return {{0, TargetModelKind::ca, {}}};
        case MoverModel::ct:
            return {{0, TargetModelKind::ct, {}}};
        case MoverModel::unicycle:
            return {{0, TargetModelKind::unicycle, {}}};
        default:
            return {{0, TargetModelKind::cv, {}}};
    }
}

/// p += dt^2/2 a, v += dt a: a draw of acceleration held over the step.
void accelerate(Vector6& x, const Vector2& acceleration, double dt) {
    x.segment<2>(0) += 0.5 * dt * dt * acceleration;
    x.segment<2>(2) += dt * acceleration;
}

/// A draw of jerk held over the step.
void jerk(Vector6& x, const Vector2& jerk, double dt) {
    x.segment<2>(0) += dt * dt * dt / 6 * jerk;
    x.segment<2>(2) += 0.5 * dt * dt * jerk;
    x.segment<2>(4) += dt * jerk;
}

Vector2 normals(RandomStream& random, double deviation) {
    const double first = random.normal(0, deviation);
    return {first, random.normal(0, deviation)};
}

void unicycleStep(Body& body, const MoverParameters& mover, double dt, RandomStream& random) {
    const double acceleration = random.normal(0, mover.unicycle_acceleration_std);
    body.turn_rate += random.normal(0, mover.unicycle_turn_rate_std);
    const double w = body.turn_rate + random.normal(0, mover.unicycle_turn_rate_jitter);
    const double jitter = random.normal(0, mover.unicycle_speed_jitter);
    const double mean_speed = body.speed + 0.5 * acceleration * dt + jitter;
    body.speed += acceleration * dt;

    const auto along = [](double speed, double heading) {
        return Vector2(speed * std::cos(heading), speed * std::sin(heading));
    };
    Vector6 x = body.x;
    x.segment<2>(2) = along(mean_speed, body.heading);
    const Vector2 position = ctMotion(x, w, dt).head<2>();
    body.heading = wrapAngle(body.heading + w * dt);
    const Vector2 velocity = along(body.speed + jitter, body.heading);
    body.x << position, velocity, w * (quarterTurn() * velocity);
}

/// One step of `entry`'s model; `entered` when the mover has just come to it from another one.
void modelStep(Body& body, const MoverParameters& mover, const ScheduleEntry& entry, bool entered, double dt,
               RandomStream& random) {
    switch (entry.kind) {
        case TargetModelKind::cv:
            body.x = cvMotion(body.x, dt);
            accelerate(body.x, normals(random, mover.cv_acceleration_std), dt);
            break;
        case TargetModelKind::ca:
            body.x = caMotion(body.x, dt);
            jerk(body.x, normals(random, mover.ca_jerk_std), dt);
            break;
        case TargetModelKind::ct:
            body.x = ctMotion(body.x, entry.turn_rate.value_or(mover.ct_turn_rate), dt);
            accelerate(body.x, normals(random, mover.ct_acceleration_std), dt);
            break;
        case TargetModelKind::unicycle:
            if (entered) {
                body.speed = body.x.segment<2>(2).norm();
                body.turn_rate = entry.turn_rate.value_or(mover.unicycle_turn_rate);
            }
            unicycleStep(body, mover, dt, random);
            return;
    }
    if (body.x.segment<2>(2).norm() > 0) body.heading = std::atan2(body.x(3), body.x(2));
}

/// Turns towards the next waypoint, at a limited rate, then goes straight for a step; stands at the end.
void waypointStep(Body& body, const MoverParameters& mover, PathFollower& path, double dt) {
    const std::optional<Vector2> goal = path.next(body.x.head<2>());
    if (!goal) {
        body.x.tail<4>().setZero();
        return;
    }
    const Vector2 rel = *goal - body.x.head<2>();
    const double wanted = angleDifference(std::atan2(rel.y(), rel.x()), body.heading);
    const double limit = mover.max_turn_rate * dt, turn = std::clamp(wanted, -limit, limit);
    body.heading = wrapAngle(body.heading + turn);
    const Vector2 velocity = mover.speed * Vector2(std::cos(body.heading), std::sin(body.heading));
    body.x.head<2>() += dt * velocity;
    body.x.segment<2>(2) = velocity;
    body.x.tail<2>() = turn / dt * (quarterTurn() * velocity);
}

Body startOf(const MoverParameters& mover, RandomStream random) {
    // All numbers are drawn whether used or not, so that giving one leaves the others as they were.
    const double x = random.uniform(mover.start_box.x_min, mover.start_box.x_max);
    const double y = random.uniform(mover.start_box.y_min, mover.start_box.y_max);
    const double speed = random.uniform(mover.min_speed, mover.max_speed);
    const double direction = random.uniform(-pi, pi);

    Body body;
    const Vector2 position = mover.position.value_or(Vector2(x, y));
    Vector2 velocity =
        mover.velocity.value_or(Vector2(speed * std::cos(direction), speed * std::sin(direction)));
    if (mover.model == MoverModel::waypoint && !mover.velocity) {
        const Vector2 rel = mover.path.front() - position;
        if (rel.norm() > 0) velocity = mover.speed * rel.normalized();
    }
    body.x << position, velocity, mover.acceleration;
    body.heading = std::atan2(velocity.y(), velocity.x());
    return body;
}

TrueTarget toTruth(const Body& body, Stamp stamp, const std::string& mode) {
    return {stamp, body.x.segment<2>(0), body.x.segment<2>(2), body.x.segment<2>(4), mode};
}

/// Index of the entry in force at `stamp`: the last whose time has come.
std::size_t inForce(const std::vector<ScheduleEntry>& schedule, Stamp stamp) {
    std::size_t i = 0;
    while (i + 1 < schedule.size() && later(epoch, schedule[i + 1].time) <= stamp) ++i;
    return i;
}

/// One draw; nothing when it leaves the arena.
std::optional<Trajectory> draw(const Scenario& scenario, const MoverParameters& mover, std::uint64_t seed,
                               int redraw) {
    const auto streamOf = [&](int step) {
        return RandomStream(seed, RandomPurpose::mover, static_cast<std::uint32_t>(mover.id.value),
                            static_cast<std::uint32_t>(step), static_cast<std::uint32_t>(redraw));
    };
    const std::vector<ScheduleEntry> schedule = scheduleOf(mover);
    Trajectory trajectory{mover.id, 0, {}};
    while (scenario.stampOfStep(trajectory.first_step) < later(epoch, mover.appear)) ++trajectory.first_step;
    const auto gone = [&](int step) {
        return std::isfinite(mover.vanish) && scenario.stampOfStep(step) >= later(epoch, mover.vanish);
    };

    Body body = startOf(mover, streamOf(0));
    PathFollower path(mover.path, body.x.head<2>(), mover.loops, mover.reach_distance);
    std::optional<std::size_t> previous;
    for (int step = trajectory.first_step; step <= scenario.steps && !gone(step); ++step) {
        const bool first = step == trajectory.first_step;
        // The model in force at the start of a step moves the mover through it.
        const std::size_t entry = inForce(schedule, scenario.stampOfStep(first ? step : step - 1));
        if (!first && mover.model == MoverModel::waypoint) {
            waypointStep(body, mover, path, scenario.secondsOfStep(step));
        } else if (!first) {
            RandomStream random = streamOf(step);
            modelStep(body, mover, schedule[entry], previous != entry, scenario.secondsOfStep(step), random);
            previous = entry;
        }
        if (mover.arena && !mover.arena->contains(body.x.head<2>())) return std::nullopt;
        trajectory.states.push_back(
            toTruth(body, scenario.stampOfStep(step),
                    mover.model == MoverModel::waypoint ? "waypoint" : modeName(schedule[entry].kind)));
    }
    return trajectory;
}

}  // namespace

Trajectory simulateMover(const Scenario& scenario, const MoverParameters& mover, std::uint64_t seed) {
    for (int redraw = 0; redraw <= mover.max_redraws; ++redraw) {
        if (std::optional<Trajectory> trajectory = draw(scenario, mover, seed, redraw)) return *trajectory;
    }
    throw ConfigError("[mover." + std::to_string(mover.id.value) + "] left its arena in each of " +
                      std::to_string(mover.max_redraws + 1) +
                      " draws: use a larger arena, less noise, or more max_redraws");
}

}  // namespace slamot::sim
