#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "slamot/study/AnalysisFile.h"
#include "study/Builders.h"
#include "support/Expect.h"
#include "support/TemporaryFolder.h"

namespace slamot::study {
namespace analysis_file_test {

using test::messageOf;
using testing::ElementsAre;
using testing::HasSubstr;

Analysis analysisOf(const std::string& text) {
    return readAnalysis(studyOf(text));
}

/// What is said of a file; the grid has `ekf.gate` in two values and `sensor.std` in two.
std::string refusal(const std::string& text) {
    StudyFile study = studyOf(text);
    study.config_grid = {{{"ekf.gate", "3"}}, {{"ekf.gate", "wide"}}};
    study.scenario_grid = {{{"sensor.std", "0.1"}}, {{"sensor.std", "0.2"}}};
    return messageOf<ConfigError>([&] { readAnalysis(study); });
}

TEST(Units, FitWhatAFigureMeasuresAndItsOwnUnit) {
    const auto factor = [](const std::string& figure, const std::string& unit) {
        const StudyFile study = studyOf("[table.t]\nkind = means\nfigures = " + figure + "\n[units]\n" +
                                        figure + " = " + unit + "\n");
        return readAnalysis(study).factor(figure);
    };
    EXPECT_DOUBLE_EQ(factor("robot.position.rmse", "mm"), 1000);
    EXPECT_DOUBLE_EQ(factor("targets.by_target.7.relative_position.median", "km"), 1e-3);
    EXPECT_DOUBLE_EQ(factor("landmark_set.gospa.total", "cm"), 100);
    EXPECT_DOUBLE_EQ(factor("ate.heading.maximum", "mrad"), 1000);
    EXPECT_DOUBLE_EQ(factor("nis.landmarks.landmark.inside", "%"), 100);
    EXPECT_DOUBLE_EQ(factor("cost.wall_s", "ms"), 1000);
    EXPECT_DOUBLE_EQ(factor("cost.step_ms_p99", "us"), 1000) << "it is in milliseconds itself";
    EXPECT_DOUBLE_EQ(factor("cost.step_cpu_ms_mean", "s"), 1e-3);
}

TEST(AnalysisFile, ReadsWhatIsThereInTheOrderOfTheFile) {
    const Analysis a = analysisOf(R"([table.second]
kind = runs
figures = robot.position.rmse
statistic = mean
[table.a_first]
kind = paired
figures = robot_nees.average, cost.step_ms_mean
baseline = classic
sources = quiet
configs = invariant
digits = 4
caption = Differences, by world.
[figure.f]
kind = bands
series = robot_nees
logarithmic = x,y
[check.c]
source = paper1
config = invariant
against = classic
statistic = ratio
figure = robot.position.rmse
interval = -inf, 0.65
short_interval = 0.1, 2
missing = 0.05
about = the aim
[units]
robot.position.rmse = mm
[labels]
cost.step_ms_mean = step [ms]
paper1 = Paper 1
)");
    ASSERT_EQ(a.tables.size(), 2u);
    EXPECT_EQ(a.tables[0].name, "second");
    EXPECT_EQ(a.tables[0].kind, TableKind::runs);
    EXPECT_THAT(a.tables[0].selection.sources, ElementsAre("paper1", "quiet"));
    EXPECT_THAT(a.tables[0].selection.configs, ElementsAre("classic", "invariant"));
    EXPECT_THAT(a.tables[1].figures, ElementsAre("robot_nees.average", "cost.step_ms_mean"));
    EXPECT_EQ(a.tables[1].baseline, "classic");
    EXPECT_EQ(a.tables[1].digits, 4);
    EXPECT_EQ(a.tables[1].caption, "Differences, by world.");
    EXPECT_THAT(a.tables[1].selection.sources, ElementsAre("quiet"));
    ASSERT_EQ(a.plots.size(), 1u);
    EXPECT_TRUE(a.plots[0].logarithmic_x && a.plots[0].logarithmic_y);
    ASSERT_EQ(a.checks.size(), 1u);
    EXPECT_EQ(a.checks[0].interval.low, -std::numeric_limits<double>::infinity());
    EXPECT_EQ(a.checks[0].interval.high, 0.65);
    ASSERT_TRUE(a.checks[0].short_interval);
    EXPECT_EQ(a.checks[0].short_interval->low, 0.1);
    EXPECT_EQ(a.checks[0].missing, 0.05);

    EXPECT_EQ(a.label("paper1"), "Paper 1");
    EXPECT_EQ(a.label("robot.position.rmse"), "robot.position.rmse [mm]");
    EXPECT_EQ(a.label("quiet"), "quiet");
    EXPECT_EQ(a.factor("robot.position.rmse"), 1000);
    EXPECT_EQ(a.factor("cost.step_ms_mean"), 1);
}

TEST(AnalysisFile, WherePicksOnePointOfBothGrids) {
    StudyFile study = studyOf(R"([check.c]
source = paper1
config = invariant
statistic = rate
where = ekf.gate = 5; sensor.std = 0.2
interval = 0, 0.1
)");
    study.config_grid = {{{"ekf.gate", "3"}}, {{"ekf.gate", "5"}}};
    study.scenario_grid = {{{"sensor.std", "0.1"}}, {{"sensor.std", "0.2"}}};
    const CheckSpec check = readAnalysis(study).checks.at(0);
    EXPECT_EQ(check.config_point, study.config_grid[1]);
    EXPECT_EQ(check.scenario_point, study.scenario_grid[1]);
    EXPECT_FALSE(check.short_interval);
}

struct Mistake {
    const char *text, *message;
};

class Refused : public testing::TestWithParam<Mistake> {};

TEST_P(Refused, NamesFileLineAndWhatWasExpected) {
    EXPECT_THAT(refusal(GetParam().text), HasSubstr(GetParam().message));
}

const char* const in_check = "[check.c]\nsource = paper1\nconfig = invariant\ninterval = 0, 1\nabout = x\n";

INSTANTIATE_TEST_SUITE_P(
    Tables, Refused,
    testing::Values(
        Mistake{"[table.t]\nfigures = robot.position.rmse\n",
                "demo.ini:1: [table.t] lacks 'kind', expected one of means"},
        Mistake{"[table.t]\nkind = meens\n",
                "demo.ini:2: kind = 'meens' in [table.t], expected one of means"},
        Mistake{"[table.t]\nkind = means\n", "demo.ini:1: [table.t] lacks 'figures'"},
        Mistake{"[table.t]\nkind = means\nfigure = robot.position.rmse\n",
                "demo.ini:3: unknown key 'figure' in [table.t]; did you mean 'figures'?"},
        Mistake{"[table.t]\nkind = means\nfigures = robot.position.rsme\n",
                "demo.ini:3: 'robot.position.rsme' is no figure of a run, expected a number of "
                "summary.json's metrics or "
                "cost.<...>; did you mean 'robot.position.rmse'? in [table.t]"},
        Mistake{"[table.t]\nkind = means\nfigures = cost.step_ms_mean, cost.step_ms_mean\n", "none twice"},
        Mistake{"[table.t]\nkind = means\nfigures = cost.step_ms_mean,\n", "names separated by commas"},
        Mistake{"[table.t]\nkind = means\nfigures = cost.wall_s\nsources = paper2\n",
                "demo.ini:4: 'paper2' in [table.t] is no source; did you mean 'paper1'?"},
        Mistake{"[table.t]\nkind = means\nfigures = cost.wall_s\nconfigs = imm\n",
                "'imm' in [table.t] is no config, expected classic | invariant"},
        Mistake{"[table.t]\nkind = means\nfigures = cost.wall_s\nbaseline = classic\n",
                "unknown key 'baseline'"},
        Mistake{"[table.t]\nkind = paired\nfigures = cost.wall_s\n", "[table.t] lacks 'baseline'"},
        Mistake{"[table.t]\nkind = paired\nfigures = cost.wall_s\nbaseline = clasic\n",
                "did you mean 'classic'?"},
        Mistake{"[table.t]\nkind = consistency\nseries = landmark_nees\n", "is no series of [study]"},
        Mistake{"[table.t]\nkind = consistency\nseries = robot_error\n", "has no chi-square band"},
        Mistake{"[table.t]\nkind = divergence\nfigures = cost.wall_s\n", "unknown key 'figures'"},
        Mistake{"[table.t]\nkind = runs\nfigures = cost.wall_s\ndigits = 0\n", "digits = '0'"},
        Mistake{"[table.a/b]\nkind = divergence\n", "demo.ini:1: [table.a/b] names no file"}));

INSTANTIATE_TEST_SUITE_P(
    Figures, Refused,
    testing::Values(
        Mistake{"[figure.f]\nkind = over_time\nfigures = cost.wall_s\n", "unknown key 'figures'"},
        Mistake{"[figure.f]\nkind = over_time\nseries = robot_eror\n", "did you mean 'robot_error'?"},
        Mistake{"[figure.f]\nkind = bands\nseries = robot_error\n", "has no chi-square band"},
        Mistake{"[figure.f]\nkind = over_time\nseries = robot_error\nlogarithmic = z\n",
                "expected x | y | x, y | none"},
        Mistake{"[figure.f]\nkind = over_time\nseries = robot_error\nstatistic = both\n",
                "expected one of mean | median"},
        Mistake{"[figure.f]\nkind = over_parameter\nfigures = cost.wall_s\n", "[figure.f] lacks 'parameter'"},
        Mistake{"[figure.f]\nkind = over_parameter\nfigures = cost.wall_s\nparameter = sensor.sdt\n",
                "did you mean 'sensor.std'?"},
        Mistake{"[figure.f]\nkind = over_parameter\nfigures = cost.wall_s\nparameter = ekf.gate\n",
                "'ekf.gate' takes the value 'wide', expected numbers along an axis"},
        Mistake{"[figure.f]\nkind = against\nfigures = cost.wall_s\n", "1 in 'figures', expected two"}));

INSTANTIATE_TEST_SUITE_P(
    Names, Refused,
    testing::Values(
        Mistake{"[labels]\nclasic = textbook EKF\n", "demo.ini:2: 'clasic' in [labels] is no figure"},
        Mistake{"[labels]\nrobot.position.rmse = RMSE\n", "'robot.position.rmse' in [labels] is no figure"},
        Mistake{"[labels]\nclassic =\n", "the label of 'classic' is empty"},
        Mistake{"[units]\nrobot.heading.rmse = deg\n", "in [units] is no figure of a table"},
        Mistake{
            "[table.t]\nkind = means\nfigures = robot.heading.rmse\n[units]\nrobot.heading.rmse = degrees\n",
            "'degrees' in [units] is no unit"},
        Mistake{
            "[table.t]\nkind = means\nfigures = robot.position.rmse\n[units]\nrobot.position.rmse = deg\n",
            "demo.ini:5: robot.position.rmse = 'deg', but it is a length, expected mm | cm | m | km in "
            "[units]"},
        Mistake{"[table.t]\nkind = means\nfigures = robot.heading.rmse\n[units]\nrobot.heading.rmse = mm\n",
                "but it is an angle, expected deg | mrad | rad"},
        Mistake{"[table.t]\nkind = means\nfigures = cost.wall_s\n[units]\ncost.wall_s = %\n",
                "but it is a time, expected us | ms | s"},
        Mistake{"[table.t]\nkind = means\nfigures = counts.landmarks\n[units]\ncounts.landmarks = %\n",
                "but it is a number, expected no unit for it"}));

TEST(AnalysisFile, ChecksAreRefusedWithFileAndLine) {
    const std::string start = in_check, figure = "figure = robot.position.rmse\n",
                      mean = "statistic = mean\n", where = "where = ekf.gate=3; sensor.std=0.1\n";
    const std::vector<std::pair<std::string, std::string>> mistakes = {
        {start + figure, "lacks 'statistic'"},
        {start + mean + where, "lacks 'figure'"},
        {start + mean + figure, "is about 2 points of the grid, expected one: where = sensor.std = value"},
        {start + mean + figure + "where = ekf.gate=4; sensor.std=0.1\n",
         "'4' in [check.c] is no value of ekf.gate"},
        {start + mean + figure + "where = gate=3\n", "'gate' in [check.c] is no address of the grid"},
        {start + mean + figure + "where = ekf.gate\n", "expected address=value"},
        {start + mean + figure + where + "against = classic\n", "unknown key 'against'"},
        {start + "statistic = ratio\n" + figure + where, "lacks 'against'"},
        {start + "statistic = inside\n" + figure + where, "unknown key 'figure'"},
        {start + "statistic = inside\n" + where, "lacks 'series'"},
        {start + "statistic = rate\n" + figure + where, "unknown key 'figure'"},
        {start + mean + figure + where + "short_interval = 2, 1\n", "two numbers 'low, high'"},
        {start + mean + figure + where + "short_interval = 2\n", "two numbers 'low, high'"},
        {"[check.c]\nsource = paper1\nconfig = classic\n" + mean + figure + where, "lacks 'interval'"},
        {"[check.c]\nconfig = classic\ninterval = 0, 1\n" + mean + figure + where, "lacks 'source'"}};
    for (const auto& [text, message] : mistakes) EXPECT_THAT(refusal(text), HasSubstr(message)) << text;
}

TEST(AnalysisFile, AConfigThatDoesNotRunOnTheSourceCannotBeChecked) {
    StudyFile study = studyOf(std::string(in_check) + "statistic = rate\n");
    study.variants[1].on = {"quiet"};
    EXPECT_THAT(messageOf<ConfigError>([&] { readAnalysis(study); }),
                HasSubstr("config 'invariant' does not run on source 'paper1'"));
}

TEST(AnalysisFile, KnowsEveryTableAndFigureByName) {
    const Analysis a = analysisOf("[table.errors]\nkind = divergence\n");
    EXPECT_EQ(a.table("errors").kind, TableKind::divergence);
    EXPECT_THAT(messageOf<ConfigError>([&] { a.table("erors"); }),
                HasSubstr("no table 'erors'; did you mean 'errors'?"));
    EXPECT_THAT(messageOf<ConfigError>([&] { a.plot("x"); }), HasSubstr("no figure 'x'"));
}

TEST(AnalysisFile, EveryNumberOfTheMetricsIsAFigure) {
    // Some from each part of summary.json's metrics, by doc/metrics.md.
    for (const char* name :
         {"robot.heading.median", "ate.position.rmse", "rpe.heading.maximum", "robot_nees.coverage",
          "landmarks.missing", "landmarks.nees.average", "landmark_set.ospa.cardinality",
          "track_set.gospa.missed_count", "targets.seen.relative_position.median",
          "targets.by_target.3.position.rmse", "targets.all.nees.inside",
          "nis.landmarks.landmark.mean_per_degree", "matching.matched", "counts.landmarks", "cost.memory_mb"})
        EXPECT_NO_THROW(analysisOf(std::string("[table.t]\nkind = means\nfigures = ") + name)) << name;
}

/// The INI blocks of a page, as one file beside the project's studies.
std::string exampleOf(const std::string& page) {
    std::ifstream in(SLAMOT_SOURCE_DIR "/doc/" + page);
    std::string example;
    bool inside = false;
    for (std::string line; std::getline(in, line);) {
        if (line.rfind("```", 0) == 0)
            inside = line == "```ini";
        else if (inside)
            example += line + '\n';
    }
    for (std::size_t at = 0; (at = example.find("../", at)) != std::string::npos;)
        example.replace(at, 3, SLAMOT_SOURCE_DIR "/config/");
    return example;
}

TEST(AnalysisFile, TheExamplesOfTheDocsAreRight) {
    const test::TemporaryFolder folder;
    for (const char* page : {"studies.md", "studies_analysis.md"}) {
        const std::string file = folder.write("example.ini", exampleOf(page));
        EXPECT_NO_THROW(readAnalysis(loadStudy(file))) << page;
    }
    EXPECT_EQ(readAnalysis(loadStudy(folder.path("example.ini"))).tables.size(), 6u) << "one of each kind";
}

TEST(AnalysisFile, TheProjectsOwnStudiesAreRight) {
    int studies = 0;
    for (const auto& file : std::filesystem::directory_iterator(SLAMOT_SOURCE_DIR "/config/studies")) {
        if (file.path().extension() != ".ini") continue;
        EXPECT_NO_THROW(readAnalysis(loadStudy(file.path().string()))) << file.path();
        ++studies;
    }
    EXPECT_GT(studies, 0);
}

}  // namespace analysis_file_test
}  // namespace slamot::study
