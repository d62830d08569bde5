#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>

#include "slamot/core/data/Angle.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot {
namespace angle_test {

TEST(AngleTest, WrapsIntoTheHalfOpenInterval) {
    EXPECT_EQ(wrapAngle(0.0), 0);
    EXPECT_EQ(wrapAngle(pi), pi);
    EXPECT_EQ(wrapAngle(-pi), pi);
    EXPECT_EQ(wrapAngle(3.0), 3.0);
    EXPECT_EQ(wrapAngle(-3.0), -3.0);
    EXPECT_NEAR(wrapAngle(pi + 0.5), -pi + 0.5, 1e-15);
    EXPECT_NEAR(wrapAngle(-pi - 0.5), pi - 0.5, 1e-15);
    for (int turns = -1000; turns <= 1000; turns += 7)
        EXPECT_NEAR(wrapAngle(0.3 + 2 * pi * turns), 0.3, 2e-12) << turns;  // 6000 rad has an ulp of 1e-12
}

TEST(AngleTest, NeverLeavesTheInterval) {
    // Multiples of pi and their neighbours, where rounding could step outside.
    for (int k = -2001; k <= 2001; ++k)
        for (const double direction : {-1e9, 1e9}) {
            double angle = k * pi;
            for (int step = 0; step < 4; ++step, angle = std::nextafter(angle, direction)) {
                EXPECT_GT(wrapAngle(angle), -pi) << k << " " << step;
                EXPECT_LE(wrapAngle(angle), pi) << k << " " << step;
            }
        }
    RandomStream random(1, RandomPurpose::test);
    for (int i = 0; i < 100000; ++i) {
        const double angle = random.uniform(-1e4, 1e4), wrapped = wrapAngle(angle);
        ASSERT_TRUE(wrapped > -pi && wrapped <= pi) << angle;
        // Differs by whole turns: sine and cosine are kept (an ulp of 1e4 is 2e-12).
        ASSERT_NEAR(std::sin(wrapped), std::sin(angle), 5e-12);
        ASSERT_NEAR(std::cos(wrapped), std::cos(angle), 5e-12);
    }
}

TEST(AngleTest, DifferenceTakesTheShortWay) {
    EXPECT_NEAR(angleDifference(pi - 0.1, -pi + 0.1), -0.2, 1e-14);
    EXPECT_NEAR(angleDifference(-pi + 0.1, pi - 0.1), 0.2, 1e-14);
    EXPECT_EQ(angleDifference(1.0, 1.0), 0);
}

TEST(AngleTest, WrappingHasSlopeOne) {
    using Jet = ceres::Jet<double, 1>;
    for (const double angle : {0.3, pi, -pi, 4.0, -4.0, 100.0}) {
        const Jet wrapped = wrapAngle(Jet(angle, 0));
        EXPECT_EQ(wrapped.a, wrapAngle(angle));
        EXPECT_EQ(wrapped.v(0), 1.0);
    }
}

TEST(AngleTest, DegreesAndRadians) {
    EXPECT_EQ(radians(180), pi);
    EXPECT_EQ(degrees(pi), 180);
    EXPECT_NEAR(radians(-30), -pi / 6, 1e-15);
}

}  // namespace angle_test
}  // namespace slamot
