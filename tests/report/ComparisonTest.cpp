#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "MetricRows.h"
#include "Text.h"
#include "report/RunFiles.h"
#include "slamot/report/Comparison.h"

namespace slamot::report {
namespace comparison_test {

using test::TemporaryFolder;
using ::testing::HasSubstr;

std::string rmse(const std::string& value) {
    return R"({"robot": {"position": {"rmse": )" + value +
           R"(}}, "robot_nees": {"average": 6, "mean_dimension": 3}})";
}

void expectEightyColumns(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::size_t columns = 0;
        for (const char c : line) {
            columns += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
        }
        EXPECT_LE(columns, 80u) << line;
    }
}

/// Folders NAME within one temporary folder.
class Comparison : public ::testing::Test {
  protected:
    RunFolder run(const std::string& name, const std::string& summary) {
        std::filesystem::create_directory(folder_.path(name));
        folder_.write(name + "/trajectory.csv", test::trajectory_csv);
        folder_.write(name + "/summary.json", summary);
        return readRunFolder(folder_.path(name));
    }
    static std::string withKey(std::string summary, const std::string& value) {
        return summary.replace(summary.find("key = 1"), 7, "key = " + value);
    }
    static const ComparedMetric& metric(const std::vector<ComparedMetric>& all, const std::string& heading) {
        for (const ComparedMetric& one : all) {
            if (one.group == "Robot" && one.heading == heading) {
                return one;
            }
        }
        throw std::out_of_range(heading);
    }
    /// Three seeds of one configuration, RMSE 1, 2 and 3, and one run of another, RMSE 1.5.
    std::vector<RunGroup> seedsAndOne() {
        return groupRuns({run("mine_1", test::summaryJson("a.rawlog", rmse("1"), "1")),
                          run("mine_2", test::summaryJson("a.rawlog", rmse("2"), "2")),
                          run("other", withKey(test::summaryJson("a.rawlog", rmse("1.5"), "1"), "2")),
                          run("mine_3", test::summaryJson("a.rawlog", rmse("3"), "3"))});
    }

    TemporaryFolder folder_;
};

TEST_F(Comparison, runsThatDifferBySeedAreOneGroup) {
    const std::vector<RunGroup> groups = seedsAndOne();
    ASSERT_EQ(groups.size(), 2u);
    EXPECT_EQ(groups[0].name, "mine");
    EXPECT_EQ(groups[0].runs.size(), 3u);
    EXPECT_EQ(groups[1].name, "other");
}

TEST_F(Comparison, meansHaveStudentsInterval) {
    const ComparedMetric rmse_row = metric(compareMetrics(seedsAndOne()), "position RMSE [m]");
    EXPECT_DOUBLE_EQ(rmse_row.values[0].mean, 2);
    // t of 2 degrees of freedom at 0.975 is 4.30265; the standard deviation of 1, 2, 3 is 1.
    EXPECT_NEAR(rmse_row.values[0].half_width, 4.30265 / std::sqrt(3.0), 1e-5);
    EXPECT_TRUE(std::isnan(rmse_row.values[1].half_width));
    EXPECT_FALSE(rmse_row.values[0].best);
    EXPECT_TRUE(rmse_row.values[1].best);
}

TEST_F(Comparison, equalValuesHaveNoBest) {
    const ComparedMetric nees = metric(compareMetrics(seedsAndOne()), "NEES per degree of freedom");
    EXPECT_DOUBLE_EQ(nees.values[0].mean, 2);  // 6 of 3 degrees
    EXPECT_FALSE(nees.values[0].best || nees.values[1].best);
}

TEST_F(Comparison, aSeedOfClutterIsNoOtherConfiguration) {
    const auto withClutter = [](const std::string& seed, const std::string& world) {
        std::string summary = test::summaryJson("a.rawlog", rmse("1"), seed);
        const std::string end = R"(\n", "counts")";
        return summary.replace(summary.find(end), end.size(),
                               R"(\n[clutter]\nrate = 2\nseed = )" + world + end);
    };
    EXPECT_EQ(groupRuns({run("a_1", withClutter("1", "11")), run("a_2", withClutter("2", "12"))}).size(), 1u);
    std::string other = withClutter("2", "12");
    other.replace(other.find("rate = 2"), 8, "rate = 3");
    EXPECT_EQ(groupRuns({run("a_1", withClutter("1", "11")), run("a_3", other)}).size(), 2u);
}

std::string withStatus(std::string summary, const std::string& status) {
    return summary.replace(summary.find(R"("status": "complete")"), 20, R"("status": ")" + status + '"');
}

TEST_F(Comparison, runsThatBrokeOffAreSaidAndNeverTheBest) {
    // One of three seeds broke off early with the smallest error, one failed and has none.
    const std::vector<RunGroup> groups =
        groupRuns({run("mine_1", withStatus(test::summaryJson("a.rawlog", rmse("0.1"), "1"), "stopped")),
                   run("mine_2", test::summaryJson("a.rawlog", rmse("1"), "2")),
                   run("mine_3", withStatus(test::summaryJson("a.rawlog", "null", "3"), "failed")),
                   run("other", withKey(test::summaryJson("a.rawlog", rmse("2"), "1"), "2")),
                   run("third", withKey(test::summaryJson("a.rawlog", rmse("3"), "1"), "3"))});
    const ComparedMetric row = metric(compareMetrics(groups), "position RMSE [m]");
    EXPECT_EQ(row.values[0].count, 1u);  // what broke off does not count beside what is complete
    EXPECT_EQ(row.values[0].mean, 1);
    EXPECT_EQ(row.values[0].of, 3u);
    EXPECT_FALSE(row.values[0].best);
    EXPECT_TRUE(row.values[1].best);  // of those that came to the end
    const std::string text = comparisonText(groups), html = toHtml(comparisonPage(groups));
    EXPECT_THAT(text, HasSubstr("1 of 3 complete"));
    EXPECT_THAT(text, HasSubstr(" n=1 "));
    EXPECT_THAT(html, HasSubstr(">1 of 3 complete<"));
    EXPECT_THAT(html, HasSubstr("(1 of 3 runs)"));
    EXPECT_THAT(html, HasSubstr("<td>failed</td>"));
}

TEST_F(Comparison, aSingleRunThatFailedIsSaid) {
    const std::vector<RunGroup> groups =
        groupRuns({run("one", withStatus(test::summaryJson("a.rawlog", "null"), "failed")),
                   run("two", withKey(test::summaryJson("a.rawlog", rmse("2")), "2"))});
    EXPECT_THAT(comparisonText(groups), HasSubstr("failed"));
    EXPECT_FALSE(
        metric(compareMetrics(groups), "position RMSE [m]").values[1].best);  // none to be better than
}

TEST_F(Comparison, seedsOf64BitsKeepEveryDigit) {
    // 2^53 + 1 is the first whole number that no double holds.
    const auto summary = [](const std::string& key) {
        return withKey(test::summaryJson("a.rawlog", rmse("1"), "9007199254740993"), key);
    };
    const std::string html =
        toHtml(comparisonPage(groupRuns({run("one", summary("1")), run("two", summary("2"))})));
    EXPECT_THAT(html, HasSubstr("<td class=\"number\">9007199254740993</td>"));
    EXPECT_THAT(html, ::testing::Not(HasSubstr("9007199254740992")));
}

TEST_F(Comparison, theTableFitsEightyColumns) {
    const std::string text = comparisonText(seedsAndOne());
    expectEightyColumns(text);
    EXPECT_THAT(text, HasSubstr("1.5*"));
    EXPECT_THAT(text, HasSubstr("2+-2.5"));
}

TEST_F(Comparison, theTableFitsEightyColumnsWhateverTheNumbersAre) {
    std::vector<RunFolder> runs;
    for (const char* key : {"1", "2", "3", "4"}) {
        for (const char* seed : {"1", "2"}) {
            const std::string value = std::string(seed) == "1" ? "-1.2345e-101" : "9.8765e-101";
            runs.push_back(run(std::string("a_long_name_ändert_sich_") + key + "_" + seed,
                               withKey(test::summaryJson("a.rawlog", rmse(value), seed), key)));
        }
    }
    const std::string text = comparisonText(groupRuns(runs));
    expectEightyColumns(text);
    EXPECT_THAT(text, HasSubstr("4.32e-101+-7.1e-100"));  // the mean of both; 12.706 sd / sqrt(2)
}

TEST(Text, isCutBetweenCharacters) {
    EXPECT_EQ(lastCodePoints("äöü", 3, ".."), "äöü");
    EXPECT_EQ(lastCodePoints("aäöü", 3, ".."), "..ü");
    EXPECT_EQ(codePoints("aäöü"), 4u);
}

TEST_F(Comparison, runsOfOtherLogsAreSaidAndNoneIsTheBest) {
    const auto groups = [&](const std::string& log) {
        return groupRuns({run("one", test::summaryJson("a.rawlog", rmse("1"))),
                          run("two", withKey(test::summaryJson(log, rmse("2")), "2"))});
    };
    const std::vector<RunGroup> same = groups("a.rawlog"), other = groups("b.rawlog");
    for (const std::string& shown : {toHtml(comparisonPage(other)), comparisonText(other)}) {
        EXPECT_THAT(shown, HasSubstr("not of the same logs"));
    }
    EXPECT_FALSE(metric(compareMetrics(other), "position RMSE [m]").values[0].best);
    for (const std::string& shown : {toHtml(comparisonPage(same)), comparisonText(same)}) {
        EXPECT_THAT(shown, ::testing::Not(HasSubstr("not of the same logs")));
    }
    EXPECT_TRUE(metric(compareMetrics(same), "position RMSE [m]").values[0].best);
}

TEST_F(Comparison, aLogIsTheSameHoweverItIsCalled) {
    folder_.write("a.rawlog", "");
    const std::vector<RunGroup> groups =
        groupRuns({run("one", test::summaryJson("a.rawlog", rmse("1"))),
                   run("two", withKey(test::summaryJson(folder_.path("a.rawlog"), rmse("2")), "2"))});
    EXPECT_THAT(comparisonNotes(groups), ::testing::IsEmpty());
}

TEST_F(Comparison, aRunThatRepeatsAnotherIsLeftOut) {
    // The second's seed changed nothing of the estimates, and its log is a copy.
    std::string copy = test::summaryJson("b.rawlog", rmse("1"), "7");
    copy.replace(copy.find("abc7"), 4, "abc1");
    std::vector<RunFolder> runs = {run("one", test::summaryJson("a.rawlog", rmse("1"), "1")),
                                   run("two", copy),
                                   run("three", test::summaryJson("a.rawlog", rmse("1"), "2"))};
    const std::vector<std::string> notes = dropRepeats(runs);
    ASSERT_EQ(runs.size(), 2u);
    EXPECT_EQ(runs[0].digits("seed"), "1");
    EXPECT_EQ(runs[1].digits("seed"), "2");
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_THAT(notes[0], ::testing::MatchesRegex(".*two repeats .*one .*"));
}

TEST_F(Comparison, settingsThatDifferAreSaid) {
    std::string other = test::summaryJson("a.rawlog", rmse("1"), "1");
    const std::string end = R"(\n", "counts")";
    other.replace(other.find(end), end.size(), R"(\n[eval]\nlandmark_cutoff = 3\n", "counts")");
    std::string foreign = test::summaryJson("a.rawlog", rmse("1"), "1");
    for (std::size_t at = 0; (at = foreign.find("my_estimator", at)) != std::string::npos;) {
        foreign.replace(at, 12, "another");
    }
    const std::vector<RunGroup> groups =
        groupRuns({run("one", test::summaryJson("a.rawlog", rmse("1"), "1")),
                   run("two", withKey(other, "a_value_of_very_many_letters")), run("three", foreign)});
    std::vector<std::string> rows;
    for (const ComparedSetting& setting : compareSettings(groups)) {
        std::string row = setting.section + "/" + setting.key;
        for (const std::string& value : setting.values) {
            row += "|" + value;
        }
        rows.push_back(row);
    }
    // The key of `another` is that estimator's alone, so there is nothing to compare it with.
    EXPECT_THAT(rows, ::testing::ElementsAre("eval/landmark_cutoff||3|",
                                             "my_estimator/key|1|a_value_of_very_many_letters|",
                                             "run/estimator|my_estimator|my_estimator|another"));
    const std::string text = comparisonText(groups);
    expectEightyColumns(text);
    EXPECT_THAT(text, HasSubstr("  [eval]\n    landmark_cutoff "));
    EXPECT_THAT(text, HasSubstr("a_value_of_v.."));
    EXPECT_THAT(toHtml(comparisonPage(groups)), HasSubstr("[my_estimator]"));
}

TEST_F(Comparison, timesOfSingleRunsAreNotCompared) {
    const auto time = [](const std::vector<ComparedMetric>& metrics) {
        for (const ComparedMetric& row : metrics) {
            if (row.heading == "step time, mean [ms]") {
                return row.values;
            }
        }
        return std::vector<GroupValue>();
    };
    const auto with = [](const std::string& seed, const std::string& key, const std::string& ms) {
        std::string summary = withKey(test::summaryJson("a.rawlog", rmse("1"), seed), key);
        return summary.replace(summary.find("0.25"), 4, ms);
    };
    const RunFolder one = run("a1", with("1", "1", "0.25")), two = run("a2", with("2", "1", "0.25")),
                    three = run("b1", with("1", "2", "0.5")), four = run("b2", with("2", "2", "0.5"));
    EXPECT_FALSE(time(compareMetrics(groupRuns({one, three})))[0].best);
    EXPECT_TRUE(time(compareMetrics(groupRuns({one, two, three, four})))[0].best);
}

TEST_F(Comparison, truthMeasuredAtAPointIsDrawnAtTheOrigin) {
    RunFolder one = run("one", test::summaryJson());
    one.truth.emplace();
    one.truth->point = {0, 2};
    for (const eval::RobotRow& row : one.run.trajectory) {
        one.truth->robot.push_back({row.stamp, {row.robot.mean.x, 2, std::nan("")}});
    }
    one.pairs = eval::pairWithTruth(one.run.trajectory, *one.truth).pairs;
    const Page page = comparisonPage(groupRuns({one}));
    ASSERT_EQ(page.sections.at(1).id, "ways");
    const Figure& figure = std::get<PageFigure>(page.sections[1].blocks.at(0)).figure;
    EXPECT_EQ(std::get<Line>(figure.panels.at(0).layers.at(0)).points,
              (Points2{{0, 0}, {1, 0}, {2, 0}, {3, 0}}));
}

TEST(MetricRows, theBestOfAMetricIsWhatItSays) {
    MetricRow row;
    row.better = Better::smaller;
    EXPECT_TRUE(isBetter(row, 1, 2));
    row.better = Better::larger;
    EXPECT_FALSE(isBetter(row, 1, 2));
    row.better = Better::near_one;
    EXPECT_TRUE(isBetter(row, 0.8, 2));  // a factor of 1.25 against 2
    EXPECT_FALSE(isBetter(row, 0.2, 4));
    row.better = Better::none;
    EXPECT_FALSE(isBetter(row, 1, 2));
}

TEST(MetricRows, numbersAreShort) {
    EXPECT_EQ(shortNumber(0), "0");
    EXPECT_EQ(shortNumber(std::nan("")), "nan");
    EXPECT_EQ(shortNumber(0.0123456), "0.01235");
    EXPECT_EQ(shortNumber(-1.5), "-1.5");
    EXPECT_EQ(shortNumber(1234.56), "1235");
    EXPECT_EQ(shortNumber(97), "97");
    EXPECT_EQ(shortNumber(1.5e-9), "1.5e-09");
}

}  // namespace comparison_test
}  // namespace slamot::report
