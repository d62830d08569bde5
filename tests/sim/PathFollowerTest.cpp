#include <gtest/gtest.h>

#include "slamot/sim/PathFollower.h"

namespace slamot::sim {
namespace path_follower_test {

TEST(PathFollower, GoesOnWhenAWaypointIsNear) {
    PathFollower path({{10, 0}, {10, 10}}, {0, 0}, 1, 1);
    EXPECT_EQ(path.next({8.9, 0}), Vector2(10, 0));
    EXPECT_EQ(path.next({9.0, 0}), Vector2(10, 10));
    EXPECT_EQ(path.next({10, 9.5}), std::nullopt);
    EXPECT_EQ(path.next({0, 0}), std::nullopt);
}

TEST(PathFollower, GoesOnWhenAWaypointHasBeenPassedAtADistance) {
    PathFollower path({{10, 0}, {20, 0}}, {0, 0}, 1, 1);
    EXPECT_EQ(path.next({9.9, 5}), Vector2(10, 0));
    EXPECT_EQ(path.next({10.1, 5}), Vector2(20, 0));
}

TEST(PathFollower, DrivesThePathAsOftenAsAsked) {
    PathFollower path({{10, 0}, {0, 0}}, {0, 0}, 2, 1);
    for (int round = 0; round < 2; ++round) {
        EXPECT_EQ(path.next({5, 0}), Vector2(10, 0));
        EXPECT_EQ(path.next({10, 0}), Vector2(0, 0));
        const auto after = path.next({0, 0});
        EXPECT_EQ(after, round == 0 ? std::optional(Vector2(10, 0)) : std::nullopt);
    }
}

TEST(PathFollower, ZeroLoopsIsForEver) {
    PathFollower path({{10, 0}, {0, 0}}, {0, 0}, 0, 1);
    for (int round = 0; round < 100; ++round) {
        EXPECT_EQ(path.next({10, 0}), Vector2(0, 0));
        EXPECT_EQ(path.next({0, 0}), Vector2(10, 0));
    }
}

TEST(PathFollower, APathThatIsNearAsAWholeDoesNotHang) {
    PathFollower path({{0, 0}, {0.1, 0}}, {0, 0}, 0, 1);
    EXPECT_TRUE(path.next({0, 0}).has_value());
}

}  // namespace path_follower_test
}  // namespace slamot::sim
