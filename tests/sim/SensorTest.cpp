#include <gtest/gtest.h>

#include <set>

#include "Scenarios.h"
#include "slamot/sim/Sensor.h"

namespace slamot::sim {
namespace sensor_test {

/// Landmarks every degree on circles of 5, 10, ..., 30 m around the origin: id = 360 * circle + degree.
World rings() {
    World world;
    for (int circle = 0; circle < 6; ++circle) {
        for (int degree = 0; degree < 360; ++degree) {
            const double a = radians(degree), r = 5.0 * (circle + 1);
            world.landmarks[SourceId{360 * circle + degree}] = {r * std::cos(a), r * std::sin(a)};
        }
    }
    return world;
}

SensorParameters exactSensor() {
    SensorParameters sensor = sensorOf(SensorRole::landmarks, "landmarks");
    sensor.true_range_std = sensor.true_bearing_std = 0;
    sensor.field_of_view = 2 * pi;
    sensor.max_range = 100;
    return sensor;
}

Scan look(const SensorParameters& sensor, const World& world, const Pose2& pose = {}, std::uint64_t seed = 1,
          int step = 0) {
    return scan(standingRobot(100000), sensor, 0, step, pose, world, {}, seed);
}

TEST(Sensor, SeesExactlyWhatLiesWithinItsLimits) {
    SensorParameters sensor = exactSensor();
    sensor.field_of_view = radians(90.5);
    sensor.min_range = 7;
    sensor.max_range = 22;
    std::set<std::int64_t> seen, expected;
    for (const auto& item : look(sensor, rings()).reading.items) seen.insert(item.id.value);
    for (int circle = 1; circle <= 3; ++circle) {  // 10, 15 and 20 m
        for (int degree = -45; degree <= 45; ++degree) expected.insert(360 * circle + (degree + 360) % 360);
    }
    EXPECT_EQ(seen, expected);
}

TEST(Sensor, LimitsIncludeTheirRims) {
    SensorParameters sensor = exactSensor();
    sensor.field_of_view = pi;
    sensor.min_range = 3;
    sensor.max_range = 4;
    World world;
    world.landmarks[SourceId{0}] = {0, 3};   // bearing atan2(3, 0) = pi/2, range 3
    world.landmarks[SourceId{1}] = {0, -4};  // bearing -pi/2, range 4
    world.landmarks[SourceId{2}] = {-1e-9, 3.5};
    world.landmarks[SourceId{3}] = {3.5, 0};
    EXPECT_EQ(look(sensor, world).reading.items.size(), 3u);
}

// A full circle must never lose what lies straight behind, whatever the rounding of a bearing of +-pi.
TEST(Sensor, AFullCircleSeesBackwardsFromEveryPose) {
    const SensorParameters sensor = exactSensor();
    for (int i = 0; i < 2000; ++i) {
        const double heading = wrapAngle(0.01 * i * pi + 1e-3 * i);
        World world;
        world.landmarks[SourceId{0}] = {1.5 - 10 * std::cos(heading), -2 - 10 * std::sin(heading)};
        const Scan s = look(sensor, world, {1.5, -2, heading});
        ASSERT_EQ(s.reading.items.size(), 1u) << heading;
        EXPECT_NEAR(std::abs(s.reading.items[0].bearing), pi, 1e-12);
    }
}

TEST(Sensor, NoisyBearingsBehindAreWrapped) {
    SensorParameters sensor = exactSensor();
    sensor.true_bearing_std = 0.1;
    World world;
    world.landmarks[SourceId{0}] = {-10, 0};
    int left = 0;
    for (int step = 0; step < 1000; ++step) {
        const Scan s = look(sensor, world, {}, 1, step);
        ASSERT_EQ(s.reading.items.size(), 1u);
        const double bearing = s.reading.items[0].bearing;
        ASSERT_GT(bearing, -pi);
        ASSERT_LE(bearing, pi);
        left += bearing > 0;
    }
    EXPECT_NEAR(left, 500, 4 * std::sqrt(250.0));  // Binomial(1000, 1/2): 6e-5
}

TEST(Sensor, MeasuresFromWhereItIsMounted) {
    SensorParameters sensor = exactSensor();
    sensor.position = {1, 0.5};
    sensor.orientation = radians(90);
    World world;
    // Robot at (10, 0) heading 90 deg: the sensor is at (10 - 0.5, 1) and looks along 180 deg.
    world.landmarks[SourceId{0}] = {9.5 - 3, 1 + 4};  // 5 m away, at 180 deg - atan2(4, 3)
    const Scan s = look(sensor, world, {10, 0, radians(90)});
    ASSERT_EQ(s.reading.items.size(), 1u);
    EXPECT_NEAR(s.reading.items[0].range, 5, 1e-12);
    EXPECT_NEAR(s.reading.items[0].bearing, -std::atan2(4.0, 3.0), 1e-12);
    EXPECT_EQ(s.reading.sensor.pose.vector(), Vector3(1, 0.5, radians(90)));
}

// False alarms of the statistical tests below: 4 standard errors, 6e-5 each.
TEST(Sensor, NoiseHasItsTrueStandardDeviationsAndTheLogItsClaim) {
    SensorParameters sensor = exactSensor();
    sensor.range_std = 0.1;
    sensor.bearing_std = 0.05;
    sensor.true_range_std = 0.3;
    sensor.true_bearing_std = 0.02;
    World world;
    world.landmarks[SourceId{0}] = {20, 0};
    const int n = 5000;
    Vector2 sum = Vector2::Zero(), squares = Vector2::Zero();
    double product = 0;
    for (int step = 0; step < n; ++step) {
        const auto item = look(sensor, world, {}, 1, step).reading.items.at(0);
        EXPECT_EQ(item.covariance, Matrix2(Vector2(0.1 * 0.1, 0.05 * 0.05).asDiagonal()));
        const Vector2 e(item.range - 20, item.bearing);
        sum += e;
        squares += e.cwiseProduct(e);
        product += e.x() * e.y();
    }
    const Vector2 expected(0.3, 0.02);
    for (int i = 0; i < 2; ++i) {
        EXPECT_NEAR(sum[i] / n, 0, 4 * expected[i] / std::sqrt(n));
        EXPECT_NEAR(std::sqrt(squares[i] / n), expected[i], 4 * expected[i] / std::sqrt(2.0 * n));
    }
    EXPECT_NEAR(product / n, 0, 4 * 0.3 * 0.02 / std::sqrt(n));
}

TEST(Sensor, DetectsWithItsProbability) {
    SensorParameters sensor = exactSensor();
    sensor.detection_probability = 0.7;
    const int n = 2160 * 5;
    int detected = 0;
    for (int step = 0; step < 5; ++step) {
        detected += static_cast<int>(look(sensor, rings(), {}, 1, step).reading.items.size());
    }
    EXPECT_NEAR(detected, 0.7 * n, 4 * std::sqrt(n * 0.7 * 0.3));
    sensor.detection_probability = 0;
    EXPECT_TRUE(look(sensor, rings()).reading.items.empty());
}

TEST(Sensor, ClutterIsPoissonAndUniformInItsField) {
    SensorParameters sensor = exactSensor();
    sensor.clutter_per_scan = 10;
    sensor.min_range = 5;
    sensor.max_range = 25;
    sensor.field_of_view = radians(120);
    const int scans = 1000;
    double count = 0, squares = 0, near = 0, left = 0;
    for (int step = 0; step < scans; ++step) {
        const Scan s = look(sensor, {}, {}, 1, step);
        count += s.origins.size();
        squares += static_cast<double>(s.origins.size() * s.origins.size());
        for (std::size_t i = 0; i < s.origins.size(); ++i) {
            const auto& item = s.reading.items[i];
            EXPECT_EQ(s.origins[i].kind, "clutter");
            EXPECT_EQ(s.origins[i].id.value, -1);
            EXPECT_FALSE(item.id.valid());
            ASSERT_TRUE(item.range > 5 && item.range < 25 && std::abs(item.bearing) < radians(60));
            near += item.range < 15;
            left += item.bearing > 0;
        }
    }
    const double mean = count / scans, variance = squares / scans - mean * mean;
    EXPECT_NEAR(mean, 10, 4 * std::sqrt(10.0 / scans));
    // Variance of the sample variance of a Poisson(m): (m + 2 m^2)/n.
    EXPECT_NEAR(variance, 10, 4 * std::sqrt((10 + 2 * 100.0) / scans));
    EXPECT_NEAR(near, count / 2, 4 * std::sqrt(count / 4));
    EXPECT_NEAR(left, count / 2, 4 * std::sqrt(count / 4));
}

TEST(Sensor, OutliersKeepTheirIdentityAndFallAnywhereInTheField) {
    SensorParameters sensor = exactSensor();
    sensor.outlier_probability = 0.2;
    World world;
    world.landmarks[SourceId{8}] = {20, 0};
    const int n = 2000;
    int outliers = 0;
    for (int step = 0; step < n; ++step) {
        const Scan s = look(sensor, world, {}, 1, step);
        ASSERT_EQ(s.reading.items.size(), 1u);
        EXPECT_EQ(s.reading.items[0].id, SourceId{8});
        outliers += std::abs(s.reading.items[0].range - 20) > 1e-9;
    }
    EXPECT_NEAR(outliers, 0.2 * n, 4 * std::sqrt(n * 0.2 * 0.8));
}

class Roles : public ::testing::Test {
  protected:
    Scan look(const SensorParameters& sensor, int robot) {
        const Scenario scenario = standingRobot(1);
        World world;
        world.landmarks[SourceId{5}] = {10, 0};
        std::vector<Trajectory> movers{simulateMover(scenario, straightMover(5, {10, 5}, {0, 0}), 1)};
        Trajectory mate = movers.front();
        mate.id = SourceId{robot_id_base + 1};
        mate.states[0].position = {10, -5};
        movers.push_back(mate);
        return scan(scenario, sensor, robot, 0, {}, world, movers, 1);
    }
};

TEST_F(Roles, DecideWhatIsSeenAndWhichIdentitiesAreWritten) {
    const auto kinds = [](const Scan& s) {
        std::vector<std::string> all;
        for (std::size_t i = 0; i < s.origins.size(); ++i) {
            EXPECT_EQ(s.origins[i].index, static_cast<int>(i));
            all.push_back(s.origins[i].kind + std::to_string(s.origins[i].id.value) + "/" +
                          std::to_string(s.reading.items[i].id.value));
        }
        return all;
    };
    using Kinds = std::vector<std::string>;
    SensorParameters sensor = exactSensor();  // in the order of bearings: -26.6, 0 and 26.6 deg
    EXPECT_EQ(kinds(look(sensor, 0)), (Kinds{"landmark5/5"}));
    sensor.role = SensorRole::movers;
    EXPECT_EQ(kinds(look(sensor, 0)), (Kinds{"mover1000001/1000001", "mover5/5"}));
    EXPECT_EQ(kinds(look(sensor, 1)), (Kinds{"mover5/5"}));  // robot 1 does not see itself
    sensor.identities = IdentityRule::hidden;
    EXPECT_EQ(kinds(look(sensor, 1)), (Kinds{"mover5/-1"}));
    sensor.identities = IdentityRule::automatic;
    sensor.role = SensorRole::mixed;
    EXPECT_EQ(kinds(look(sensor, 0)), (Kinds{"mover1000001/-1", "landmark5/-1", "mover5/-1"}));
}

}  // namespace sensor_test
}  // namespace slamot::sim
