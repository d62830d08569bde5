#include <gtest/gtest.h>

#include "slamot/core/particles/StandingSensor.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace standing_sensor_test {

constexpr double max_range = 20, min_range = 2;

ScanView view(double field_of_view) {
    RangeBearingSensor sensor;
    sensor.pose = {0.3, -0.2, 0.4};
    sensor.min_range = min_range;
    sensor.max_range = max_range;
    sensor.field_of_view = field_of_view;
    return {sensor, max_range + sensor.pose.position().norm(), true};
}

struct Scene {
    PoseBelief pose;
    GaussianPoint point;
};

/// Points out to 30 m, on all sides.
Scene scene(std::uint32_t number) {
    RandomStream random(5, RandomPurpose::test, 0, number);
    Scene out;
    out.pose.mean << random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-pi, pi);
    out.pose.factor = factorOf(test::randomCovariance(random, 3, 0.05));
    const double direction = random.uniform(-pi, pi), range = random.uniform(0.5, 30);
    out.point.mean = out.pose.mean.head<2>() + range * Vector2(std::cos(direction), std::sin(direction));
    out.point.covariance = test::randomCovariance(random, 2, 0.2);
    return out;
}

TEST(StandingSensorTest, SeesAsThePointsOwnSightByJacobians) {
    const ScanView all_round = view(2 * pi);
    for (std::uint32_t k = 0; k < 50; ++k) {
        const Scene s = scene(k);
        const PointSight sight = StandingSensor(s.pose, all_round).sightOf(s.point);
        const PointSight expected =
            sightOf(s.point, s.pose, all_round.sensor.pose, GaussianTransform::linear);
        EXPECT_NEAR(sight.z.x(), expected.z.x(), 1e-12);
        EXPECT_NEAR(wrapAngle(sight.z.y() - expected.z.y()), 0, 1e-12);
        EXPECT_TRUE(test::near(sight.covariance, expected.covariance, 1e-12));
        EXPECT_TRUE(test::near(sight.A, expected.A, 1e-12));
        EXPECT_TRUE(test::near(sight.cross, expected.cross, 1e-12));
    }
}

TEST(StandingSensorTest, PointsWhereADetectionPoints) {
    const ScanView all_round = view(2 * pi);
    for (std::uint32_t k = 0; k < 20; ++k) {
        const Scene s = scene(k);
        const StandingSensor sensor(s.pose, all_round);
        EXPECT_TRUE(test::near(sensor.pointOf(sensor.sightOf(s.point).z), s.point.mean, 1e-12));
    }
}

// What is covered lies within the limits; from a pose that is drawn, what may be seen is not sorted out.
TEST(StandingSensorTest, LimitsAreTheSensors) {
    for (const double field_of_view : {2 * pi, pi, 0.5}) {
        const ScanView limited = view(field_of_view);
        int covered = 0, sorted_out = 0;
        for (std::uint32_t k = 0; k < 400; ++k) {
            Scene s = scene(k);
            s.pose.factor.setZero();
            const StandingSensor sensor(s.pose, limited);
            const PointSight sight = sensor.sightOf(s.point);
            const bool within = sight.z.x() >= min_range && sight.z.x() <= max_range &&
                                std::abs(sight.z.y()) <= 0.5 * field_of_view;
            EXPECT_EQ(sensor.covers(s.point.mean), within) << k;
            covered += within;
            sorted_out += !sensor.mayShow(s.point);
            if (!sensor.mayShow(s.point)) {
                EXPECT_LT(sensor.inView(sight), 1e-3) << k;
            }
        }
        EXPECT_GT(covered, 10);
        EXPECT_GT(sorted_out, 50);
    }
}

}  // namespace standing_sensor_test
}  // namespace slamot
