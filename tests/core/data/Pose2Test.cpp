#include <gtest/gtest.h>

#include "slamot/core/data/Pose2.h"
#include "support/Expect.h"

namespace slamot {
namespace pose2_test {

using test::near;

const Pose2 poses[] = {{0, 0, 0}, {1, 2, 0.5}, {-3, 4, pi}, {10, -20, -3.0}, {0, 0, -pi / 2}};

/// Same place, same direction.
testing::AssertionResult same(const Pose2& a, const Pose2& b) {
    return near(Vector3(a.x, a.y, angleDifference(a.theta, b.theta)), Vector3(b.x, b.y, 0), 1e-14);
}

TEST(Pose2Test, ComposesByHand) {
    // A quarter turn left at (1, 2), then 3 ahead and 1 to the left: (1 - 1, 2 + 3).
    EXPECT_TRUE(same(Pose2{1, 2, pi / 2} * Pose2{3, 1, pi / 4}, {0, 5, 3 * pi / 4}));
    EXPECT_TRUE(near(Pose2{1, 2, pi / 2} * Vector2(3, 1), Vector2(0, 5), 1e-15));
}

TEST(Pose2Test, IsAGroup) {
    for (const Pose2& a : poses) {
        EXPECT_TRUE(same(a * inverse(a), {}));
        EXPECT_TRUE(same(inverse(a) * a, {}));
        EXPECT_TRUE(same(inverse(inverse(a)), a));
        for (const Pose2& b : poses)
            for (const Pose2& c : poses) {
                EXPECT_TRUE(same((a * b) * c, a * (b * c)));
                EXPECT_TRUE(near((a * b) * c.position(), a * (b * c.position()), 1e-14));
            }
    }
}

TEST(Pose2Test, HeadingsStayWrapped) {
    for (const Pose2& a : poses)
        for (const Pose2& b : poses) {
            const double theta = (a * b).theta;
            EXPECT_TRUE(theta > -pi && theta <= pi);
        }
    EXPECT_NEAR(Pose2::fromVector({0, 0, 4}).theta, 4 - 2 * pi, 1e-15);
}

TEST(Pose2Test, QuarterTurnIsTheDerivativeOfRotation) {
    const Vector2 p(2, -1);
    EXPECT_TRUE(near(quarterTurn() * p, Vector2(1, 2), 0));
    const double h = 1e-6;  // central difference: error h^2/6
    EXPECT_TRUE(
        near((rotation(0.4 + h) - rotation(0.4 - h)) / (2 * h) * p, quarterTurn() * rotation(0.4) * p, 1e-9));
}

}  // namespace pose2_test
}  // namespace slamot
