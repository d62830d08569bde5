#include <gtest/gtest.h>

#include "Scenarios.h"
#include "slamot/sim/Mover.h"

namespace slamot::sim {
namespace mover_test {

TEST(Mover, ConstantVelocityWithoutNoiseIsAStraightLine) {
    const Trajectory t = simulateMover(standingRobot(20), straightMover(3, {1, 2}, {2, -1}), 1);
    EXPECT_EQ(t.id, SourceId{3});
    ASSERT_EQ(t.states.size(), 21u);
    // 20 steps of 0.1 s: (1, 2) + 2 s * (2, -1) = (5, 0).
    EXPECT_NEAR((t.states[20].position - Vector2(5, 0)).norm(), 0, 1e-12);
    EXPECT_EQ(t.states[20].velocity, Vector2(2, -1));
    EXPECT_EQ(t.states[20].acceleration, Vector2(0, 0));
    EXPECT_EQ(t.states[20].mode, "cv");
    EXPECT_EQ(t.states[0].stamp, epoch);
    EXPECT_EQ(t.states[20].stamp, later(epoch, 2.0));
}

TEST(Mover, ConstantAccelerationWithoutNoise) {
    MoverParameters mover = straightMover(0, {0, 0}, {1, 0});
    mover.model = MoverModel::ca;
    mover.ca_jerk_std = 0;
    mover.acceleration = {0, 2};
    const TrueTarget end = simulateMover(standingRobot(20), mover, 1).states.back();
    // 2 s: x = 2, y = 2 * 2^2 / 2 = 4, vy = 4.
    EXPECT_NEAR((end.position - Vector2(2, 4)).norm(), 0, 1e-12);
    EXPECT_NEAR((end.velocity - Vector2(1, 4)).norm(), 0, 1e-12);
    EXPECT_EQ(end.acceleration, Vector2(0, 2));
}

TEST(Mover, CoordinatedTurnWithoutNoiseIsACircle) {
    MoverParameters mover = straightMover(0, {0, 0}, {1, 0});
    mover.model = MoverModel::ct;
    mover.ct_acceleration_std = 0;
    mover.ct_turn_rate = pi / 2;
    // A quarter of a circle in 1 s to the left, radius v/w = 2/pi: ends at (r, r) going along +y.
    const TrueTarget end = simulateMover(standingRobot(10), mover, 1).states.back();
    EXPECT_NEAR((end.position - Vector2(2 / pi, 2 / pi)).norm(), 0, 1e-12);
    EXPECT_NEAR((end.velocity - Vector2(0, 1)).norm(), 0, 1e-12);
}

TEST(Mover, UnicycleWithoutNoiseIsACircleWithItsCentripetalAcceleration) {
    MoverParameters mover = straightMover(0, {0, 0}, {1, 0});
    mover.model = MoverModel::unicycle;
    mover.unicycle_acceleration_std = mover.unicycle_turn_rate_std = 0;
    mover.unicycle_turn_rate = pi / 2;
    const TrueTarget end = simulateMover(standingRobot(10), mover, 1).states.back();
    EXPECT_NEAR((end.position - Vector2(2 / pi, 2 / pi)).norm(), 0, 1e-12);
    EXPECT_NEAR((end.velocity - Vector2(0, 1)).norm(), 0, 1e-12);
    EXPECT_NEAR((end.acceleration - Vector2(-pi / 2, 0)).norm(), 0, 1e-12);  // w J v
}

// Each step's velocity change is dt times a draw of the acceleration, the rest of the position change dt^2/2
// times the same draw.
TEST(Mover, ConstantVelocityNoiseHasItsStandardDeviation) {
    MoverParameters mover = straightMover(0, {0, 0}, {1, 0});
    mover.cv_acceleration_std = 0.4;
    const int n = 5000;
    const Trajectory t = simulateMover(standingRobot(n), mover, 1);
    Vector2 sum = Vector2::Zero(), squares = Vector2::Zero();
    for (int k = 1; k <= n; ++k) {
        const TrueTarget &a = t.states[k - 1], &b = t.states[k];
        const Vector2 w = (b.velocity - a.velocity) / 0.1;
        ASSERT_NEAR((b.position - a.position - 0.1 * a.velocity - 0.005 * w).norm(), 0, 1e-8);
        sum += w;
        squares += w.cwiseProduct(w);
    }
    for (int i = 0; i < 2; ++i) {
        // Mean 0 +- 0.4/sqrt(n), deviation 0.4 +- 0.4/sqrt(2n); 4 standard errors, false alarm 6e-5 each.
        EXPECT_NEAR(sum[i] / n, 0, 4 * 0.4 / std::sqrt(n));
        EXPECT_NEAR(std::sqrt(squares[i] / n), 0.4, 4 * 0.4 / std::sqrt(2.0 * n));
    }
}

TEST(Mover, JerkHasItsStandardDeviation) {
    MoverParameters mover = straightMover(0, {0, 0}, {1, 0});
    mover.model = MoverModel::ca;
    mover.ca_jerk_std = 1.8;
    const int n = 5000;
    const Trajectory t = simulateMover(standingRobot(n), mover, 1);
    double squares = 0;
    for (int k = 1; k <= n; ++k) {
        squares += ((t.states[k].acceleration - t.states[k - 1].acceleration) / 0.1).squaredNorm();
    }
    EXPECT_NEAR(std::sqrt(squares / (2 * n)), 1.8, 4 * 1.8 / std::sqrt(4.0 * n));  // 2n draws; 6e-5
}

// As in the golden run: constant velocity keeps the acceleration at zero, so constant acceleration starts
// from zero, and the model in force at a step's start moves the mover through it.
TEST(Mover, ScheduleSwitchesAtTheStepThatStartsAtItsTime) {
    MoverParameters mover = straightMover(0, {0, 0}, {1, 0});
    mover.model = MoverModel::schedule;
    mover.schedule = {{0, TargetModelKind::cv, {}}, {1.0, TargetModelKind::ca, {}}};
    mover.ca_jerk_std = 2;
    const Trajectory t = simulateMover(standingRobot(20), mover, 1);
    EXPECT_EQ(t.states[10].mode, "cv");
    EXPECT_EQ(t.states[10].acceleration, Vector2(0, 0));
    EXPECT_EQ(t.states[11].mode, "ca");
    // From zero acceleration by jerk j over dt: a = j dt, v - v0 = j dt^2/2 = a dt/2.
    const Vector2 a = t.states[11].acceleration;
    EXPECT_GT(a.norm(), 0);
    EXPECT_NEAR((t.states[11].velocity - Vector2(1, 0) - 0.05 * a).norm(), 0, 1e-12);
}

TEST(Mover, ScheduledTurnsMayHaveTheirOwnRates) {
    MoverParameters mover = straightMover(0, {0, 0}, {1, 0});
    mover.model = MoverModel::schedule;
    mover.ct_acceleration_std = 0;
    mover.schedule = {{0, TargetModelKind::ct, 0.5}, {1.0, TargetModelKind::ct, -0.5}};
    const Trajectory t = simulateMover(standingRobot(20), mover, 1);
    const auto heading = [&](int k) {
        return std::atan2(t.states[k].velocity.y(), t.states[k].velocity.x());
    };
    EXPECT_NEAR(heading(10), 0.5, 1e-12);
    EXPECT_NEAR(heading(20), 0, 1e-12);
}

TEST(Mover, IsThereFromAppearUntilBeforeVanish) {
    MoverParameters mover = straightMover(0, {5, 0}, {1, 0});
    mover.appear = 0.5;
    mover.vanish = 1.0;
    const Trajectory t = simulateMover(standingRobot(20), mover, 1);
    EXPECT_EQ(t.at(4), nullptr);
    ASSERT_NE(t.at(5), nullptr);
    EXPECT_EQ(t.at(5)->position, Vector2(5, 0));  // its start is where it appears
    EXPECT_NE(t.at(9), nullptr);
    EXPECT_EQ(t.at(10), nullptr);
}

TEST(Mover, WaypointMoverTurnsNoFasterThanItMayAndStopsAtTheEnd) {
    MoverParameters mover;
    mover.model = MoverModel::waypoint;
    mover.position = Vector2(0, 0);
    mover.path = {{10, 0}, {10, 10}};
    mover.loops = 1;
    mover.speed = 2;
    mover.max_turn_rate = 1;
    const Trajectory t = simulateMover(standingRobot(200), mover, 1);
    EXPECT_EQ(t.states[0].velocity, Vector2(2, 0));  // towards the first point
    double most = 0;
    int moving = 0;
    for (std::size_t k = 1; k < t.states.size() && t.states[k].velocity.norm() > 0; ++k, ++moving) {
        const Vector2 a = t.states[k - 1].velocity, b = t.states[k].velocity;
        EXPECT_NEAR(b.norm(), 2, 1e-12);
        EXPECT_NEAR((t.states[k].position - t.states[k - 1].position - 0.1 * b).norm(), 0, 1e-12);
        most = std::max(most, std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b))));
    }
    EXPECT_NEAR(most, 0.1, 1e-9);  // the corner needs more than a step: 1 rad/s * 0.1 s
    EXPECT_LT(moving, 150);
    EXPECT_LE((t.states.back().position - Vector2(10, 10)).norm(), 1);
    EXPECT_EQ(t.states.back().velocity, Vector2(0, 0));
    EXPECT_EQ(t.states.back().mode, "waypoint");
}

TEST(Mover, LeavingTheArenaDrawsTheTrajectoryAgain) {
    MoverParameters mover = straightMover(0, {0, 0}, {1, 0});
    mover.cv_acceleration_std = 1;
    const Scenario scenario = standingRobot(100);
    // A seed whose first draw leaves x <= 12: found, not assumed.
    const Box arena{-12, 12, -12, 12};
    const auto leaves = [&](const Trajectory& t) {
        for (const TrueTarget& s : t.states) {
            if (!arena.contains(s.position)) return true;
        }
        return false;
    };
    std::uint64_t seed = 1;
    while (!leaves(simulateMover(scenario, mover, seed))) ++seed;
    const Trajectory first = simulateMover(scenario, mover, seed);
    mover.arena = arena;
    const Trajectory again = simulateMover(scenario, mover, seed);
    EXPECT_FALSE(leaves(again));
    EXPECT_NE(again.states[1].velocity, first.states[1].velocity);  // a fresh draw from the first step on
    // A draw that stays inside is taken as it is.
    while (leaves([&] {
        MoverParameters free = mover;
        free.arena.reset();
        return simulateMover(scenario, free, seed);
    }())) {
        ++seed;
    }
    const Trajectory kept = simulateMover(scenario, mover, seed);
    mover.arena.reset();
    EXPECT_EQ(kept.states.back().position, simulateMover(scenario, mover, seed).states.back().position);
}

TEST(Mover, AnArenaThatCannotHoldItIsAnError) {
    MoverParameters mover = straightMover(0, {0, 0}, {10, 0});
    mover.arena = Box{-5, 5, -5, 5};
    mover.max_redraws = 20;
    EXPECT_THROW(simulateMover(standingRobot(100), mover, 1), ConfigError);
}

TEST(Mover, StartsWhereItsBoxAndSpeedsAllow) {
    MoverParameters mover;
    mover.start_box = {10, 20, -5, -4};
    mover.min_speed = 2;
    mover.max_speed = 3;
    bool left = false, right = false;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const TrueTarget start = simulateMover(standingRobot(1), mover, seed).states.front();
        ASSERT_TRUE(mover.start_box.contains(start.position));
        ASSERT_GE(start.velocity.norm(), 2 - 1e-12);
        ASSERT_LE(start.velocity.norm(), 3 + 1e-12);
        left |= start.velocity.x() < 0;
        right |= start.velocity.x() > 0;
    }
    EXPECT_TRUE(left && right);
}

}  // namespace mover_test
}  // namespace slamot::sim
