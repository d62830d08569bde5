#include <gtest/gtest.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "Scenarios.h"
#include "slamot/sim/Simulation.h"

namespace slamot::sim {
namespace simulation_test {

Scenario shipped(const std::string& name) {
    return loadScenario(Config::fromFile(SLAMOT_SOURCE_DIR "/config/scenarios/" + name));
}

std::vector<double> numbersOf(const Scan& s) {
    std::vector<double> all{static_cast<double>(s.reading.stamp.ticks)};
    for (const auto& item : s.reading.items) {
        all.insert(all.end(), {item.range, item.bearing, static_cast<double>(item.id.value)});
    }
    return all;
}

/// Everything random in a log, for exact comparison; scans of one label or all.
std::vector<double> numbersOf(const SimulatedLog& log, const std::string& label = "") {
    std::vector<double> all;
    for (const TruePose& p : log.truth.robot) all.insert(all.end(), {p.pose.x, p.pose.y, p.pose.theta});
    for (const OdometryReading& o : log.odometry) all.insert(all.end(), {o.pose.x, o.pose.y, o.pose.theta});
    for (const Scan& s : log.scans) {
        if (!label.empty() && s.reading.sensor.label != label) continue;
        const std::vector<double> numbers = numbersOf(s);
        all.insert(all.end(), numbers.begin(), numbers.end());
    }
    return all;
}

TEST(Simulation, SameSeedSameLogOtherSeedOtherLog) {
    const Scenario scenario = shipped("clutter.ini");
    const std::vector<double> one = numbersOf(simulate(scenario, 1).at(0));
    EXPECT_EQ(numbersOf(simulate(scenario, 1).at(0)), one);
    EXPECT_NE(numbersOf(simulate(scenario, 2).at(0)), one);
}

TEST(Simulation, AnotherSensorLeavesTheOthersDrawsUnchanged) {
    Scenario scenario = shipped("clutter.ini");
    scenario.steps = 100;
    const SimulatedLog before = simulate(scenario, 1).at(0);
    SensorParameters more = scenario.sensors.front();
    more.label = "a_first_by_name";
    scenario.sensors.insert(scenario.sensors.begin(), more);
    const SimulatedLog after = simulate(scenario, 1).at(0);
    EXPECT_EQ(numbersOf(after, "landmarks"), numbersOf(before, "landmarks"));
    EXPECT_EQ(numbersOf(after, "movers"), numbersOf(before, "movers"));
    // The same settings under another label are other draws.
    EXPECT_NE(numbersOf(after, "a_first_by_name"), numbersOf(after, "landmarks"));
}

TEST(Simulation, AnotherRobotOrMoverLeavesTheOthersDrawsUnchanged) {
    Scenario scenario = shipped("two_robots.ini");
    scenario.steps = 100;
    const std::vector<SimulatedLog> two = simulate(scenario, 1);
    Scenario alone = scenario;
    alone.robots.erase(alone.robots.begin());
    const SimulatedLog one = simulate(alone, 1).at(0);
    EXPECT_EQ(one.robot, 1);
    EXPECT_EQ(numbersOf(one, "landmarks"), numbersOf(two.at(1), "landmarks"));
    scenario.movers.insert(scenario.movers.begin(), straightMover(77, {0, 0}, {1, 1}));
    const std::vector<SimulatedLog> more = simulate(scenario, 1);
    EXPECT_EQ(numbersOf(more.at(0), "landmarks"), numbersOf(two.at(0), "landmarks"));
    EXPECT_EQ(more.at(0).truth.targets.at(SourceId{2}).back().position,
              two.at(0).truth.targets.at(SourceId{2}).back().position);
}

TEST(Simulation, RobotsSeeEachOtherWhenEnabled) {
    Scenario scenario = shipped("two_robots.ini");
    scenario.steps = 50;
    const auto seen = [](const SimulatedLog& log, std::int64_t id) {
        std::size_t count = 0;
        for (const TrueAssociation& a : log.truth.associations) count += a.id.value == id;
        return count;
    };
    for (SensorParameters& sensor : scenario.sensors) sensor.max_range = 1000;
    const std::vector<SimulatedLog> logs = simulate(scenario, 1);
    EXPECT_EQ(seen(logs.at(0), 1000001), 26u);  // every second of the steps 0..50, all round, no misses
    EXPECT_EQ(seen(logs.at(0), 1000000), 0u);
    EXPECT_EQ(seen(logs.at(1), 1000000), 26u);
    EXPECT_EQ(logs.at(0).truth.targets.count(SourceId{1000001}), 1u);
    EXPECT_EQ(logs.at(0).truth.targets.count(SourceId{1000000}), 0u);
    EXPECT_EQ(logs.at(0).truth.targets.at(SourceId{1000001}).back().position,
              logs.at(1).truth.robot.back().pose.position());
    scenario.robots_see_each_other = false;
    EXPECT_EQ(seen(simulate(scenario, 1).at(0), 1000001), 0u);
}

TEST(Simulation, SensorsKeepTheirRateAndPhaseAndRobots) {
    Scenario scenario = standingRobot(10);
    scenario.robots.push_back(scenario.robots.front());
    scenario.robots.back().number = 3;
    SensorParameters sensor = sensorOf(SensorRole::landmarks, "landmarks");
    sensor.every_n_steps = 4;
    sensor.phase = 1;
    sensor.robots = {3};
    scenario.sensors.push_back(sensor);
    const std::vector<SimulatedLog> logs = simulate(scenario, 1);
    EXPECT_TRUE(logs.at(0).scans.empty());
    ASSERT_EQ(logs.at(1).scans.size(), 3u);  // steps 1, 5, 9
    EXPECT_EQ(logs.at(1).scans[1].reading.stamp, scenario.stampOfStep(5));
}

TEST(Simulation, ObservationsAreInLogOrderAndAssociationsCountThem) {
    Scenario scenario = shipped("demo.ini");
    scenario.steps = 100;
    const SimulatedLog log = simulate(scenario, 1).at(0);
    const auto observations = log.observations();
    ASSERT_EQ(observations.size(), log.odometry.size() + log.scans.size());
    Stamp last{0};
    int rank = 0, index = 0;
    std::size_t association = 0;
    for (const auto& observation : observations) {
        const Stamp stamp = toStamp(observation->timestamp);
        ASSERT_GE(stamp, last);
        if (stamp != last) rank = index = 0;
        last = stamp;
        const std::string& label = observation->sensorLabel;
        const int its_rank = label == "odometry" ? 1 : label == "landmarks" ? 2 : 3;
        ASSERT_GT(its_rank, rank);
        rank = its_rank;
        if (its_rank == 1) continue;
        const auto& scan = dynamic_cast<const mrpt::obs::CObservationBearingRange&>(*observation);
        for (const auto& item : scan.sensedData) {
            const TrueAssociation& a = log.truth.associations.at(association++);
            ASSERT_EQ(a.stamp, stamp);
            ASSERT_EQ(a.index, index++);
            ASSERT_EQ(a.id.value, item.landmarkID);
        }
    }
    EXPECT_EQ(association, log.truth.associations.size());
    EXPECT_GT(association, 100u);
}

TEST(Simulation, ObservationsCarryTheSensorsClaims) {
    Scenario scenario = standingRobot(1);
    scenario.world.landmarks = 20;
    SensorParameters sensor = sensorOf(SensorRole::landmarks, "landmarks");
    sensor.range_std = 0.25;
    sensor.bearing_std = 0.5;
    sensor.min_range = 0.5;
    sensor.max_range = 64;
    sensor.field_of_view = 3;
    scenario.sensors.push_back(sensor);
    const SimulatedLog log = simulate(scenario, 1).at(0);
    const auto observations = log.observations();
    const auto& scan = dynamic_cast<const mrpt::obs::CObservationBearingRange&>(*observations.at(1));
    EXPECT_EQ(scan.sensor_std_range, 0.25f);
    EXPECT_EQ(scan.sensor_std_yaw, 0.5f);
    EXPECT_EQ(scan.minSensorDistance, 0.5f);
    EXPECT_EQ(scan.maxSensorDistance, 64.f);
    EXPECT_EQ(scan.fieldOfView_yaw, 3.f);
    EXPECT_FALSE(scan.validCovariances);
    ASSERT_FALSE(scan.sensedData.empty());
    // The rawlog keeps floats, the log's own values are doubles.
    EXPECT_EQ(scan.sensedData[0].range, static_cast<float>(log.scans[0].reading.items[0].range));
    const auto& odometry = dynamic_cast<const mrpt::obs::CObservationOdometry&>(*observations.at(0));
    EXPECT_TRUE(odometry.hasVelocities);
}

TEST(Simulation, ProgressRisesToOneAndCanStop) {
    const Scenario scenario = standingRobot(100);
    double last = 0;
    EXPECT_EQ(simulate(scenario, 1,
                       [&](double done) {
                           EXPECT_GT(done, last);
                           last = done;
                           return true;
                       })
                  .size(),
              1u);
    EXPECT_DOUBLE_EQ(last, 1);
    EXPECT_TRUE(simulate(scenario, 1, [](double done) { return done < 0.5; }).empty());
}

TEST(Simulation, PaperOneIsAsTheGoldenRunHasIt) {
    const Scenario scenario = shipped("paper1.ini");
    const SimulatedLog log = simulate(scenario, 7).at(0);
    EXPECT_EQ(log.truth.landmarks.size(), 800u);
    EXPECT_EQ(log.truth.robot.size(), 201u);
    EXPECT_EQ(log.scans.size(), 402u);  // landmarks and movers, steps 0..200
    EXPECT_EQ(secondsBetween(log.odometry[0].stamp, log.odometry[1].stamp), 0.15);
    const std::vector<TrueTarget>& target = log.truth.targets.at(SourceId{0});
    EXPECT_EQ(target[0].position, Vector2(20, 8));
    EXPECT_EQ(target[0].velocity, Vector2(3, 0.5));
    EXPECT_EQ(target[100].mode, "cv");
    EXPECT_EQ(target[101].mode, "ca");
    for (const TrueTarget& t : target) EXPECT_LE(t.position.cwiseAbs().maxCoeff(), 245);
    const SensorParameters& sensor = scenario.sensors[0];
    EXPECT_NEAR(sensor.bearing_std, 0.05, 1e-16);
    EXPECT_NEAR(scenario.robots[0].motion.steering_std, 0.25, 1e-16);
    EXPECT_DOUBLE_EQ(0.5 * sensor.field_of_view, pi / 2);
    // The first command of the golden run: 10 m/s towards (20, 8) from the origin.
    const SteeredControl u = bodyToSteered(*log.odometry[1].velocity);
    EXPECT_NEAR(u.v, 10, 1e-12);
    EXPECT_NEAR(u.gamma, 0.380506377112, 1e-11);
}

TEST(Simulation, QuietIsPaperOneWithLessBearingNoise) {
    const Scenario quiet = shipped("quiet.ini");
    EXPECT_NEAR(quiet.sensors[0].bearing_std, 0.01, 1e-17);
    Scenario paper1 = shipped("paper1.ini");
    const SimulatedLog a = simulate(paper1, 3).at(0), b = simulate(quiet, 3).at(0);
    EXPECT_EQ(a.truth.robot.back().pose.vector(), b.truth.robot.back().pose.vector());  // paired
}

class Shipped : public ::testing::TestWithParam<const char*> {};

TEST_P(Shipped, ScenarioGivesALogWithDetectionsOfEverySensor) {
    const Scenario scenario = shipped(GetParam());
    const std::vector<SimulatedLog> logs = simulate(scenario, 1);
    ASSERT_EQ(logs.size(), scenario.robots.size());
    for (const SimulatedLog& log : logs) {
        EXPECT_EQ(log.truth.robot.size(), static_cast<std::size_t>(scenario.steps) + 1);
        std::map<std::string, std::size_t> seen;
        for (const Scan& s : log.scans) seen[s.reading.sensor.label] += s.reading.items.size();
        for (const SensorParameters& sensor : scenario.sensors) EXPECT_GT(seen[sensor.label], 100u);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Shipped,
                         ::testing::Values("paper1.ini", "quiet.ini", "demo.ini", "two_robots.ini",
                                           "clutter.ini", "loop_600m.ini", "paper1_clutter.ini",
                                           "crossing.ini", "pairs.ini", "paper2.ini", "paper4.ini",
                                           "rfs_world.ini"),
                         [](const auto& instance) {
                             const std::string name = instance.param;
                             return name.substr(0, name.find('.'));
                         });

}  // namespace simulation_test
}  // namespace slamot::sim
