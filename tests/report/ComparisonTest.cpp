#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "MetricRows.h"
#include "report/RunFiles.h"
#include "slamot/report/Comparison.h"

namespace slamot::report {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

std::string rmse(const std::string& value) {
    return R"({"robot": {"position": {"rmse": )" + value +
           R"(}}, "robot_nees": {"average": 6, "mean_dimension": 3}})";
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

TEST_F(Comparison, theTableFitsEightyColumns) {
    const std::string text = comparisonText(seedsAndOne());
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::size_t columns = 0;
        for (const char c : line) {
            columns += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
        }
        EXPECT_LE(columns, 80u) << line;
    }
    EXPECT_THAT(text, HasSubstr("1.5*"));
    EXPECT_THAT(text, HasSubstr("2+-2.5"));
}

TEST_F(Comparison, thePageWarnsOfOtherLogs) {
    const auto page = [&](const std::string& log) {
        return toHtml(
            comparisonPage(groupRuns({run("one", test::summaryJson("a.rawlog", rmse("1"))),
                                      run("two", withKey(test::summaryJson(log, rmse("2")), "2"))})));
    };
    EXPECT_THAT(page("b.rawlog"), HasSubstr("not of the same logs"));
    EXPECT_THAT(page("a.rawlog"), ::testing::Not(HasSubstr("not of the same logs")));
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
    EXPECT_EQ(shortNumber(0.0123456), "0.01235");
    EXPECT_EQ(shortNumber(-1.5), "-1.5");
    EXPECT_EQ(shortNumber(1234.56), "1235");
    EXPECT_EQ(shortNumber(97), "97");
    EXPECT_EQ(shortNumber(1.5e-9), "1.5e-09");
}

}  // namespace
}  // namespace slamot::report
