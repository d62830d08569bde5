#include <gtest/gtest.h>

#include "slamot/rawlog/CsvTable.h"
#include "slamot/sim/Controller.h"

namespace slamot::sim {
namespace controller_test {

const std::vector<SpeedLevel> paper1_levels{{3, 0.5}, {10, 3}, {20, 6}, {40, 10}, {1e9, 15}};

// Row k of the golden run holds the true states after step k and the command over (k-1, k]: the law, fed with
// the states of row k-1, gives the command of row k. The file has 12 digits: positions to 1e-10 at a distance
// of some metres give angles to about 1e-10.
TEST(Pursuit, ReproducesTheCommandsOfTheGoldenRun) {
    CsvReader truth(SLAMOT_SOURCE_DIR "/tests/data/golden/paper1/truth.csv");
    const auto number = [&](const char* name) { return truth.number(truth.column(name)); };
    ASSERT_TRUE(truth.next());
    Pose2 robot{number("xR"), number("yR"), number("thR")};
    Vector2 target(number("xT"), number("yT"));
    int rows = 0;
    for (; truth.next(); ++rows) {
        const Steering u = pursue(robot, target, paper1_levels, radians(30));
        ASSERT_NEAR(u.speed, number("u_v"), 1e-12) << "row " << rows;
        ASSERT_NEAR(u.angle, number("u_gamma"), 1e-9) << "row " << rows;
        robot = {number("xR"), number("yR"), number("thR")};
        target = {number("xT"), number("yT")};
    }
    EXPECT_EQ(rows, 200);
}

TEST(Pursuit, SpeedIsThatOfTheFirstLevelAboveTheDistance) {
    const auto speedAt = [](double distance) {
        return pursue({}, {distance, 0}, paper1_levels, radians(30)).speed;
    };
    EXPECT_EQ(speedAt(2.99), 0.5);
    EXPECT_EQ(speedAt(3), 3);
    EXPECT_EQ(speedAt(39.9), 10);
    EXPECT_EQ(speedAt(40), 15);
    EXPECT_EQ(speedAt(2e9), 15);  // beyond the last level its speed holds
}

TEST(SteeringTowards, IsLimitedAndTakesTheShortWayRound) {
    EXPECT_DOUBLE_EQ(steeringTowards({}, {1, 0.5}, radians(30)), std::atan2(0.5, 1.0));  // 26.6 deg
    EXPECT_DOUBLE_EQ(steeringTowards({}, {0, 1}, radians(30)), radians(30));
    EXPECT_DOUBLE_EQ(steeringTowards({}, {0, -1}, radians(30)), radians(-30));
    // Heading 170 deg, goal at -170 deg: 20 deg to the left, across +-180 deg.
    const Vector2 goal(std::cos(radians(-170)), std::sin(radians(-170)));
    EXPECT_NEAR(steeringTowards({0, 0, radians(170)}, goal, radians(30)), radians(20), 1e-12);
}

TEST(Controller, ConstantGivesSteeringToSteeredRobotsAndTurnRateToOthers) {
    RobotParameters robot;
    robot.speed = 2;
    robot.steering = 0.1;
    robot.turn_rate = 0.3;
    EXPECT_EQ(Controller(robot, {}).command({}, {}), Vector2(2, 0.1));
    robot.motion.model = RobotMotionModel::differential;
    EXPECT_EQ(Controller(robot, {}).command({}, {}), Vector2(2, 0.3));
}

TEST(Controller, StandsWhileThePursuedMoverIsNotThere) {
    RobotParameters robot;
    robot.controller = ControllerKind::pursuit;
    EXPECT_EQ(Controller(robot, {}).command({}, std::nullopt), Vector2(0, 0));
    EXPECT_EQ(Controller(robot, {}).command({}, Vector2(5, 0)), Vector2(3, 0));
}

TEST(Controller, UnsteeredRobotsTurnAsTheWheelbaseWouldHaveIt) {
    RobotParameters robot;
    robot.motion.model = RobotMotionModel::arc;
    robot.motion.wheelbase = 4;
    robot.controller = ControllerKind::waypoints;
    robot.speed = 2;
    robot.path = {{0, 100}};
    // To the left at the limit of 30 deg: omega = v sin(30 deg) / B = 2 * 0.5 / 4.
    const Vector2 u = Controller(robot, {}).command({}, {});
    EXPECT_EQ(u.x(), 2);
    EXPECT_NEAR(u.y(), 0.25, 1e-15);
}

TEST(Controller, WaypointsEndInAStandstill) {
    RobotParameters robot;
    robot.controller = ControllerKind::waypoints;
    robot.path = {{10, 0}};
    robot.loops = 1;
    Controller controller(robot, {});
    EXPECT_EQ(controller.command({0, 0, 0}, {}), Vector2(1, 0));
    EXPECT_EQ(controller.command({9, 0, 0}, {}), Vector2(0, 0));  // within the reach of 2 m
}

}  // namespace controller_test
}  // namespace slamot::sim
