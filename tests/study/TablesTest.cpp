#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "../../libs/study/src/MarkdownText.h"
#include "../../libs/study/src/NumberText.h"
#include "slamot/study/Tables.h"
#include "study/Builders.h"

namespace slamot::study {
namespace tables_test {

using testing::ElementsAre;

/// The only table of a study.
Table tableOf(const StudyFile& study, const std::vector<Row>& rows) {
    const Analysis analysis = readAnalysis(study);
    return makeTable(analysis.tables.at(0), {study, analysis, rows});
}
Table tableOf(const std::string& text, const std::vector<Row>& rows) {
    return tableOf(studyOf(text), rows);
}

/// What people see, cells joined by " | ", the header first.
std::vector<std::string> shown(const Table& table) {
    std::vector<std::string> lines(1);
    for (const Column& column : table.columns) lines[0] += (lines[0].empty() ? "" : " | ") + column.heading;
    for (const TableLine& line : table.lines) {
        std::string text;
        for (const Field& field : line.fields) text += (text.empty() ? "" : " | ") + field.shown;
        lines.push_back(text);
    }
    return lines;
}

TEST(NumberText, SignificantDigitsButNeverBeforeThePoint) {
    EXPECT_EQ(numberText(0.012345, 3), "0.0123");
    EXPECT_EQ(numberText(1.2345, 3), "1.23");
    EXPECT_EQ(numberText(12345.6, 3), "12346");
    EXPECT_EQ(numberText(0.9996, 3), "1.00") << "rounding may add a digit";
    EXPECT_EQ(numberText(-0.5, 2), "-0.50");
    EXPECT_EQ(numberText(0, 3), "0.00");
    EXPECT_EQ(numberText(1.5e7, 2), "1.5e+07");
    EXPECT_EQ(numberText(1.5e-5, 2), "1.5e-05");
    EXPECT_EQ(numberText(Statistic::none, 3), "–");
}

TEST(NumberText, MeanAndHalfWidthHaveTheDecimalsOfTheLarger) {
    Statistic s;
    s.count = 300;
    s.mean = 0.34812;
    s.half_width = 0.0291;
    s.median = 0.2683;
    s.median_low = 0.25;
    s.median_high = 0.28;
    EXPECT_EQ(statisticText(s, Shown::both, 3), "0.348 ± 0.029 (0.268)");
    EXPECT_EQ(statisticText(s, Shown::mean, 3), "0.348 ± 0.029");
    EXPECT_EQ(statisticText(s, Shown::median, 3), "0.268 [0.250, 0.280]");
    s.mean = -0.00012;
    EXPECT_EQ(statisticText(s, Shown::mean, 3), "-0.0001 ± 0.0291");
    s.mean = -0.00002;
    EXPECT_EQ(statisticText(s, Shown::mean, 3), "0.0000 ± 0.0291") << "no minus before zero";
    EXPECT_EQ(statisticText(statisticOf({2}), Shown::both, 3), "2.00");
    EXPECT_EQ(statisticText(Statistic{}, Shown::both, 3), "–");
}

const char* const means = R"([labels]
paper1 = Paper 1
robot.position.rmse = robot RMSE [mm]
[units]
robot.position.rmse = mm
[table.t]
kind = means
figures = robot.position.rmse
)";

TEST(MeansTable, OneLineForEachCellInTheOrderOfTheFile) {
    auto rows = rowsOf("quiet", "classic", {0.5}) + rowsOf("paper1", "invariant", {0.1, 0.1}) +
                rowsOf("paper1", "classic", {0.2, 0.4});
    rows.push_back(failedRow("paper1", "classic", 3));
    const Table table = tableOf(means, rows);
    // Of 200 and 400 mm: t of 97.5 % with one degree is 12.706, times 141.42 / sqrt 2.
    EXPECT_THAT(shown(table),
                ElementsAre("source | config | runs | robot RMSE [mm]",
                            "Paper 1 | classic | 3 | 300 ± 1271 (300), n = 2",
                            "Paper 1 | invariant | 2 | 100 ± 0 (100)", "quiet | classic | 1 | 500"));
    std::istringstream csv(toCsv(table));
    std::string header, line;
    std::getline(csv, header);
    std::getline(csv, line);
    EXPECT_EQ(
        header,
        "source,config,runs,robot.position.rmse_mm.n,robot.position.rmse_mm.mean,robot.position.rmse_mm.half_"
        "width,"
        "robot.position.rmse_mm.median,robot.position.rmse_mm.median_low,robot.position.rmse_mm.median_high");
    EXPECT_EQ(line.rfind("paper1,classic,3,2,300", 0), 0u) << "names, not labels: " << line;
    EXPECT_EQ(line.substr(line.size() - 2), ",,") << "no interval of the median of two: " << line;
}

TEST(MeansTable, GridsThatVaryHaveColumns) {
    StudyFile study =
        studyOf("[table.t]\nkind = means\nfigures = cost.wall_s\nsources = paper1\nstatistic = mean\n");
    study.config_grid = {{{"ekf.gate", "3"}, {"ekf.fixed", "1"}}, {{"ekf.gate", "5"}, {"ekf.fixed", "1"}}};
    std::vector<Row> rows = rowsOf("paper1", "classic", {1, 1});
    for (std::size_t i : {0u, 1u}) {
        rows[i].config_point = study.config_grid[1 - i];
        rows[i].cost.wall_s = 7;
    }
    EXPECT_THAT(shown(tableOf(study, rows)), ElementsAre("config | ekf.gate | runs | cost.wall_s",
                                                         "classic | 3 | 1 | 7.00", "classic | 5 | 1 | 7.00"));
}

TEST(PairedTable, DifferencesAndRatiosToTheBaseline) {
    const auto rows = rowsOf("paper1", "classic", {2, 4}) + rowsOf("paper1", "invariant", {1, 3}) +
                      rowsOf("quiet", "invariant", {1});
    const Table table = tableOf(
        "[table.t]\nkind = paired\nfigures = robot.position.rmse\nbaseline = classic\nstatistic = mean\n",
        rows);
    // Differences -1 and -1; ratios 0.5 and 0.75: 0.625 with a half width of 12.706 x 0.125.
    EXPECT_THAT(
        shown(table),
        ElementsAre("source | config | figure | worlds | difference to classic | ratio to classic | smaller",
                    "paper1 | invariant | robot.position.rmse | 2 | -1.00 ± 0.00 | 0.62 ± 1.59 | 2 of 2",
                    "quiet | invariant | robot.position.rmse | 0 | – | – | –"));
}

TEST(ConsistencyTable, PartsOfTheStepsInTheBand) {
    auto rows = rowsOf("paper1", "classic", {1}) + rowsOf("paper1", "invariant", {1});
    rows[0].series["robot_nees"] = {{0, 1, 2, 3}, {3, 30, 3, 0.01}, {3, 3, 3, 3}};
    const Table table =
        tableOf("[table.t]\nkind = consistency\nseries = robot_nees\nsources = paper1\n", rows);
    EXPECT_THAT(
        shown(table),
        ElementsAre("config | runs | ANEES | expected | steps in band | above (over-confident) | below",
                    "classic | 1 | 9.00 | 3.00 | 50.0 % | 25.0 % | 25.0 %",
                    "invariant | 0 of 1 | – | – | – | – | –"));
}

TEST(DivergenceTable, RatesWithIntervals) {
    auto rows = rowsOf("paper1", "classic", {1, 1, 1, 1, 1, 11, 11, 11, 11});
    rows.push_back(failedRow("paper1", "classic", 10));
    EXPECT_THAT(shown(tableOf("[table.t]\nkind = divergence\nsources = paper1\n", rows)),
                ElementsAre("config | runs | failed | diverged | failed or diverged",
                            "classic | 10 | 1 | 4 | 50.0 % [23.7, 76.3]"));
}

TEST(RanksTable, TheBestComesFirst) {
    const auto rows = rowsOf("paper1", "classic", {2, 4, 1}) + rowsOf("paper1", "invariant", {1, 3, 2});
    // Ranks of classic 2, 2, 1: t of 97.5 % with two degrees is 4.3027, times 0.57735 / sqrt 3.
    EXPECT_THAT(
        shown(tableOf("[table.t]\nkind = ranks\nfigures = robot.position.rmse\nstatistic = mean\n", rows)),
        ElementsAre("config | worlds | rank by robot.position.rmse", "invariant | 3 | 1.33 ± 1.43",
                    "classic | 3 | 1.67 ± 1.43"));
}

TEST(RunsTable, EachRunAndTheirMeanAndMedian) {
    const auto rows = rowsOf("paper1", "classic", {1, 2, 6}) + rowsOf("paper1", "invariant", {4});
    const Table table = tableOf(
        "[labels]\nreplicate = robot\n[table.t]\nkind = runs\nfigures = robot.position.rmse\nsources = "
        "paper1\n",
        rows);
    EXPECT_THAT(shown(table), ElementsAre("config | robot | robot.position.rmse", "classic | 1 | 1.00",
                                          "classic | 2 | 2.00", "classic | 3 | 6.00", "classic | mean | 3.00",
                                          "classic | median | 2.00", "invariant | 1 | 4.00"));
    EXPECT_EQ(toCsv(table),
              "config,replicate,robot.position.rmse\nclassic,1,1\nclassic,2,2\nclassic,3,6\ninvariant,1,4\n")
        << "means are not rows";
    EXPECT_THAT(toMarkdown(table), testing::HasSubstr("| **classic** | **median** | "));
}

TEST(RunsTable, SaysWhichRunsDidNotEnd) {
    auto rows = rowsOf("paper1", "classic", {1});
    rows.push_back(failedRow("paper1", "classic", 2));
    EXPECT_THAT(
        shown(tableOf(
            "[table.t]\nkind = runs\nfigures = robot.position.rmse\nsources = paper1\nstatistic = mean\n",
            rows)),
        ElementsAre("config | replicate | status | robot.position.rmse", "classic | 1 | complete | 1.00",
                    "classic | 2 | failed | –", "classic | mean |  | 1.00, n = 1"));
}

Table strange() {
    Table table;
    table.caption = "What it shows.";
    table.columns = {{"name|with", {"name"}, false}, {"±", {"value", "width"}, true}};
    table.lines = {{{{"a|b\nc", {"a|b\nc"}}, {"1 ± 0.5", {"1", "0.5"}}}},
                   {{{"\"q\", r", {"\"q\", r"}}, {"–", {"", ""}}}}};
    return table;
}

TEST(Markdown, ColumnsAreAlignedAndBarsEscaped) {
    EXPECT_EQ(toMarkdown(strange()),
              "What it shows.\n\n"
              "| name\\|with |       ± |\n"
              "|------------|--------:|\n"
              "| a\\|b c     | 1 ± 0.5 |\n"
              "| \"q\", r     |       – |\n");
}

TEST(Markdown, TextsAreShownLetterByLetter) {
    EXPECT_EQ(markdownText("robot_nees of ekf_slamot"), "robot_nees of ekf_slamot")
        << "no emphasis inside words";
    EXPECT_EQ(markdownText("a < b & c > 1 [m] ~5"), "a < b & c > 1 [m] ~5") << "means nothing in Markdown";
    EXPECT_EQ(markdownText("<b>bold</b> _it_ *it* ~~gone~~ `code`"),
              "\\<b>bold\\</b> \\_it\\_ \\*it\\* \\~\\~gone\\~\\~ \\`code\\`");
    EXPECT_EQ(markdownText("a|b &lt; \\* [x](y)"), "a\\|b \\&lt; \\\\\\* \\[x\\](y)");
}

TEST(Csv, QuotesWhatNeedsIt) {
    EXPECT_EQ(toCsv(strange()), "name,value,width\na|b c,1,0.5\n\"\"\"q\"\", r\",,\n");
}

}  // namespace tables_test
}  // namespace slamot::study
