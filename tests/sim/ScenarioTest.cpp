#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "Scenarios.h"
#include "slamot/sim/Scenario.h"
#include "slamot/sim/Simulation.h"
#include "support/Expect.h"
#include "support/TemporaryFolder.h"

namespace slamot::sim {
namespace scenario_test {

using ::testing::HasSubstr;

std::string errorOf(const std::string& ini) {
    try {
        loadScenario(Config::fromText(ini, "test.ini"));
    } catch (const ConfigError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Scenario, EveryDefaultWorks) {
    const Scenario scenario = loadScenario(
        Config::fromText("[robot]\n[mover.0]\n[sensor.landmarks]\n[sensor.movers]\n[sensor.other]\n"));
    ASSERT_EQ(scenario.sensors.size(), 3u);
    EXPECT_EQ(scenario.sensors[0].role, SensorRole::landmarks);
    EXPECT_EQ(scenario.sensors[1].role, SensorRole::movers);
    EXPECT_EQ(scenario.sensors[2].role, SensorRole::mixed);
    EXPECT_EQ(simulate(scenario, 1).size(), 1u);
}

TEST(Scenario, ReadsEveryFormOfValue) {
    const Scenario s = loadScenario(Config::fromText(R"(
[scenario]
about = a test
[world]
kind = loop
box = -1, 2, -3,4
[robot.0]
start_heading_deg = 90
[robot.12]
controller = pursuit
target = 5
levels = 3:0.5 inf:2
[mover.5]
model = schedule
schedule = 0:cv 2.5:ct:-30 4:unicycle
position = 1,2
arena = -9,9,-8,8
[sensor.mixed]
robots = 0, 12
true_range_std = 0.5
)"));
    EXPECT_EQ(s.about, "a test");
    EXPECT_EQ(s.world.box.x_max, 2);
    EXPECT_EQ(s.world.box.y_min, -3);
    ASSERT_EQ(s.robots.size(), 2u);
    EXPECT_EQ(s.robots[0].start_heading, radians(90));
    EXPECT_EQ(s.robots[1].number, 12);
    ASSERT_EQ(s.robots[1].levels.size(), 2u);
    EXPECT_EQ(s.robots[1].levels[0].speed, 0.5);
    EXPECT_EQ(s.robots[1].target, SourceId{5});
    ASSERT_EQ(s.movers[0].schedule.size(), 3u);
    EXPECT_EQ(s.movers[0].schedule[1].kind, TargetModelKind::ct);
    EXPECT_EQ(s.movers[0].schedule[1].turn_rate, radians(-30));
    EXPECT_FALSE(s.movers[0].schedule[2].turn_rate.has_value());
    EXPECT_EQ(s.movers[0].position, Vector2(1, 2));
    EXPECT_FALSE(s.movers[0].velocity.has_value());
    EXPECT_EQ(s.movers[0].arena->y_min, -8);
    EXPECT_EQ(s.sensors[0].robots, (std::vector<int>{0, 12}));
    EXPECT_EQ(s.sensors[0].true_range_std, 0.5);
}

TEST(Scenario, EveryParameterPrintsWhatItReads) {
    MoverParameters mover, mover_again;
    mover.schedule = {{0, TargetModelKind::cv, {}}, {2, TargetModelKind::ct, radians(15)}};
    mover.path = {{0.1, 2}, {3, -4e-3}};
    mover.position = Vector2(1, 2);
    mover.arena = Box{};
    ParameterTable from = describe(mover), to = describe(mover_again);
    for (const Parameter& parameter : from.parameters()) {
        EXPECT_EQ(to.find(parameter.key)->parse(parameter.print()), std::nullopt) << parameter.key;
        EXPECT_EQ(to.find(parameter.key)->print(), parameter.print());
    }
    EXPECT_EQ(mover_again.schedule[1].turn_rate, radians(15));
    EXPECT_EQ(mover_again.path[1], Vector2(3, -4e-3));
}

struct Mistake {
    const char *name, *ini, *said;
};

class ScenarioMistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(ScenarioMistakes, AreErrorsThatSayWhat) {
    EXPECT_THAT(errorOf(GetParam().ini), HasSubstr(GetParam().said));
}

INSTANTIATE_TEST_SUITE_P(
    All, ScenarioMistakes,
    ::testing::Values(
        Mistake{"NoRobot", "[world]\n", "has no robot"},
        Mistake{"UnknownSection", "[robot]\n[wolrd]\n", "[wolrd]"},
        Mistake{"UnknownKey", "[robot]\nstarrt = 0,0\n", "did you mean 'start'"},
        Mistake{"ZeroDuration", "[robot]\n[scenario]\nsteps = 0\n", "test.ini:3: steps = '0'"},
        Mistake{"Probability", "[robot]\n[sensor.a]\ndetection_probability = 1.2\n", "test.ini:3"},
        Mistake{"Infinite", "[robot]\nspeed = inf\n", "speed"},
        Mistake{"NoNumber", "[robot]\n[mover.x]\n", "expected a whole number"},
        Mistake{"PaddedNumber", "[robot]\n[mover.01]\n", "expected a whole number"},
        Mistake{"BothFormsOfRobot", "[robot]\n[robot.1]\n", "one of the two forms"},
        Mistake{"PointOfOneNumber", "[robot]\nstart = 1\n", "expected x,y"},
        Mistake{"BoxInsideOut", "[robot]\n[world]\nbox = 5,-5,0,1\n", "min below max"},
        Mistake{"PathWithAHole", "[robot]\npath = 0,0 1,\n", "separated by spaces"},
        Mistake{"UnknownModel", "[robot]\n[mover.0]\nschedule = 0:cw\n", "cv, ca, ct or unicycle"},
        Mistake{"TurnRateOfCv", "[robot]\n[mover.0]\nschedule = 0:cv:3\n", "time:ct:turn_rate"},
        Mistake{"NoSchedule", "[robot]\n[mover.0]\nmodel = schedule\n", "needs the key 'schedule'"},
        Mistake{"LateSchedule", "[robot]\n[mover.0]\nmodel = schedule\nschedule = 1:cv\n", "expected 0"},
        Mistake{"FallingSchedule", "[robot]\n[mover.0]\nmodel = schedule\nschedule = 0:cv 5:ca 5:cv\n",
                "rising"},
        Mistake{"NoPath", "[robot]\n[mover.0]\nmodel = waypoint\n", "needs the key 'path'"},
        Mistake{"RobotWithoutPath", "[robot]\ncontroller = waypoints\n", "needs the key 'path'"},
        Mistake{"NobodyToPursue", "[robot]\ncontroller = pursuit\ntarget = 3\n",
                "mover 3, which is not there"},
        Mistake{"LevelsOutOfOrder", "[robot]\ncontroller = pursuit\nlevels = 5:1 3:2\n[mover.0]\n", "rising"},
        Mistake{"VanishesFirst", "[robot]\n[mover.0]\nappear = 5\nvanish = 4\n", "before it appears"},
        Mistake{"Speeds", "[robot]\n[mover.0]\nmin_speed = 5\n", "min_speed above max_speed"},
        Mistake{"Ranges", "[robot]\n[sensor.a]\nmin_range = 50\n", "min_range"},
        Mistake{"Phase", "[robot]\n[sensor.a]\nphase = 1\n", "every_n_steps"},
        Mistake{"MixedIdentities", "[robot]\n[sensor.mixed]\nidentities = written\n", "share numbers"},
        Mistake{"SensorOfNobody", "[robot]\n[sensor.a]\nrobots = 2\n", "robot 2, which is not there"},
        Mistake{"NoLabel", "[robot]\n[sensor.]\n", "no label"},
        Mistake{"NoFile", "[robot]\n[world]\nkind = file\n", "needs the key 'file'"}),
    [](const auto& instance) { return instance.param.name; });

TEST(Scenario, ProgramsAreHeldToTheSameRanges) {
    Scenario scenario = standingRobot(10);
    scenario.sensors.push_back(sensorOf(SensorRole::landmarks, "landmarks"));
    EXPECT_NO_THROW(requirePossible(scenario));
    scenario.sensors[0].detection_probability = 1.2;
    EXPECT_THROW(simulate(scenario, 1), ConfigError);
    scenario.sensors[0].detection_probability = 1;
    scenario.dt = 0;
    EXPECT_THROW(simulate(scenario, 1), ConfigError);
}

TEST(Scenario, AFileWorldIsFoundBesideItsScenario) {
    const test::TemporaryFolder folder;
    folder.write("landmarks.csv", "id,x,y\n3,1,2\n");
    const std::string file =
        folder.write("scenario.ini", "[world]\nkind = file\nfile = landmarks.csv\n[robot]\n");
    const Scenario scenario = loadScenario(Config::fromFile(file));
    EXPECT_EQ(simulate(scenario, 1).at(0).truth.landmarks.at(SourceId{3}), Vector2(1, 2));
}

TEST(Scenario, PathsMayStandInFilesOfTheirOwn) {
    const test::TemporaryFolder folder;
    folder.write("way.csv", "x,y\n1,2\n3.5,-4\n");
    const auto scenarioWith = [&](const std::string& robot, const std::string& mover) {
        return loadScenario(
            Config::fromFile(folder.write("scenario.ini", "[robot]\ncontroller = waypoints\n" + robot +
                                                              "[mover.3]\nmodel = waypoint\n" + mover)));
    };
    const Scenario scenario = scenarioWith("path_file = way.csv\n", "path_file = way.csv\n");
    const std::vector<Vector2> way = {{1, 2}, {3.5, -4}};
    EXPECT_EQ(scenario.robots.at(0).path, way);
    EXPECT_EQ(scenario.movers.at(0).path, way);
    EXPECT_EQ(filesOf(scenario), (std::vector<std::string>{folder.path("way.csv"), folder.path("way.csv")}));
    EXPECT_EQ(filesOf(scenarioWith("path = 0,0\n", "path = 0,0\n")), std::vector<std::string>{});

    const auto said = [&](const std::string& robot) {
        return test::messageOf<std::runtime_error>([&] { scenarioWith(robot, "path = 0,0\n"); });
    };
    EXPECT_THAT(said("path_file = way.csv\npath = 0,0\n"),
                HasSubstr("scenario.ini:3: [robot] has both 'path' and 'path_file'"));
    EXPECT_THAT(said("path_file = gone.csv\n"), HasSubstr("gone.csv"));
    folder.write("empty.csv", "x,y\n");
    EXPECT_THAT(said("path_file = empty.csv\n"), HasSubstr("empty.csv has no points"));
    folder.write("bad.csv", "x,y\n1,nan\n");
    EXPECT_THAT(said("path_file = bad.csv\n"), HasSubstr("bad.csv:2"));
}

// The tables of doc/simulator.md are scenarioReference(): print it anew when this fails.
TEST(Scenario, TheDocumentHoldsTheReference) {
    std::ifstream file(SLAMOT_SOURCE_DIR "/doc/simulator.md");
    std::stringstream document;
    document << file.rdbuf();
    EXPECT_NE(document.str().find(scenarioReference()), std::string::npos) << scenarioReference();
}

}  // namespace scenario_test
}  // namespace slamot::sim
