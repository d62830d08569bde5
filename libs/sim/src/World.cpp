#include "slamot/sim/World.h"

#include <cmath>

#include "slamot/core/random/RandomStream.h"
#include "slamot/rawlog/CsvTable.h"

namespace slamot::sim {
namespace {

/// A point of a closed line and the unit normal that points to its left.
struct LinePoint {
    Vector2 point, left;
};

/// The loop's centre line at arc length s: counter-clockwise from the origin, at first along +x.
LinePoint centreLine(const WorldParameters& p, double s) {
    if (p.shape == LoopShape::circle) {
        const double radius = p.length / (2 * pi), angle = s / radius;
        const Vector2 outward(std::sin(angle), -std::cos(angle));
        return {Vector2(0, radius) + radius * outward, -outward};
    }
    // A square whose first side has the origin in its middle.
    const double side = p.length / 4;
    const double from_corner = std::fmod(s + side / 2, p.length);
    const int edge = std::min(3, static_cast<int>(from_corner / side));
    const Vector2 corners[4] = {{-side / 2, 0}, {side / 2, 0}, {side / 2, side}, {-side / 2, side}};
    const Vector2 directions[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    return {corners[edge] + (from_corner - edge * side) * directions[edge], quarterTurn() * directions[edge]};
}

World uniformWorld(const WorldParameters& p, std::uint64_t seed) {
    constexpr int max_draws = 10000;
    World world;
    for (int i = 0; i < p.landmarks; ++i) {
        RandomStream random(seed, RandomPurpose::world, 0, 0, static_cast<std::uint32_t>(i));
        const auto draw = [&] {
            const double x = random.uniform(p.box.x_min, p.box.x_max);
            return Vector2(x, random.uniform(p.box.y_min, p.box.y_max));
        };
        const auto crowded = [&](const Vector2& candidate) {
            for (const auto& [id, other] : world.landmarks) {
                if ((candidate - other).norm() < p.min_distance) return true;
            }
            return false;
        };
        Vector2 landmark = draw();
        for (int draws = 1; p.min_distance > 0 && crowded(landmark); ++draws) {
            if (draws == max_draws) {
                throw ConfigError("[world] has no room for landmark " + std::to_string(i) +
                                  " at min_distance = " + shortestText(p.min_distance) +
                                  " m from the others: use a larger box, fewer " +
                                  "landmarks or a smaller min_distance");
            }
            landmark = draw();
        }
        world.landmarks[SourceId{i}] = landmark;
    }
    return world;
}

World loopWorld(const WorldParameters& p, std::uint64_t seed) {
    World world;
    // Landmarks in pairs, one each side, evenly along the line.
    const int pairs = (p.landmarks + 1) / 2;
    for (int i = 0; i < p.landmarks; ++i) {
        RandomStream random(seed, RandomPurpose::world, 0, 0, static_cast<std::uint32_t>(i));
        const double along = (i / 2 + 0.5) * p.length / pairs + random.uniform(-p.side_jitter, p.side_jitter);
        const double across =
            (i % 2 == 0 ? 1 : -1) * p.side_offset + random.uniform(-p.side_jitter, p.side_jitter);
        const LinePoint at = centreLine(p, std::fmod(along + p.length, p.length));
        world.landmarks[SourceId{i}] = at.point + across * at.left;
    }
    // A multiple of eight, so that a square's corners are among them.
    const int points = 8 * static_cast<int>(std::ceil(p.length / 16));
    for (int i = 1; i <= points; ++i) {
        world.centre_line.push_back(centreLine(p, std::fmod(i * p.length / points, p.length)).point);
    }
    return world;
}

World fileWorld(const WorldParameters& p) {
    CsvReader table(p.file);
    const int id = table.column("id"), x = table.column("x"), y = table.column("y");
    World world;
    for (int row = 0; table.next(); ++row) {
        if (row % p.file_every != 0) continue;
        const SourceId landmark{table.integer(id)};
        const Vector2 position(table.number(x), table.number(y));
        if (!landmark.valid()) table.fail(id, "an id of 0 or more");
        if (!std::isfinite(position.x())) table.fail(x, "a finite number");
        if (!std::isfinite(position.y())) table.fail(y, "a finite number");
        if (!world.landmarks.emplace(landmark, position).second)
            table.fail(id, "an id that is not there already");
    }
    return world;
}

}  // namespace

World makeWorld(const WorldParameters& parameters, std::uint64_t seed) {
    switch (parameters.kind) {
        case WorldKind::loop:
            return loopWorld(parameters, seed);
        case WorldKind::file:
            return fileWorld(parameters);
        case WorldKind::uniform:
            break;
    }
    return uniformWorld(parameters, seed);
}

}  // namespace slamot::sim
