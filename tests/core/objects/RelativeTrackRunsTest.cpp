// Seeded runs of a robot with noisy odometry and a sensor: are tracks consistent, and what do they say of
// motion.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/models/RangeBearing.h"
#include "slamot/core/objects/RelativeTrack.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot {
namespace relative_track_runs_test {

constexpr double dt = 0.2, range_std = 0.1, bearing_std = radians(1.0);
const TargetModel model{TargetModelKind::cv, 0.5, 0.1};

/// A robot that drives a circle of 7.5 m, 0.3 m and 0.04 rad a step.
struct Drive {
    explicit Drive(std::uint64_t seed) : random(seed, RandomPurpose::test) {}

    RangeBearingDetection see(const Vector2& object) {
        const Vector2 z = rangeBearing<double>(robot.vector(), object, sensor);
        RangeBearingDetection detection;
        detection.range = z.x() + random.normal(0, range_std);
        detection.bearing = wrapAngle(z.y() + random.normal(0, bearing_std));
        detection.covariance = Vector2(range_std * range_std, bearing_std * bearing_std).asDiagonal();
        return detection;
    }

    /// Moves, and says what odometry makes of it.
    RelativeStep step() {
        const PoseGaussian told{{0.3, 0.006, 0.04}, Vector3(2.5e-4, 1e-4, 1e-4).asDiagonal()};
        Vector3 moved = told.mean.vector();
        for (int i = 0; i < 3; ++i) moved(i) += random.normal(0, std::sqrt(told.covariance(i, i)));
        robot = robot * Pose2::fromVector(moved);
        return {told, dt};
    }

    RandomStream random;
    Pose2 robot;
    const Pose2 sensor{0.3, 0.1, 0.2};
};

TEST(RelativeTrackRunsTest, InnovationsOfAStillObjectAreAsLargeAsTheyShouldBe) {
    constexpr int runs = 40, scans = 100;
    const Vector2 object(12, 5);
    double nis = 0;
    for (int seed = 0; seed < runs; ++seed) {
        Drive drive(static_cast<std::uint64_t>(seed));
        RelativeTrack track =
            RelativeTrack::still(firstSight(drive.see(object), drive.sensor, Consistency::invariant));
        for (int scan = 0; scan < scans; ++scan) {
            track.predict(drive.step(), model, {});
            const RangeBearingDetection detection = drive.see(object);
            nis += track.match(detection, drive.sensor).nis;
            track.update(detection, drive.sensor);
        }
    }
    // 99.9 %: of a thousand other choices of seeds one would fail.
    EXPECT_GT(nis, chiSquareQuantile(0.0005, 2.0 * runs * scans));
    EXPECT_LT(nis, chiSquareQuantile(0.9995, 2.0 * runs * scans));
}

TEST(RelativeTrackRunsTest, AKnownMoverIsFollowedConsistently) {
    constexpr int runs = 40, scans = 100;
    double nis = 0;
    for (int seed = 0; seed < runs; ++seed) {
        Drive drive(100 + static_cast<std::uint64_t>(seed));
        // Of the model's own kind: white acceleration of density 0.5^2 * 0.1, and a velocity of its prior.
        Vector6 object = (Vector6() << 14, 5, 0, 0, 0, 0).finished();
        for (int i = 2; i < 4; ++i) object(i) = drive.random.normal(0, 0.3);
        RelativeTrack track = RelativeTrack::moving(
            firstSight(drive.see(object.head<2>()), drive.sensor, Consistency::invariant), 0.3, 0);
        for (int scan = 0; scan < scans; ++scan) {
            const double q = 0.5 * 0.5 * 0.1;
            for (int i = 0; i < 2; ++i) {
                // Position and velocity noise of covariance q [dt^3/3 dt^2/2; dt^2/2 dt].
                const double a = drive.random.normal(0, std::sqrt(q * dt)),
                             b = drive.random.normal(0, std::sqrt(q * dt / 12));
                object(i) += dt * object(2 + i) + dt * (0.5 * a + b);
                object(2 + i) += a;
            }
            track.predict(drive.step(), model, {});
            const RangeBearingDetection detection = drive.see(object.head<2>());
            nis += track.match(detection, drive.sensor).nis;
            track.update(detection, drive.sensor);
        }
    }
    EXPECT_GT(nis, chiSquareQuantile(0.0005, 2.0 * runs * scans));
    EXPECT_LT(nis, chiSquareQuantile(0.9995, 2.0 * runs * scans));
}

/// An object of unknown kind, 10 m away at first, and P(moving) by scan; `velocity` [m/s] by scan.
template <class Velocity>
std::vector<double> movingProbabilities(Drive& drive, int scans, const Velocity& velocity) {
    Vector2 object(8, 6);
    RelativeTrack track =
        RelativeTrack::unknown(firstSight(drive.see(object), drive.sensor, Consistency::invariant), {});
    std::vector<double> p;
    for (int scan = 1; scan <= scans; ++scan) {
        object += dt * velocity(scan);
        track.predict(drive.step(), model, {});
        track.update(drive.see(object), drive.sensor);
        p.push_back(track.movingProbability());
    }
    return p;
}

/// Of 100 objects that move by 1 m/s in scans (from, until], in how many P(moving) is above 0.9 or below 0.1
/// at the last scan.
struct Verdicts {
    int moving = 0, still = 0;
};
Verdicts verdictsAfter(int scans, int from, int until) {
    Verdicts out;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        Drive drive(1000 + seed);
        const double course = drive.random.uniform(-pi, pi);
        const double p = movingProbabilities(drive, scans, [&](int scan) -> Vector2 {
                             if (scan <= from || scan > until) return Vector2::Zero();
                             return {std::cos(course), std::sin(course)};
                         }).back();
        out.moving += p > 0.9;
        out.still += p < 0.1;
    }
    return out;
}

// Scans come at 5 Hz; at 10 m a detection is good to 0.1 m along and 0.17 m across. Each bound of 90 lies
// three standard deviations of a binomial below the 96 and more that other seeds give.
TEST(RelativeTrackRunsTest, MoversAndStillObjectsAreToldApart) {
    EXPECT_GE(verdictsAfter(15, 0, 15).moving, 90);
    EXPECT_GE(verdictsAfter(15, 0, 0).still, 90);
    EXPECT_LE(verdictsAfter(15, 0, 15).still, 1);
    EXPECT_LE(verdictsAfter(15, 0, 0).moving, 1);
}

TEST(RelativeTrackRunsTest, StoppingAndStartingIsNoticed) {
    EXPECT_GE(verdictsAfter(30 + 10, 0, 30).still, 90);
    EXPECT_GE(verdictsAfter(30 + 5, 30, 100).moving, 90);
}

TEST(RelativeTrackRunsTest, DecisionsAreAsOftenWrongAsTheySay) {
    // Objects as believed: 30 % move, with 1 m/s in each component. At the first time that P(moving) passes
    // 0.9 or 0.1, one decision in ten is wrong at most, on average, of either kind: optional stopping.
    int decisions[2] = {0, 0}, wrong[2] = {0, 0};
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        Drive drive(5000 + seed);
        const bool moves = drive.random.uniform() < MotionChange{}.moving_probability;
        const Vector2 velocity =
            moves ? Vector2(drive.random.normal(), drive.random.normal()) : Vector2(0, 0);
        for (const double p : movingProbabilities(drive, 20, [&](int) { return velocity; })) {
            if (p > 0.1 && p < 0.9) continue;
            const bool verdict = p >= 0.9;
            ++decisions[verdict];
            wrong[verdict] += verdict != moves;
            break;
        }
    }
    EXPECT_GT(decisions[0] + decisions[1], 900);
    for (const int kind : {0, 1}) {
        // Three standard deviations: one choice of seeds in 700.
        const double expected = 0.1 * decisions[kind];
        EXPECT_LT(wrong[kind], expected + 3 * std::sqrt(0.9 * expected)) << (kind ? "moving" : "still");
    }
}

}  // namespace relative_track_runs_test
}  // namespace slamot
