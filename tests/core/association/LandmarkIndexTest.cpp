#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

#include "slamot/core/association/LandmarkIndex.h"
#include "slamot/core/models/RangeBearing.h"
#include "slamot/core/random/RandomStream.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace landmark_index_test {

using testing::ElementsAre;

TEST(LandmarkIndex, FindsWhatALinearSearchFindsWhileLandmarksComeGoAndDrift) {
    RandomStream random(41, RandomPurpose::test);
    LandmarkIndex index(0.3);
    std::map<BlockId, Vector2> all;
    BlockId next = 0;
    const auto anywhere = [&random] { return Vector2(random.uniform(-30, 30), random.uniform(-30, 30)); };
    int found_total = 0;
    for (int step = 0; step < 3000; ++step) {
        const double what = random.uniform();
        auto some = all.lower_bound(static_cast<BlockId>(random.uniform(0, next)));
        if (what < 0.3 || some == all.end()) {
            all[next] = anywhere();
            index.set(next, all[next]);
            ++next;
        } else if (what < 0.45) {
            index.remove(some->first);
            all.erase(some);
        } else {  // mostly less than the slack, at times a jump
            some->second += what < 0.95 ? Vector2(0.2 * test::randomVector(random, 2)) : anywhere();
            index.set(some->first, some->second);
        }
        ASSERT_EQ(index.size(), static_cast<int>(all.size()));
        const Vector2 centre = anywhere();
        const double radius = random.uniform(0, 12);
        std::vector<BlockId> expected;  // ascending, as the map is
        for (const auto& [id, p] : all)
            if ((p - centre).norm() <= radius) expected.push_back(id);
        ASSERT_EQ(index.within(centre, radius), expected) << step;
        found_total += static_cast<int>(expected.size());
    }
    EXPECT_GT(found_total, 10000);
}

TEST(LandmarkIndex, TheRimCounts) {
    LandmarkIndex index(0.5);
    index.set(4, {3, 4});
    index.set(2, {0, 5});
    index.set(9, {0, 5.1});
    EXPECT_THAT(index.within({0, 0}, 5), ElementsAre(2, 4));
    index.set(9, {0.0, 4.9});  // within the slack
    EXPECT_THAT(index.within({0, 0}, 5), ElementsAre(2, 4, 9));
    index.set(9, {0.0, 5.3});
    EXPECT_THAT(index.within({0, 0}, 5), ElementsAre(2, 4));
}

TEST(LandmarkIndex, RefusesNonsense) {
    LandmarkIndex index;
    EXPECT_THAT(test::messageOf<std::invalid_argument>([&] {
                    index.set(7, {0, std::numeric_limits<double>::infinity()});
                }),
                testing::HasSubstr("landmark 7"));
    EXPECT_THROW(index.remove(7), std::out_of_range);
    RangeBearingSensor sensor;
    sensor.label = "laser";
    EXPECT_THAT(test::messageOf<std::invalid_argument>([&] { index.inView({}, sensor, 0.99, 0); }),
                testing::HasSubstr("laser"));
}

RangeBearingSensor forward() {
    RangeBearingSensor sensor;
    sensor.max_range = 10;
    sensor.field_of_view = radians(90);
    sensor.pose = {0.5, -0.2, 0.3};
    return sensor;
}

TEST(LandmarkIndex, AKnownPoseSeesItsSector) {
    // Looking along -x, across the turn of the angle: a quarter to both sides of pi.
    LandmarkIndex index;
    RangeBearingSensor sensor;
    sensor.max_range = 10;
    sensor.field_of_view = radians(90);
    const std::vector<Vector2> points{{-5, 4.9}, {-5, 5.1},  {-5, -4.9}, {-5, -5.1},
                                      {-9.9, 0}, {-10.1, 0}, {5, 0}};
    for (std::size_t i = 0; i < points.size(); ++i) index.set(static_cast<BlockId>(i), points[i]);
    PoseGaussian robot;
    robot.mean = {0, 0, pi};
    EXPECT_THAT(index.inView(robot, sensor, 0.99, 0), ElementsAre(0, 2, 4));
    EXPECT_THAT(index.inView(robot, sensor, 0.99, 0.2), ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(LandmarkIndex, ATurnMovesASensorOnALeverArm) {
    // 3 m to the left of the robot: a turn by 1.96 * 0.1 rad takes it 0.588 m forwards.
    LandmarkIndex index;
    index.set(0, {10.5, 3});
    index.set(1, {10.7, 3});
    RangeBearingSensor sensor;
    sensor.max_range = 10;
    sensor.pose = {0, 3, 0};
    PoseGaussian robot;
    EXPECT_THAT(index.inView(robot, sensor, 0.95, 0), ElementsAre());
    robot.covariance(2, 2) = 0.01;
    EXPECT_THAT(index.inView(robot, sensor, 0.95, 0), ElementsAre(0));
}

TEST(LandmarkIndex, MissesNothingThatAPoseWithinItsBoundsSees) {
    RandomStream random(42, RandomPurpose::test);
    LandmarkIndex index(0.4);
    std::vector<Vector2> points;
    for (int i = 0; i < 2000; ++i) {
        points.push_back({random.uniform(-40, 40), random.uniform(-40, 40)});
        index.set(i, points.back());
    }
    const RangeBearingSensor sensor = forward();
    int seen_only_by_sample = 0;
    std::size_t found_total = 0;
    for (int trial = 0; trial < 400; ++trial) {
        PoseGaussian robot;
        robot.mean = {random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-pi, pi)};
        robot.covariance = test::randomCovariance(random, 3, 0.05);
        robot.covariance.row(2) *= 0.3;
        robot.covariance.col(2) *= 0.3;
        const std::vector<BlockId> found = index.inView(robot, sensor, 0.95, 0);
        found_total += found.size();
        // A pose within the bounds for position (chi-square 5.99 of two degrees) and heading (1.96
        // deviations).
        const Vector3 error = robot.covariance.llt().matrixL() * test::randomVector(random, 3);
        const Matrix2 P = robot.covariance.topLeftCorner<2, 2>();
        if (error.head<2>().dot(P.inverse() * error.head<2>()) > 5.991 ||
            std::abs(error(2)) > 1.9599 * std::sqrt(robot.covariance(2, 2)))
            continue;
        const auto sees = [&](const Vector3& pose, const Vector2& p) {
            const Vector2 z = rangeBearing<double>(pose, p, sensor.pose);
            return z.x() <= sensor.max_range && std::abs(z.y()) <= 0.5 * sensor.field_of_view;
        };
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!sees(robot.mean.vector() + error, points[i])) continue;
            ASSERT_TRUE(std::binary_search(found.begin(), found.end(), static_cast<BlockId>(i))) << trial;
            seen_only_by_sample += !sees(robot.mean.vector(), points[i]);
        }
    }
    EXPECT_GT(seen_only_by_sample, 300);
    // And not much else: a sector of 79 m^2 with 25 landmarks, widened by about a metre and 0.2 rad.
    EXPECT_LT(found_total, 400u * 60u);
}

}  // namespace landmark_index_test
}  // namespace slamot
