#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "../../libs/study/src/OverTime.h"
#include "slamot/report/Figure.h"
#include "slamot/study/Figures.h"
#include "study/Builders.h"

namespace slamot::study {
namespace figures_test {

using testing::ElementsAre;

report::Figure figureOf(const StudyFile& study, const std::vector<Row>& rows) {
    const Analysis analysis = readAnalysis(study);
    return makeFigure(analysis.plots.at(0), {study, analysis, rows});
}

/// Points of the lines that are in the legend, by label.
std::map<std::string, report::Points2> linesOf(const report::Panel& panel) {
    std::map<std::string, report::Points2> lines;
    for (const report::Layer& layer : panel.layers)
        if (const auto* line = std::get_if<report::Line>(&layer); line && !line->label.empty())
            lines[line->label] = line->points;
    return lines;
}

/// The upright lines of intervals.
report::Points2 intervalsOf(const report::Panel& panel) {
    report::Points2 ends;
    for (const report::Layer& layer : panel.layers)
        if (const auto* line = std::get_if<report::Line>(&layer); line && line->label.empty())
            ends.insert(ends.end(), line->points.begin(), line->points.end());
    return ends;
}

template <class LayerKind>
const LayerKind* find(const report::Panel& panel) {
    for (const report::Layer& layer : panel.layers)
        if (const auto* found = std::get_if<LayerKind>(&layer)) return found;
    return nullptr;
}

/// One source, noise 0.2 before 0.1, two gates; each cell has the runs 10 x noise x gate - 1 and + 1.
std::pair<StudyFile, std::vector<Row>> gridStudy(const std::string& text) {
    StudyFile study = studyOf(text);
    study.sources.pop_back();
    study.variants.pop_back();
    study.scenario_grid = {{{"sensor.std", "0.2"}}, {{"sensor.std", "0.1"}}};
    study.config_grid = {{{"ekf.gate", "3"}}, {{"ekf.gate", "5"}}};
    std::vector<Row> rows;
    for (const GridPoint& scenario : study.scenario_grid)
        for (const GridPoint& config : study.config_grid)
            for (const int replicate : {1, 2}) {
                const double middle = 10 * std::stod(scenario[0].second) * std::stod(config[0].second);
                rows.push_back(rowOf("paper1", "classic", replicate, middle + (replicate == 1 ? -1 : 1)));
                rows.back().scenario_point = scenario;
                rows.back().config_point = config;
            }
    return {study, rows};
}

TEST(OverParameter, ALineForEachOtherPointByRisingParameter) {
    const auto [study, rows] = gridStudy(R"([labels]
robot.position.rmse = robot RMSE [m]
ekf.gate = gate [sigma]
[figure.f]
kind = over_parameter
figures = robot.position.rmse
parameter = sensor.std
title = Errors
)");
    const report::Figure figure = figureOf(study, rows);
    EXPECT_EQ(figure.title, "Errors");
    ASSERT_EQ(figure.panels.size(), 1u);
    const report::Panel& panel = figure.panels[0];
    EXPECT_EQ(panel.x.label, "sensor.std");
    EXPECT_EQ(panel.y.label, "robot RMSE [m]");
    EXPECT_EQ(panel.note, "Mean of 2 runs, upright lines: 95 % interval");
    const auto lines = linesOf(panel);
    ASSERT_EQ(lines.size(), 2u);
    // Two curves, 1.6 % of the extent apart.
    const auto low = lines.at("classic, gate = 3 sigma"), high = lines.at("classic, gate = 5 sigma");
    ASSERT_EQ(low.size(), 2u);
    EXPECT_EQ(low[0].y(), 3);
    EXPECT_EQ(low[1].y(), 6);
    EXPECT_EQ(high[0].y(), 5);
    EXPECT_EQ(high[1].y(), 10);
    EXPECT_NEAR(low[0].x(), 0.1 - 0.0008, 1e-12);
    EXPECT_NEAR(high[0].x(), 0.1 + 0.0008, 1e-12);
    EXPECT_NEAR(high[1].x(), 0.2 + 0.0008, 1e-12);
    EXPECT_EQ(intervalsOf(panel).at(0).x(), low[0].x()) << "intervals move with their points";
    // t of 97.5 % with one degree is 12.706; the standard error of m - 1 and m + 1 is 1.
    EXPECT_NEAR(intervalsOf(panel).at(0).y(), 3 - 12.706, 1e-3);
    EXPECT_NEAR(intervalsOf(panel).at(1).y(), 3 + 12.706, 1e-3);
}

TEST(OverParameter, ALogarithmicAxisHasNoIntervalBelowZero) {
    const auto [study, rows] = gridStudy(
        "[figure.f]\nkind = over_parameter\nfigures = robot.position.rmse\nparameter = "
        "sensor.std\nlogarithmic = y\n");
    const report::Panel panel = figureOf(study, rows).panels.at(0);
    EXPECT_TRUE(panel.y.logarithmic);
    EXPECT_FALSE(panel.x.logarithmic);
    for (const Eigen::Vector2d& end : intervalsOf(panel)) EXPECT_GT(end.y(), 0);
}

TEST(OverParameter, PointsOfTheScenariosGridArePanelsForAParameterOfTheConfigs) {
    const auto [study, rows] =
        gridStudy("[figure.f]\nkind = over_parameter\nfigures = robot.position.rmse\nparameter = ekf.gate\n");
    const report::Figure figure = figureOf(study, rows);
    ASSERT_EQ(figure.panels.size(), 2u);
    EXPECT_EQ(figure.panels[0].title, "sensor.std = 0.2");
    EXPECT_THAT(linesOf(figure.panels[1]).at("classic"),
                ElementsAre(Eigen::Vector2d(3, 3), Eigen::Vector2d(5, 5)));
}

TEST(Figures, OneLegendAndOneColourForAConfigInAllPanels) {
    const StudyFile study = studyOf("[figure.f]\nkind = over_time\nseries = robot_error\n");
    auto rows = rowsOf("paper1", "classic", {1}) + rowsOf("paper1", "invariant", {1}) +
                rowsOf("quiet", "invariant", {1});
    for (Row& row : rows) row.series["robot_error"] = {{0, 1}, {1, 2}, {}};
    const report::Figure figure = figureOf(study, rows);
    ASSERT_EQ(figure.panels.size(), 2u);
    EXPECT_TRUE(figure.shared_legend);
    for (const report::Panel& panel : figure.panels) EXPECT_EQ(panel.legend, report::LegendPlace::none);
    const auto colour = [&](std::size_t panel, std::size_t line) {
        return std::get<report::Line>(figure.panels[panel].layers.at(line)).colour;
    };
    EXPECT_EQ(colour(0, 1), colour(1, 0)) << "of invariant, the only one in the second panel";
    EXPECT_NE(colour(0, 0), colour(0, 1));
    EXPECT_EQ(figure.panels[0].note, "Mean of 1 run") << "nothing is shaded";
}

TEST(Against, OnePanelWithAPointForEachCell) {
    const StudyFile study = studyOf(
        "[figure.f]\nkind = against\nfigures = counts.landmarks, robot.position.rmse\nstatistic = median\n"
        "[units]\nrobot.position.rmse = mm\n");
    auto rows = rowsOf("paper1", "classic", {1, 2, 6}) + rowsOf("quiet", "classic", {0.5});
    for (Row& row : rows) row.metrics["counts.landmarks"] = row.source == "quiet" ? 50 : 100 + row.replicate;
    const report::Figure figure = figureOf(study, rows);
    ASSERT_EQ(figure.panels.size(), 1u);
    EXPECT_EQ(figure.panels[0].x.label, "counts.landmarks");
    EXPECT_EQ(figure.panels[0].y.label, "robot.position.rmse [mm]");
    EXPECT_EQ(figure.panels[0].note, "Median of 1 to 3 runs") << "medians of so few have no interval";
    EXPECT_THAT(linesOf(figure.panels[0]).at("classic"),
                ElementsAre(Eigen::Vector2d(50, 500), Eigen::Vector2d(102, 2000)));
}

TEST(Against, CellsOfOneXAreAllThere) {
    auto rows = rowsOf("paper1", "classic", {1}) + rowsOf("quiet", "classic", {2});
    for (Row& row : rows) row.metrics["counts.landmarks"] = 7;
    const report::Figure figure = figureOf(
        studyOf("[figure.f]\nkind = against\nfigures = counts.landmarks, robot.position.rmse\n"), rows);
    EXPECT_THAT(linesOf(figure.panels.at(0)).at("classic"),
                ElementsAre(Eigen::Vector2d(7, 1), Eigen::Vector2d(7, 2)));
}

TEST(OverTime, MeanAndMiddleOfTheRunsInEachSource) {
    auto rows = rowsOf("paper1", "classic", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    for (Row& row : rows) row.series["robot_error"] = {{0, 1}, {0, 1.0 * row.replicate}, {}};
    const report::Figure figure =
        figureOf(studyOf("[figure.f]\nkind = over_time\nseries = robot_error\n"), rows);
    ASSERT_EQ(figure.panels.size(), 1u) << "a source without runs has no panel";
    const report::Panel& panel = figure.panels[0];
    EXPECT_EQ(panel.title, "paper1");
    EXPECT_THAT(linesOf(panel).at("classic"), ElementsAre(Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 6)));
    const report::Band* band = find<report::Band>(panel);
    ASSERT_TRUE(band);
    EXPECT_DOUBLE_EQ(band->rows[1].low, 2);  // of 1 to 11, a tenth of the way from each end
    EXPECT_DOUBLE_EQ(band->rows[1].high, 10);
    EXPECT_EQ(panel.note, "Mean of 11 runs, shaded: the middle 80 %");
}

TEST(Bands, MeanNeesWithTheBandAndWhatIsExpected) {
    auto rows = rowsOf("paper1", "classic", {0, 0});
    for (Row& row : rows) row.series["robot_nees"] = {{0, 1}, {1.0 * row.replicate, 9}, {3, 3}};
    const report::Panel panel =
        figureOf(studyOf("[figure.f]\nkind = bands\nseries = robot_nees\nlogarithmic = y\n"), rows)
            .panels.at(0);
    EXPECT_THAT(linesOf(panel).at("classic"), ElementsAre(Eigen::Vector2d(0, 1.5), Eigen::Vector2d(1, 9)));
    const report::Band* band = find<report::Band>(panel);
    ASSERT_TRUE(band);
    EXPECT_NEAR(band->rows[0].low, 1.2373 / 2, 1e-4);  // chi-square of 6 degrees, from any table
    EXPECT_NEAR(band->rows[0].high, 14.4494 / 2, 1e-4);
    ASSERT_TRUE(find<report::Rule>(panel));
    EXPECT_EQ(find<report::Rule>(panel)->value, 3);
}

TEST(Figures, WithoutRunsThereIsAnEmptyPanelThatSaysSo) {
    const report::Figure figure = figureOf(studyOf("[figure.f]\nkind = bands\nseries = robot_nees\n"), {});
    ASSERT_EQ(figure.panels.size(), 1u);
    EXPECT_EQ(figure.panels[0].note, "no run has this");
}

Course courseOf(const std::vector<Series>& runs) {
    std::vector<Row> rows;
    for (const Series& series : runs) {
        rows.push_back(rowOf("s", "v", static_cast<int>(rows.size()) + 1, 0));
        rows.back().series["e"] = series;
    }
    return courseOf(cellsOf(rows).front(), "e");
}

TEST(CourseOf, TakesTheRunsThatHaveATime) {
    const double nan = std::nan("");
    const Course course =
        courseOf({{{0, 1, 2}, {1, 5, 3}, {}}, {{0, 1, 2}, {2, nan, 5}, {}}, {{0}, {6}, {}}});
    EXPECT_EQ(course.interval, 0);
    ASSERT_EQ(course.steps.size(), 3u);
    EXPECT_EQ(course.steps[0].runs, 3);
    EXPECT_EQ(course.steps[0].mean, 3);
    EXPECT_EQ(course.steps[0].median, 2);
    EXPECT_EQ(course.steps[1].runs, 1);
    EXPECT_EQ(course.steps[2].mean, 4);
}

TEST(CourseOf, AveragesOverIntervalsWhereTimesAreNotShared) {
    // 0 to 300 s, one run at whole seconds, two between them.
    std::vector<Series> runs(3);
    for (int i = 0; i <= 300; ++i) {
        runs[0].seconds.push_back(i);
        runs[0].value.push_back(i);
        for (int k : {1, 2}) {
            runs[static_cast<std::size_t>(k)].seconds.push_back(std::min(i + 0.25 * k, 300.0 - 0.001 * k));
            runs[static_cast<std::size_t>(k)].value.push_back(10);
        }
    }
    const Course course = courseOf(runs);
    EXPECT_DOUBLE_EQ(course.interval, 1);
    ASSERT_EQ(course.steps.size(), 300u);
    EXPECT_EQ(course.steps[7].runs, 3);
    EXPECT_DOUBLE_EQ(course.steps[7].seconds, 7.5);
    EXPECT_DOUBLE_EQ(course.steps[7].mean, (7 + 10 + 10) / 3.0);
    EXPECT_DOUBLE_EQ(course.steps[299].mean, (299.5 + 10 + 10) / 3) << "the end belongs to the last interval";
}

TEST(QuantileOf, BetweenOrderStatistics) {
    EXPECT_EQ(quantileOf({1, 2, 4}, 0), 1);
    EXPECT_EQ(quantileOf({1, 2, 4}, 0.75), 3);
    EXPECT_EQ(quantileOf({1, 2, 4}, 1), 4);
    EXPECT_EQ(quantileOf({5}, 0.3), 5);
}

}  // namespace figures_test
}  // namespace slamot::study
