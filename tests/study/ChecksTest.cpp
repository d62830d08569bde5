#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "../../libs/study/src/CheckStatistic.h"
#include "slamot/study/Checks.h"
#include "study/Builders.h"

namespace slamot::study {
namespace checks_test {

using testing::HasSubstr;

/// Replicates 1 to `replicates` of both sources with both configs.
Plan planOf(const StudyFile& study, int replicates) {
    Plan plan;
    plan.study = study;
    plan.kinds.resize(2);
    for (PlannedWorldKind& kind : plan.kinds) kind.runs = {{0, 0, 0}, {1, 0, 0}};
    for (int replicate = 1; replicate <= replicates; ++replicate)
        for (std::uint32_t source : {0u, 1u}) {
            WorldPlan& world = plan.worlds.emplace_back();
            world.source = world.kind = source;
            world.replicate = replicate;
        }
    return plan;
}

std::string checkText(const std::string& rest) {
    return "[check.c]\nsource = paper1\nconfig = invariant\n" + rest;
}

CheckResult resultOf(const std::string& rest, const std::vector<Row>& rows, int replicates = 3,
                     bool short_form = false) {
    const StudyFile study = studyOf(checkText(rest));
    return runChecks(readAnalysis(study), planOf(study, replicates), rows, short_form).results.at(0);
}

std::vector<Row> threeWorlds() {
    return rowsOf("paper1", "classic", {2, 4, 1}) + rowsOf("paper1", "invariant", {1, 3, 5});
}

TEST(Checks, EveryStatisticOfAFigure) {
    const std::vector<std::tuple<std::string, double, std::string>> cases = {
        {"mean", 3, ""},
        {"median", 3, ""},
        {"minimum", 1, ""},
        {"maximum", 5, ""},
        {"ratio", (0.5 + 0.75 + 5) / 3, "against = classic\n"},
        {"median_ratio", 0.75, "against = classic\n"},
        {"ratio_of_means", 9.0 / 7, "against = classic\n"},
        {"mean_difference", 2.0 / 3, "against = classic\n"},
        {"median_difference", -1, "against = classic\n"},
        {"smaller", 2.0 / 3, "against = classic\n"}};
    for (const auto& [statistic, expected, more] : cases) {
        const CheckResult r = resultOf(
            "figure = robot.position.rmse\ninterval = -inf, inf\nstatistic = " + statistic + "\n" + more,
            threeWorlds());
        EXPECT_EQ(r.state, CheckState::passed) << statistic << ": " << r.reason;
        EXPECT_DOUBLE_EQ(r.value, expected) << statistic;
    }
}

TEST(Checks, StatisticsOfNees) {
    auto rows = threeWorlds();
    for (Row& row : rows)
        if (row.variant == "invariant")
            row.series["robot_nees"] = {{0, 1, 2, 3, 4}, {3, 3, 60, 3, 0.01}, {3, 3, 3, 3, 3}};
    for (const auto& [statistic, expected] : std::vector<std::pair<std::string, double>>{
             {"anees", 69.01 / 5}, {"inside", 0.6}, {"above", 0.2}, {"below", 0.2}})
        EXPECT_NEAR(
            resultOf("series = robot_nees\ninterval = 0, 1\nstatistic = " + statistic + "\n", rows).value,
            expected,
            1e-12)  // sums of five numbers
            << statistic;
    const CheckResult absent =
        resultOf("series = robot_nees\ninterval = 0, 1\nstatistic = inside\n", threeWorlds());
    EXPECT_EQ(absent.state, CheckState::failed);
    EXPECT_EQ(absent.reason, "3 of 3 runs of 'invariant' are without the series");
}

TEST(Checks, MeansOverAWindowOfTime) {
    auto rows = rowsOf("paper1", "invariant", {1, 1, 1, 1});
    const double nan = std::nan("");
    rows[0].series["robot_error"] = {{0, 1, 2, 3}, {9, 1, 2, 9}, {}};
    rows[1].series["robot_error"] = {{0, 1, 2, 3}, {9, 4, nan, 9}, {}};
    rows[2].series["robot_error"] = {{0, 1, 1.5, 2, 3}, {9, 10, 20, 30, 9}, {}};
    rows[3].series["robot_error"] = {{0, 5}, {9, 9}, {}};  // nothing in the window
    const std::string window = "series = robot_error\nwindow = 1, 2\ninterval = 0, 10\nstatistic = ";
    const CheckResult mean = resultOf(window + "window_mean\n", rows, 4);
    EXPECT_EQ(mean.state, CheckState::passed) << mean.reason;
    EXPECT_DOUBLE_EQ(mean.value, (1.5 + 4 + 20) / 3);
    EXPECT_EQ(mean.what, "mean over time of robot_error from 1 to 2 s, paper1, invariant");
    EXPECT_DOUBLE_EQ(resultOf(window + "window_median\n", rows, 4).value, 4);
    const CheckResult outside =
        resultOf("series = robot_error\nwindow = 6, 7\ninterval = 0, 10\nstatistic = window_mean\n", rows, 4);
    EXPECT_EQ(outside.state, CheckState::failed);
    EXPECT_EQ(outside.reason, "no run has the series in the window");
    EXPECT_THROW(
        readAnalysis(studyOf(checkText("series = robot_error\ninterval = 0, 10\nstatistic = window_mean\n"))),
        ConfigError)
        << "without a window";
}

TEST(Checks, FailedRunsCountForSeriesToo) {
    std::vector<Row> rows = rowsOf("paper1", "invariant", {1, 1, 1, 1});
    for (Row& row : rows) row.series["robot_nees"] = {{0, 1}, {3, 3}, {3, 3}};
    const std::string anees = "series = robot_nees\nstatistic = anees\ninterval = 2.9, 3.1\n";
    EXPECT_EQ(resultOf(anees, rows, 4).state, CheckState::passed);
    for (std::size_t i : {1u, 2u, 3u}) {
        rows[i].status = "failed";  // what it did before is still there
        rows[i].reason = "the covariance is not definite";
    }
    const CheckResult strict = resultOf(anees, rows, 4);
    EXPECT_EQ(strict.state, CheckState::failed);
    EXPECT_EQ(
        strict.reason,
        "3 of 4 runs of 'invariant' are without the series, the first since: the covariance is not definite");
    EXPECT_EQ(resultOf(anees + "missing = 0.7\n", rows, 4).state, CheckState::failed);
    const CheckResult allowed = resultOf(anees + "missing = 0.75\n", rows, 4);
    EXPECT_EQ(allowed.state, CheckState::passed);
    EXPECT_EQ(allowed.reason, strict.reason) << "a check that passed says what it left out";
}

TEST(Checks, EveryStatisticIsReadByItsNameAndSaidInWords) {
    const std::string doc = [] {
        std::ifstream in(SLAMOT_SOURCE_DIR "/doc/studies_analysis.md");
        return std::string(std::istreambuf_iterator<char>(in), {});
    }();
    std::set<std::string> words;
    for (const CheckStatistic& statistic : checkStatistics()) {
        std::string text = "interval = -inf, inf\nstatistic = " + statistic.name + "\n";
        if (statistic.ofFigure()) text += "figure = robot.position.rmse\n";
        if (statistic.ofPairs()) text += "against = classic\n";
        if (statistic.ofSeries()) text += "series = robot_nees\n";
        if (statistic.ofWindow()) text += "window = 0, 1\n";
        const CheckSpec spec = readAnalysis(studyOf(checkText(text))).checks.at(0);
        EXPECT_EQ(spec.statistic, &statistic) << statistic.name;
        words.insert(statistic.words);
        EXPECT_THAT(doc, HasSubstr("`" + statistic.name + "`"));
    }
    EXPECT_EQ(words.size(), checkStatistics().size()) << "two are called the same";
}

TEST(Checks, TheEndsBelongToTheInterval) {
    const std::string mean = "figure = robot.position.rmse\nstatistic = mean\ninterval = ";
    EXPECT_EQ(resultOf(mean + "3, 4\n", threeWorlds()).state, CheckState::passed);
    EXPECT_EQ(resultOf(mean + "2, 3\n", threeWorlds()).state, CheckState::passed);
    EXPECT_EQ(resultOf(mean + "3.0001, 4\n", threeWorlds()).state, CheckState::failed);
    EXPECT_EQ(resultOf(mean + "2, 2.9999\n", threeWorlds()).state, CheckState::failed);
}

TEST(Checks, MissingRowsFail) {
    const CheckResult r =
        resultOf("figure = robot.position.rmse\nstatistic = mean\ninterval = 0, 9\n", threeWorlds(), 5);
    EXPECT_EQ(r.state, CheckState::failed);
    EXPECT_EQ(r.reason, "2 of 5 runs of 'invariant' are missing");
    EXPECT_TRUE(std::isnan(r.value));
    auto rows = threeWorlds();
    rows.erase(rows.begin());
    EXPECT_EQ(
        resultOf("figure = robot.position.rmse\nstatistic = ratio\nagainst = classic\ninterval = 0, 9\n",
                 rows)
            .reason,
        "1 of 3 runs of 'classic' are missing");
}

TEST(Checks, RowsBeyondThePlanDoNotCount) {
    EXPECT_EQ(
        resultOf("figure = robot.position.rmse\nstatistic = mean\ninterval = 2, 2\n", threeWorlds(), 2).state,
        CheckState::passed)
        << "the mean of 1 and 3";
}

TEST(Checks, FailedRunsFailUnlessAllowed) {
    auto rows = threeWorlds();
    rows[5] = failedRow("paper1", "invariant", 3);
    const std::string mean = "figure = robot.position.rmse\nstatistic = mean\ninterval = 0, 9\n";
    const CheckResult strict = resultOf(mean, rows);
    EXPECT_EQ(strict.state, CheckState::failed);
    EXPECT_EQ(
        strict.reason,
        "1 of 3 runs of 'invariant' are without the figure, the first since: the covariance is not definite");
    EXPECT_EQ(resultOf(mean + "missing = 0.3\n", rows).state, CheckState::failed);
    EXPECT_EQ(resultOf(mean + "missing = 0.34\n", rows).state, CheckState::passed);
    const CheckResult rate = resultOf("statistic = rate\ninterval = 0, 0.3\n", rows);
    EXPECT_EQ(rate.state, CheckState::failed);
    EXPECT_DOUBLE_EQ(rate.value, 1.0 / 3);
    EXPECT_EQ(rate.reason, "");
}

TEST(Checks, ShortFormHasItsOwnIntervals) {
    const std::string mean = "figure = robot.position.rmse\nstatistic = mean\ninterval = 7, 9\n";
    const CheckResult without = resultOf(mean, threeWorlds(), 3, true);
    EXPECT_EQ(without.state, CheckState::not_checked);
    EXPECT_EQ(without.reason, "not part of the short form");
    EXPECT_EQ(resultOf(mean + "short_interval = 2, 4\n", threeWorlds(), 3, true).state, CheckState::passed);
    EXPECT_EQ(resultOf(mean + "short_interval = 2, 4\n", threeWorlds(), 3, false).state, CheckState::failed);
}

TEST(Checks, ASourceThatCannotRunFailsWithItsReason) {
    const StudyFile study = studyOf(checkText("statistic = rate\ninterval = 0, 1\n"));
    Plan plan = planOf(study, 1);
    plan.worlds.clear();
    plan.skipped = {"no mrclam_6 in SLAMOT_DATASETS"};
    const CheckResult r = runChecks(readAnalysis(study), plan, {}, false).results.at(0);
    EXPECT_EQ(r.state, CheckState::failed);
    EXPECT_EQ(r.reason, "source 'paper1' has no world here; no mrclam_6 in SLAMOT_DATASETS");
}

TEST(Checks, UnitsHoldForValuesAndDifferencesButNotRatios) {
    const std::string units = "against = classic\n[units]\nrobot.position.rmse = mm\n";
    const std::string check = "figure = robot.position.rmse\ninterval = -inf, inf\nstatistic = ";
    EXPECT_DOUBLE_EQ(resultOf(check + "mean_difference\n" + units, threeWorlds()).value, 2000.0 / 3);
    EXPECT_DOUBLE_EQ(resultOf(check + "median_ratio\n" + units, threeWorlds()).value, 0.75);
}

TEST(Checks, ReportPassesWhenNoneFailedAndOneWasChecked) {
    CheckReport report;
    EXPECT_FALSE(report.passed());
    report.results.resize(1);
    EXPECT_FALSE(report.passed()) << "nothing was checked";
    report.results.resize(2);
    report.results[0].state = CheckState::passed;
    EXPECT_TRUE(report.passed());
    report.results[1].state = CheckState::failed;
    EXPECT_FALSE(report.passed());
}

TEST(Checks, TableSaysWhatWasChecked) {
    const StudyFile study =
        studyOf(checkText("figure = robot.position.rmse\nstatistic = ratio\nagainst = classic\ninterval = 0, "
                          "0.65\nabout = the aim\n"
                          "[labels]\nrobot.position.rmse = RMSE\n"));
    const auto report = runChecks(readAnalysis(study), planOf(study, 3), threeWorlds(), false);
    const std::string text = toMarkdown(checkTable(report));
    EXPECT_THAT(text, HasSubstr("| c     | mean ratio of RMSE, paper1, invariant to classic | 2.0833 |    0 "
                                "| 0.65 | FAILED | the aim |"));
    EXPECT_EQ(toCsv(checkTable(report)),
              "check,what,value,from,to,result,about,reason\nc,\"mean ratio of RMSE, paper1, invariant to "
              "classic\",2.0833333333333335,0,0.65,FAILED,the aim,\n");
}

TEST(Checks, TerminalHasEightyColumns) {
    CheckReport report;
    report.results.push_back(
        {"c",
         "mean ratio of RMSE of the robot's position, a world with a long name, this to that",
         CheckState::failed,
         2.0833333,
         {0, 0.65},
         "",
         "the aim that was set for this one"});
    EXPECT_EQ(toTerminal(report),
              "FAILED       c\n"
              "    mean ratio of RMSE of the robot's position, a world with a long name, this\n"
              "      to that: 2.0833, expected 0 to 0.65\n"
              "    the aim that was set for this one\n");
}

}  // namespace checks_test
}  // namespace slamot::study
