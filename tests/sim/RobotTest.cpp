#include <gtest/gtest.h>

#include "Scenarios.h"
#include "slamot/core/models/RobotMotion.h"
#include "slamot/sim/Robot.h"

namespace slamot::sim {
namespace robot_test {

RobotRun run(const Scenario& scenario, std::uint64_t seed = 1) {
    return simulateRobot(scenario, scenario.robots.front(), {}, {}, seed);
}

/// A robot at a constant command for n steps of 0.1 s.
Scenario driving(int n, RobotMotionModel model, double speed, double steering, double turn_rate) {
    Scenario scenario = standingRobot(n);
    RobotParameters& robot = scenario.robots.front();
    robot.motion.model = model;
    robot.motion.wheelbase = 2;
    robot.motion.turn_rate_std = 0;
    robot.motion.along_std_per_sqrt_m = robot.motion.across_std_per_sqrt_m = 0;
    robot.motion.heading_std_per_sqrt_m = robot.motion.heading_std_per_sqrt_rad = 0;
    robot.speed = speed;
    robot.steering = steering;
    robot.turn_rate = turn_rate;
    return scenario;
}

TEST(Robot, OneSteeredStepByHand) {
    // Paper 1, eq. 1: v dt = 0.2 along the course 0.3 rad, heading += 0.2/2 sin(0.3).
    const RobotRun r = run(driving(1, RobotMotionModel::steered, 2, 0.3, 0));
    EXPECT_NEAR(r.poses[1].x, 0.2 * std::cos(0.3), 1e-15);
    EXPECT_NEAR(r.poses[1].y, 0.2 * std::sin(0.3), 1e-15);
    EXPECT_NEAR(r.poses[1].theta, 0.1 * std::sin(0.3), 1e-15);
    const SteeredControl u = bodyToSteered(*r.odometry[1].velocity);
    EXPECT_NEAR(u.v, 2, 1e-14);
    EXPECT_NEAR(u.gamma, 0.3, 1e-15);
}

TEST(Robot, ArcModelDrivesAnExactCircle) {
    // A quarter circle in 10 steps of 0.1 s at w = pi/2, v = 1: radius 2/pi.
    const RobotRun r = run(driving(10, RobotMotionModel::arc, 1, 0, pi / 2));
    EXPECT_NEAR(r.poses.back().x, 2 / pi, 1e-12);
    EXPECT_NEAR(r.poses.back().y, 2 / pi, 1e-12);
    EXPECT_NEAR(r.poses.back().theta, pi / 2, 1e-12);
}

TEST(Robot, OdometryIsTheCommandDeadReckonedFromZero) {
    Scenario scenario = driving(50, RobotMotionModel::steered, 2, 0.1, 0);
    RobotParameters& robot = scenario.robots.front();
    robot.start = {7, -3};
    robot.start_heading = 1;
    robot.motion.speed_std = 0.5;
    const RobotRun noisy = run(scenario);
    robot.start = {0, 0};
    robot.start_heading = 0;
    robot.motion.speed_std = 0;
    const RobotRun exact = run(scenario);
    ASSERT_EQ(noisy.odometry.size(), 51u);
    for (std::size_t k = 0; k < noisy.odometry.size(); ++k) {
        EXPECT_EQ(noisy.odometry[k].stamp, scenario.stampOfStep(static_cast<int>(k)));
        EXPECT_EQ(noisy.odometry[k].pose.vector(), exact.poses[k].vector());
    }
    EXPECT_EQ(noisy.poses[0].vector(), Vector3(7, -3, 1));
    EXPECT_NE(noisy.poses[1].vector(), exact.poses[1].vector());
    EXPECT_EQ(noisy.odometry[0].velocity->vx, 0);  // it stood before the start
}

// From a step the control comes back: v = |dp|/dt, gamma = course - heading (v is 10 standard deviations
// above 0).
TEST(Robot, SteeredNoiseHasItsStandardDeviations) {
    const int n = 5000;
    Scenario scenario = driving(n, RobotMotionModel::steered, 10, 0.05, 0);
    scenario.robots.front().motion.speed_std = 1;
    scenario.robots.front().motion.steering_std = 0.25;
    const RobotRun r = run(scenario);
    Vector2 sum = Vector2::Zero(), squares = Vector2::Zero();
    for (int k = 1; k <= n; ++k) {
        const Vector2 dp = r.poses[k].position() - r.poses[k - 1].position();
        const Vector2 e(dp.norm() / 0.1 - 10,
                        angleDifference(std::atan2(dp.y(), dp.x()), r.poses[k - 1].theta) - 0.05);
        sum += e;
        squares += e.cwiseProduct(e);
    }
    const Vector2 expected(1, 0.25);
    for (int i = 0; i < 2; ++i) {  // 4 standard errors: false alarm 6e-5 each
        EXPECT_NEAR(sum[i] / n, 0, 4 * expected[i] / std::sqrt(n));
        EXPECT_NEAR(std::sqrt(squares[i] / n), expected[i], 4 * expected[i] / std::sqrt(2.0 * n));
    }
}

// The noise of the arc model is what an estimator with the same parameters expects: predictMotion's Q.
TEST(Robot, ArcNoiseAgreesWithTheEstimatorsModel) {
    const int n = 5000;
    Scenario scenario = driving(1, RobotMotionModel::arc, 5, 0, 1.0);
    RobotMotionParameters& motion = scenario.robots.front().motion;
    motion.along_std_per_sqrt_m = 0.1;
    motion.across_std_per_sqrt_m = 0.05;
    motion.heading_std_per_sqrt_m = 0.03;
    motion.heading_std_per_sqrt_rad = 0.14;
    OdometryIncrement increment;
    Matrix3 scatter = Matrix3::Zero();
    for (int i = 0; i < n; ++i) {
        const RobotRun r = run(scenario, static_cast<std::uint64_t>(i));
        increment = {
            r.odometry[0].stamp, r.odometry[1].stamp, r.odometry[1].pose, r.odometry[1].velocity, {}, 0.1};
        const Vector3 e = r.poses[1].vector() - r.odometry[1].pose.vector();
        scatter += e * e.transpose() / n;
    }
    const Matrix3 Q = predictMotion(motion, Vector3::Zero(), increment).Q;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            // Standard error of a covariance entry: sqrt((Q_ii Q_jj + Q_ij^2)/n); 4.5 of them: 7e-6, nine
            // entries.
            const double error = std::sqrt((Q(i, i) * Q(j, j) + Q(i, j) * Q(i, j)) / n);
            EXPECT_NEAR(scatter(i, j), Q(i, j), 4.5 * error) << i << j;
        }
    }
}

TEST(Robot, CommandsMayHoldForSeveralSteps) {
    Scenario scenario = driving(10, RobotMotionModel::steered, 10, 0, 0);
    scenario.robots.front().motion.speed_std = 1;
    scenario.robots.front().control_every_n_steps = 4;
    const RobotRun r = run(scenario);
    ASSERT_EQ(r.odometry.size(), 4u);  // steps 0, 4, 8 and the last, 10
    EXPECT_EQ(r.odometry[3].stamp, scenario.stampOfStep(10));
    const auto path = [&](int k) { return (r.poses[k].position() - r.poses[k - 1].position()).norm(); };
    EXPECT_NEAR(path(1), path(4), 1e-12);  // one draw of noise holds as long as its command
    EXPECT_GT(std::abs(path(4) - path(5)), 1e-6);
    EXPECT_NEAR(r.odometry[1].pose.x, 4.0, 1e-12);
}

TEST(Robot, PursuesItsMover) {
    Scenario scenario = standingRobot(400);
    RobotParameters& robot = scenario.robots.front();
    robot.controller = ControllerKind::pursuit;
    robot.target = SourceId{2};
    const MoverParameters mover = straightMover(2, {30, 20}, {1, 0});
    const Trajectory target = simulateMover(scenario, mover, 1);
    const RobotRun r = simulateRobot(scenario, robot, {}, {target}, 1);
    EXPECT_LT((r.poses.back().position() - target.states.back().position).norm(), 10);
    EXPECT_GT((r.poses.front().position() - target.states.front().position).norm(), 30);
}

TEST(Robot, FollowsTheCentreLineOfALoopWorld) {
    Scenario scenario = standingRobot(420);
    scenario.world.kind = WorldKind::loop;
    scenario.world.length = 200;
    RobotParameters& robot = scenario.robots.front();
    robot.controller = ControllerKind::waypoints;
    robot.speed = 5;
    const World world = makeWorld(scenario.world, 1);
    const RobotRun r = simulateRobot(scenario, robot, world, {}, 1);
    const double radius = 200 / (2 * pi);
    for (const Pose2& pose : r.poses) EXPECT_NEAR((pose.position() - Vector2(0, radius)).norm(), radius, 1);
    EXPECT_LT(r.poses.back().position().norm(), 3);  // 200 m take 40 s; then it stands
    EXPECT_EQ(r.poses.back().vector(), r.poses[410].vector());
}

TEST(Robot, IsAMoverToItsTeamMates) {
    Scenario scenario = driving(3, RobotMotionModel::steered, 2, 0, 0);
    scenario.robots.front().number = 4;
    const RobotRun r = run(scenario);
    const Trajectory t = asMover(scenario, scenario.robots.front(), r);
    EXPECT_EQ(t.id, SourceId{1000004});
    ASSERT_EQ(t.states.size(), 4u);
    EXPECT_EQ(t.states[0].velocity, Vector2(0, 0));
    EXPECT_NEAR((t.states[3].velocity - Vector2(2, 0)).norm(), 0, 1e-12);
    EXPECT_NEAR((t.states[3].position - Vector2(0.6, 0)).norm(), 0, 1e-12);
    EXPECT_TRUE(std::isnan(t.states[3].acceleration.x()));
}

}  // namespace robot_test
}  // namespace slamot::sim
