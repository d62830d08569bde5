#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "Builders.h"
#include "slamot/eval/Metrics.h"

namespace slamot::eval {
namespace metrics_test {

using testing::HasSubstr;

/// Ten seconds with the robot 1 m off in y, one landmark off by 0.5 m, one target off by 2 m.
struct Case {
    RunRecord run;
    Truth truth;

    Case() {
        for (int i = 0; i <= 10; ++i) {
            run.trajectory.push_back(row(i, i, 1, 0, Matrix3::Identity()));
            run.tracks[at(i)] = {track(0, 7, i + 2.0, 0)};
            truth.robot.push_back(truePose(i, i, 0, 0));
            truth.targets[SourceId{7}].push_back(trueTarget(i, i, 0));
            truth.associations.push_back({at(i), 0, "mover", SourceId{7}});
        }
        run.landmarks = {landmark(0, 3, 0.5, 0)};
        truth.landmarks[SourceId{3}] = {0, 0};
        run.innovations = {
            innovation(1, "a sensor with a rather long label", ObjectKind::mover, Outcome::updated, 1, 0)};
    }
};

TEST(Evaluate, PutsAllTogether) {
    const Case c;
    const Metrics m = evaluate(c.run, c.truth, {});
    EXPECT_EQ(m.matching.matched, 11);
    EXPECT_DOUBLE_EQ(m.robot->position.rmse, 1);
    // A shift is all the error there is.
    EXPECT_NEAR(m.ate->position.rmse, 0, 1e-12);
    EXPECT_NEAR(m.rpe->position.rmse, 0, 1e-12);
    EXPECT_NEAR(m.robot_nees->average, 1, 1e-12);
    EXPECT_DOUBLE_EQ(m.landmarks->position.rmse, 0.5);
    EXPECT_DOUBLE_EQ(m.targets->all.position.rmse, 2);
    // Relative to the robot the target is at (2, -1) instead of (0, 0).
    EXPECT_DOUBLE_EQ(m.targets->all.relative_position.rmse, std::sqrt(5.0));
    EXPECT_EQ(m.targets->seen->position.count, 1);
    EXPECT_NEAR(m.track_set->mean.ospa.total, 2, 1e-12);
    EXPECT_DOUBLE_EQ(m.landmark_set->gospa.total, 0.5);
    EXPECT_EQ(m.nis->size(), 1u);
    // The one detection of the run went into the one track.
    EXPECT_EQ(m.association->movers.recall, 1);
    EXPECT_EQ(m.map_cardinality->error, 0);
    EXPECT_EQ(m.map_cardinality->seen->error, 1);
    // 2 m is just within the gate.
    EXPECT_EQ(m.tracking->clear.mota, 1);
    EXPECT_DOUBLE_EQ(m.tracking->clear.motp, 2);
    EXPECT_EQ(m.tracking_seen->identity.idf1, 1);
    EXPECT_DOUBLE_EQ(m.tracking->trajectories.per_stamp, 2);
}

TEST(Evaluate, RobotNeesWrapsTheHeading) {
    // 3.1 against -3.1: 2 pi - 6.2 apart, squared over a variance of 1.
    const NeesSeries series = robotNees({{at(0), {{0, 0, 3.1}, Matrix3::Identity()}, {0, 0, -3.1}}});
    EXPECT_NEAR(series[0].squared.value, (2 * pi - 6.2) * (2 * pi - 6.2), 1e-14);
}

TEST(Evaluate, ATruthWithoutHeadingsAllowsWhatPositionsTell) {
    Case c;
    for (TruePose& p : c.truth.robot) p.pose.theta = std::nan("");
    const Metrics m = evaluate(c.run, c.truth, {});
    EXPECT_DOUBLE_EQ(m.robot->position.rmse, 1);
    EXPECT_EQ(m.robot->heading.count, 0);
    EXPECT_NEAR(m.ate->position.rmse, 0, 1e-12);
    // 1 m over a variance of 1, now of two dimensions.
    EXPECT_NEAR(m.robot_nees->average, 1, 1e-12);
    EXPECT_EQ(m.robot_nees->mean_dimension, 2);
    EXPECT_EQ(m.rpe.whyAbsent(), "truth has no headings, without which no pose is relative to another");
    EXPECT_EQ(m.targets->all.relative_position.count, 0);
    EvaluationOptions options;
    options.alignment = Alignment::first_pose;
    EXPECT_EQ(evaluate(c.run, c.truth, options).ate.whyAbsent(),
              "the first true pose has no heading to be aligned by");
}

TEST(Evaluate, RefusesTrajectoryMetricsTogether) {
    Case c;
    for (TruePose& p : c.truth.robot) p.stamp = later(p.stamp, 1e6);
    const Metrics m = evaluate(c.run, c.truth, {});
    for (const std::string& why :
         {m.robot.whyAbsent(), m.ate.whyAbsent(), m.rpe.whyAbsent(), m.robot_nees.whyAbsent()})
        EXPECT_THAT(why, HasSubstr("0 of 11 estimates have a truth"));
    EXPECT_TRUE(m.targets);
}

TEST(ToJson, HasNumbersAndReasons) {
    Case c;
    for (RobotRow& r : c.run.trajectory) r.robot.covariance.setZero();
    c.run.landmarks.clear();
    c.run.innovations[0].innovation.track = {};
    for (auto& [id, states] : c.truth.targets)
        for (TrueTarget& s : states) s.velocity.setConstant(std::nan(""));
    const nlohmann::json j = toJson(evaluate(c.run, c.truth, {}));
    EXPECT_EQ(j["matching"]["matched"], 11);
    EXPECT_EQ(j["robot"]["position"]["rmse"], 1.0);
    EXPECT_EQ(j["ate"]["alignment"], "se2");
    EXPECT_EQ(j["options"]["alignment"], "se2");
    EXPECT_EQ(j["nis"][0]["outcomes"]["updated"], 1);
    EXPECT_EQ(j["targets"]["by_target"]["7"]["position"]["count"], 11);
    EXPECT_TRUE(j["targets"]["all"]["velocity"]["rmse"].is_null());
    EXPECT_EQ(j["tracking"]["all"]["mota"], 1.0);
    EXPECT_EQ(j["tracking"]["all"]["tgospa"]["switches"], 0.0);
    EXPECT_EQ(j["tracking"]["seen"]["cardinality"]["absolute_error"], 0.0);
    EXPECT_EQ(j["association"]["movers"]["recall"], 0.0);
    EXPECT_TRUE(j["association"]["movers"]["precision"].is_null());
    EXPECT_EQ(j["absent"]["map_cardinality"], "the run has no landmarks");
    EXPECT_FALSE(j.contains("robot_nees"));
    EXPECT_THAT(j["absent"]["robot_nees"].get<std::string>(), HasSubstr("zero, which means it is not known"));
    EXPECT_EQ(j["absent"]["landmarks"], "the run has no landmarks");
    c.truth.associations.clear();
    c.truth.targets.clear();
    const nlohmann::json without = toJson(evaluate(c.run, c.truth, {}));
    EXPECT_FALSE(without.contains("tracking"));
    EXPECT_EQ(without["absent"]["tracking.all"], "truth has no targets");
    EXPECT_EQ(without["absent"]["tracking.seen"], "truth has no targets");
    EXPECT_EQ(without["absent"]["association"], "truth has no associations");
}

void expectNarrow(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << line;
}

TEST(SummaryTable, FitsEightyColumnsWithAllAndWithNothing) {
    const Case c;
    const std::string full = summaryTable(evaluate(c.run, c.truth, {}));
    expectNarrow(full);
    EXPECT_THAT(full, HasSubstr("ATE, aligned: se2 [m]"));
    EXPECT_THAT(full, HasSubstr("Robot: 11 of the 11 estimates within truth's span matched; 11 in all."));
    EXPECT_THAT(full, HasSubstr("targets, while seen [m]"));
    EXPECT_THAT(full, HasSubstr("Landmarks in the map: 1, +0 against all, +1 against those seen."));
    EXPECT_THAT(full,
                HasSubstr("movers                            100.0 %  100.0 %        1        1        0\n"));
    EXPECT_THAT(full,
                HasSubstr("all targets                       100.0 %        2        0        0        0\n"));
    EXPECT_THAT(full,
                HasSubstr("targets while seen                100.0 %  100.0 %  100.0 %        0      1/0\n"));
    EXPECT_THAT(full,
                HasSubstr("all targets                             2        0    exact        0        0\n"));
    EXPECT_THAT(full, testing::Not(HasSubstr("No ")));
    const std::string nothing = summaryTable(evaluate({}, {}, {}));
    expectNarrow(nothing);
    EXPECT_THAT(nothing, HasSubstr("No robot errors, ATE, RPE, robot NEES: the run has no trajectory."));
}

TEST(SummaryTable, WideNumbersStayApart) {
    Case c;
    for (RobotRow& r : c.run.trajectory) r.robot.mean.x -= 1.23456e7;
    const std::string text = summaryTable(evaluate(c.run, c.truth, {}));
    expectNarrow(text);
    // 1.23456e7 in the eight characters of a cell, one blank before it; every number of the row.
    EXPECT_THAT(text,
                HasSubstr("robot position [m]               1.23e+07 1.23e+07 1.23e+07 1.23e+07       11\n"));
}

TEST(Options, DefaultsAreLegalAndRoundTrip) {
    EvaluationOptions options;
    const ParameterTable table = describe(options);
    EXPECT_EQ(table.section(), "eval");
    for (const Parameter& p : table.parameters()) EXPECT_FALSE(p.parse(p.print())) << p.key;
    EXPECT_TRUE(table.find("set_order")->parse("0.5"));
    EXPECT_FALSE(table.find("alignment")->parse("first_pose"));
    EXPECT_EQ(options.alignment, Alignment::first_pose);
}

}  // namespace metrics_test
}  // namespace slamot::eval
