// Clutter alone, and objects in it, over seeded scans: what the probabilities promise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "slamot/core/models/RangeBearing.h"
#include "slamot/core/objects/TentativeObjects.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot {
namespace tentative_objects_in_clutter_test {

constexpr double dt = 0.1, clutter = 10;
const TargetModel model{TargetModelKind::cv, 0.5, 0.1};

RangeBearingSensor allRound(ObjectKind kind) {
    RangeBearingSensor sensor;
    sensor.max_range = 30;
    sensor.kind = kind;
    return sensor;
}

RangeBearingDetection detectionOf(const Vector2& z, const Vector2& noise, ObjectKind kind) {
    RangeBearingDetection detection;
    detection.range = z.x();
    detection.bearing = wrapAngle(z.y());
    detection.covariance = noise.cwiseAbs2().asDiagonal();
    detection.kind = kind;
    return detection;
}

TentativeParameters parametersFor(double confirm_probability) {
    TentativeParameters p;
    for (LifeParameters* life : {&p.landmarks, &p.movers}) {
        life->clutter_per_scan = clutter;
        life->confirm_probability = confirm_probability;
    }
    return p;
}

/// A robot that looks around ten times a second, at rest or driving.
struct Looks {
    Looks(std::uint64_t seed, ObjectKind of_kind, const TentativeParameters& parameters, const Pose2& by,
          double noise_factor)
        : kind(of_kind),
          move(by),
          noise(noise_factor * Vector2(0.1, radians(1.0))),
          random(seed, RandomPurpose::test),
          tentative(parameters) {}

    /// One scan of what is there, each detected with P_D 0.9, and of clutter.
    std::vector<ConfirmedObject> look(const std::vector<Vector2>& objects) {
        ++scans;
        tentative.predict({{move, Vector3(1e-6, 1e-6, 1e-6).asDiagonal()}, dt}, model);
        robot = robot * move;
        RangeBearingSet seen;
        seen.sensors = {allRound(kind)};
        source.clear();
        const auto add = [&](const Vector2& z, int from) {
            seen.detections.push_back(detectionOf(z, noise, kind));
            source.push_back(from);
        };
        for (std::size_t o = 0; o < objects.size(); ++o) {
            const Vector2 z = rangeBearing<double>(robot.vector(), objects[o], {});
            if (random.uniform() < 0.9)
                add(z + Vector2(random.normal(0, noise.x()), random.normal(0, noise.y())),
                    static_cast<int>(o));
        }
        for (int n = random.poisson(clutter); n > 0; --n)
            add({random.uniform(0, 30), random.uniform(-pi, pi)}, -1);
        std::vector<int> all;
        for (int d = 0; d < static_cast<int>(source.size()); ++d) all.push_back(d);
        largest = std::max(largest, tentative.size());
        return tentative.update(seen, Stamp::fromSeconds(scans * dt), all,
                                std::vector<bool>(all.size(), true), Consistency::invariant);
    }

    ObjectKind kind;
    Pose2 move, robot;
    Vector2 noise;  ///< standard deviations
    RandomStream random;
    TentativeObjects tentative;
    int scans = 0, largest = 0;
    std::vector<int> source;  ///< of the last look's detections: an object, or -1
};

constexpr ObjectKind kinds[] = {ObjectKind::landmark, ObjectKind::mover, ObjectKind::unknown};

TEST(TentativeObjectsInClutterTest, ClutterAloneConfirmsNoMoreThanTheOddsAllow) {
    // The odds of existence start at new : clutter = 1 : 100. Under clutter the ratio of each look has mean 1
    // at most, so the probability that they ever reach odds w is 1 / (100 w) at most (Ville's inequality),
    // for each of the at most 10,000 objects that 1,000 scans start. Bounds: the mean and three standard
    // deviations of a Poisson number; one choice of seeds in several hundred would pass them if the mean were
    // reached.
    for (const double noise : {1.0, 5.0})
        for (const double confirm_probability : {0.5, 0.9, 0.99})
            for (const ObjectKind kind : kinds)
                for (const double speed : {0.0, 2.0}) {
                    Looks looks(3, kind, parametersFor(confirm_probability), {speed * dt, 0, 0}, noise);
                    int confirmed = 0, points = 0;
                    for (int scan = 0; scan < 1000; ++scan) {
                        confirmed += static_cast<int>(looks.look({}).size());
                        points += static_cast<int>(looks.source.size());
                    }
                    const double odds = confirm_probability / (1 - confirm_probability);
                    const double mean = 0.01 / odds * points;
                    EXPECT_LE(confirmed, mean + 3 * std::sqrt(mean))
                        << toText(kind) << ", confirmed at " << confirm_probability << ", " << speed
                        << " m/s";
                    // Ten new ones a scan, each let go after about five: no flood.
                    EXPECT_LT(looks.largest, 150) << toText(kind);
                }
}

/// Scans until each of 200 objects is confirmed, in clutter; 1000: not within 30.
std::vector<int> scansUntilConfirmed(ObjectKind kind) {
    std::vector<int> out;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Looks looks(100 + seed, kind, parametersFor(0.99), {0.05, 0, 0}, 1);
        for (int scan = 0; scan < 30; ++scan) looks.look({});
        std::vector<Vector2> objects;
        for (int o = 0; o < 10; ++o) {
            const double range = looks.random.uniform(4, 24), bearing = looks.random.uniform(-pi, pi);
            objects.push_back(looks.robot.position() + range * Vector2(std::cos(bearing), std::sin(bearing)));
        }
        std::vector<int> when(objects.size(), 1000);
        for (int scan = 1; scan <= 30; ++scan)
            for (const ConfirmedObject& confirmed : looks.look(objects)) {
                const int o = looks.source[static_cast<std::size_t>(confirmed.detection)];
                if (o >= 0)
                    when[static_cast<std::size_t>(o)] = std::min(when[static_cast<std::size_t>(o)], scan);
            }
        out.insert(out.end(), when.begin(), when.end());
    }
    std::sort(out.begin(), out.end());
    return out;
}

TEST(TentativeObjectsInClutterTest, ObjectsAreConfirmedWithinAFewScans) {
    // Odds of 1 : 100 rise by P_D N / c, 760 exp(-NIS / 2) here, at each detection after the first: two of
    // them reach 99 : 1 unless they are outliers. Three detections within four scans: 95 % at P_D 0.9. Movers
    // are known less well; of what may be either the motion has to show.
    const int ninety_percent[] = {5, 8, 10};
    for (const ObjectKind kind : kinds) {
        const std::vector<int> scans = scansUntilConfirmed(kind);
        EXPECT_LE(scans[180], ninety_percent[static_cast<int>(kind)]) << toText(kind);
        EXPECT_LE(scans.back(), 20) << toText(kind);
        EXPECT_GE(scans.front(), 2) << toText(kind);
    }
}

}  // namespace tentative_objects_in_clutter_test
}  // namespace slamot
