#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "../../libs/study/src/StatisticFields.h"
#include "slamot/study/Analysis.h"
#include "study/Builders.h"

namespace slamot::study {
namespace analysis_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const std::string rmse = "robot.position.rmse";

TEST(StatisticOf, MeanWithStudentsInterval) {
    const Statistic s = statisticOf({4, nan, 1, 3, 2, std::numeric_limits<double>::infinity()});
    EXPECT_EQ(s.count, 4);
    EXPECT_DOUBLE_EQ(s.mean, 2.5);
    EXPECT_DOUBLE_EQ(s.deviation, std::sqrt(5.0 / 3));
    // t of 97.5 % with 3 degrees of freedom is 3.18245 in any table.
    EXPECT_NEAR(s.half_width, 3.182446 * std::sqrt(5.0 / 3) / 2, 1e-6);
    EXPECT_DOUBLE_EQ(s.median, 2.5);
    EXPECT_EQ(s.minimum, 1);
    EXPECT_EQ(s.maximum, 4);
    EXPECT_TRUE(std::isnan(s.median_low)) << "four values cannot hold the median with 95 %";
}

TEST(StatisticOf, SaysNothingOfTooFewValues) {
    const Statistic none = statisticOf({nan}), one = statisticOf({7});
    EXPECT_EQ(none.count, 0);
    EXPECT_TRUE(std::isnan(none.mean));
    EXPECT_TRUE(std::isnan(none.median));
    EXPECT_EQ(one.mean, 7);
    EXPECT_EQ(one.median, 7);
    EXPECT_TRUE(std::isnan(one.half_width));
    EXPECT_TRUE(std::isnan(one.deviation));
}

/// The chance that fewer than r of n values lie below the median: recursive binomials, no library.
double chanceBelow(int n, int r) {
    double term = std::pow(0.5, n), sum = 0;
    for (int k = 0; k < r; ++k) {
        sum += term;
        term *= static_cast<double>(n - k) / (k + 1);
    }
    return sum;
}

TEST(StatisticOf, MedianIntervalIsTheShortestThatHolds95Percent) {
    for (int n = 6; n <= 400; ++n) {
        std::vector<double> values;
        for (int i = n; i >= 1; --i) values.push_back(i);  // the i-th smallest is i
        const Statistic s = statisticOf(values);
        const int rank = static_cast<int>(s.median_low);
        EXPECT_EQ(s.median_high, n + 1 - rank) << n;
        EXPECT_LE(2 * chanceBelow(n, rank), 0.05) << n;
        EXPECT_GT(2 * chanceBelow(n, rank + 1), 0.05) << n;
    }
    const Statistic ten = statisticOf({1, 2, 3, 4, 5, 6, 7, 8, 9, 10});  // ranks 2 and 9 in any table
    EXPECT_EQ(ten.median_low, 2);
    EXPECT_EQ(ten.median_high, 9);
}

TEST(Scaled, ScalesEveryNumberButTheCount) {
    const Statistic s = scaled(statisticOf({1, 2, 3, 4, 5, 6}), 10),
                    direct = statisticOf({10, 20, 30, 40, 50, 60});
    EXPECT_EQ(s.count, 6);
    for (const auto value :
         {&Statistic::mean, &Statistic::half_width, &Statistic::deviation, &Statistic::median,
          &Statistic::median_low, &Statistic::median_high, &Statistic::minimum, &Statistic::maximum})
        EXPECT_DOUBLE_EQ(s.*value, direct.*value);
}

TEST(StatisticFields, AreAllNumbersOfAStatisticOnce) {
    std::set<std::string> names;
    Statistic s;
    for (const StatisticField& number : statistic_fields) {
        EXPECT_TRUE(std::isnan(s.*number.field)) << number.name << " is there twice";
        s.*number.field = 1;
        names.insert(number.name);
    }
    EXPECT_EQ(names.size(), statistic_fields.size());
    // A count, padded to the size of a double, and numbers: one not in the table would be left over.
    EXPECT_EQ(sizeof(Statistic), (1 + statistic_fields.size()) * sizeof(double));
}

TEST(RateOf, WilsonsInterval) {
    const Rate half = rateOf(5, 10), none = rateOf(0, 10), all = rateOf(10, 10), empty = rateOf(0, 0);
    // Newcombe, Statistics in Medicine 17, 1998 gives these limits to four digits for such cases.
    EXPECT_NEAR(half.low, 0.2366, 5e-5);
    EXPECT_NEAR(half.high, 0.7634, 5e-5);
    EXPECT_EQ(none.low, 0);
    EXPECT_NEAR(none.high, 1.959964 * 1.959964 / (10 + 1.959964 * 1.959964), 1e-6);  // z^2 / (n + z^2)
    EXPECT_EQ(all.high, 1);
    EXPECT_NEAR(all.low, 1 - none.high, 1e-12);
    EXPECT_TRUE(std::isnan(empty.rate));
}

TEST(CellsOf, RowsThatDifferInTheReplicateOnly) {
    std::vector<Row> rows = {rowOf("paper1", "classic", 2, 1), rowOf("paper1", "invariant", 1, 2),
                             rowOf("paper1", "classic", 1, 3), rowOf("paper1", "classic", 1, 4),
                             rowOf("paper1", "classic", 1, 5)};
    rows[3].config_point = {{"a.b", "1"}};
    rows[4].scenario_point = {{"a.b", "1"}};
    const std::vector<Cell> cells = cellsOf(rows);
    ASSERT_EQ(cells.size(), 4u);
    EXPECT_EQ(figureOf(cells[0], rmse), (std::vector<double>{3, 1})) << "by replicate";
    EXPECT_EQ(cells[1].variant, "invariant");
    EXPECT_EQ(cells[2].config_point, rows[3].config_point);
    EXPECT_EQ(cells[3].scenario_point, rows[4].scenario_point);
}

TEST(Compare, PairsByWorld) {
    const auto rows =
        rowsOf("paper1", "classic", {2, 2, 1, 0, 5}) + rowsOf("paper1", "invariant", {1, 2, 3, 4}) +
        std::vector<Row>{failedRow("paper1", "invariant", 5), rowOf("paper1", "invariant", 6, 9)};
    const auto cells = cellsOf(rows);
    const Paired pair = compare(cells[1], cells[0], rmse);
    EXPECT_EQ(pair.difference.count, 4) << "world 5 failed, world 6 is not in both";
    EXPECT_DOUBLE_EQ(pair.difference.mean, (-1 + 0 + 2 + 4) / 4.0);
    EXPECT_DOUBLE_EQ(pair.difference.median, 1);
    EXPECT_EQ(pair.ratio.count, 3) << "nothing is divided by zero";
    EXPECT_DOUBLE_EQ(pair.ratio.mean, (0.5 + 1 + 3) / 3);
    EXPECT_DOUBLE_EQ(pair.ratio.median, 1);
    EXPECT_EQ(pair.smaller, 1);
    EXPECT_EQ(pair.equal, 1);
    EXPECT_DOUBLE_EQ(pair.mean_a, 2.5);
    EXPECT_DOUBLE_EQ(pair.mean_b, 1.25);
}

TEST(Compare, RefusesOtherWorlds) {
    const auto rows = rowsOf("paper1", "classic", {1}) + rowsOf("quiet", "classic", {1});
    const auto cells = cellsOf(rows);
    EXPECT_THROW(compare(cells[0], cells[1], rmse), std::invalid_argument);
}

TEST(Divergence, CountsFarOffAndFailedRuns) {
    auto rows = rowsOf("paper1", "classic", {1, 11, 10, 200});
    rows.push_back(failedRow("paper1", "classic", 5));
    Row without_truth = rowOf("paper1", "classic", 6, 0);
    without_truth.metrics.clear();
    rows.push_back(without_truth);
    const Divergence d = divergence(cellsOf(rows).front(), 10);
    EXPECT_EQ(d.failed, 1);
    EXPECT_EQ(d.diverged, 3 - d.failed);
    EXPECT_EQ(d.lost.of, 5) << "a run without truth says nothing";
    EXPECT_DOUBLE_EQ(d.lost.rate, 0.6);
}

TEST(Divergence, AnErrorThatIsNotFiniteDiverged) {
    auto rows = rowsOf("paper1", "classic", {1, 1, 1});
    for (Row& row : rows) row.metrics["robot.position.count"] = 40;
    rows[1].metrics.erase("robot.position.rmse");  // summary.json has null, the row nothing
    const Divergence d = divergence(cellsOf(rows).front(), 10);
    EXPECT_EQ(d.failed, 0);
    EXPECT_EQ(d.diverged, 1);
    EXPECT_EQ(d.lost.of, 3);
}

TEST(FigureOf, AFailedRunHasNoCostsOrCounts) {
    auto rows = rowsOf("paper1", "classic", {1, 1}) + rowsOf("paper1", "invariant", {1, 1});
    for (Row& row : rows) {
        row.metrics["counts.landmarks"] = 8;
        row.cost.step_ms_mean = 2;
    }
    rows[1].status = "failed";
    rows[1].metrics["counts.landmarks"] = 1;
    rows[1].cost.step_ms_mean = 100;
    const auto cells = cellsOf(rows);
    for (const auto& [figure, value] :
         {std::pair("counts.landmarks", 8.0), std::pair("cost.step_ms_mean", 2.0)}) {
        const Statistic s = statisticOf(figureOf(cells[0], figure));
        EXPECT_EQ(s.count, 1) << figure;
        EXPECT_EQ(s.mean, value) << figure;
        EXPECT_EQ(compare(cells[0], cells[1], figure).difference.count, 1) << figure;
        EXPECT_EQ(compare(cells[1], cells[0], figure).difference.count, 1) << figure;
    }
}

TEST(ConsistencyOf, MeanOverRunsAgainstTheBandOfItsDegrees) {
    auto rows = rowsOf("paper1", "classic", {1, 1, 1});
    rows[0].series["robot_nees"] = {{0, 1}, {2, 30}, {3, 3}};
    rows[1].series["robot_nees"] = {{0, 1}, {4, 10}, {3, 3}};
    rows.push_back(failedRow("paper1", "classic", 4));
    rows[3].series["robot_nees"] = {{0}, {500}, {3}};
    const auto measured = consistencyOf(cellsOf(rows).front(), "robot_nees");
    ASSERT_TRUE(measured);
    EXPECT_EQ(measured->runs, 2) << "the third has no series, the fourth failed";
    ASSERT_EQ(measured->steps.size(), 2u);
    EXPECT_EQ(measured->steps[0].mean, 3);
    // Chi-square with 6 degrees of freedom: 2.5 % and 97.5 % at 1.2373 and 14.4494 in any table.
    EXPECT_NEAR(measured->steps[0].band.low, 1.2373 / 2, 1e-4);
    EXPECT_NEAR(measured->steps[0].band.high, 14.4494 / 2, 1e-4);
    EXPECT_EQ(measured->inside, 0.5);
    EXPECT_EQ(measured->above, 0.5);
    EXPECT_EQ(measured->average, (2 + 4 + 30 + 10) / 4.0);
}

TEST(ConsistencyOf, AbsentWithTheReason) {
    auto rows = rowsOf("paper1", "classic", {1});
    EXPECT_EQ(consistencyOf(cellsOf(rows).front(), "robot_nees").whyAbsent(),
              "no run has a series 'robot_nees'");
    rows[0].series["robot_error"] = {{0}, {1}, {}};
    EXPECT_EQ(consistencyOf(cellsOf(rows).front(), "robot_error").whyAbsent(),
              "series 'robot_error' has no dimensions, expected one of NEES");
}

TEST(Rank, TiesShareAndFailedRunsAreLast) {
    const std::vector<Row> rows = {// world 1: b first, a and c share 2 and 3
                                   rowOf("s", "a", 1, 5), rowOf("s", "b", 1, 1), rowOf("s", "c", 1, 5),
                                   // world 2: c failed
                                   rowOf("s", "a", 2, 2), rowOf("s", "b", 2, 3), failedRow("s", "c", 2),
                                   // world 3: c is not there; world 4: all failed; neither counts
                                   rowOf("s", "a", 3, 1), rowOf("s", "b", 3, 2), failedRow("s", "a", 4),
                                   failedRow("s", "b", 4), failedRow("s", "c", 4),
                                   // a source not asked for
                                   rowOf("t", "a", 1, 9), rowOf("t", "b", 1, 8), rowOf("t", "c", 1, 7)};
    const auto ranked = rank(rows, {"s"}, {"c", "a", "b"}, rmse);
    ASSERT_EQ(ranked.size(), 3u);
    EXPECT_EQ(ranked[0].variant, "c");
    EXPECT_DOUBLE_EQ(ranked[0].rank.mean, (2.5 + 3) / 2);
    EXPECT_DOUBLE_EQ(ranked[1].rank.mean, (2.5 + 1) / 2);
    EXPECT_DOUBLE_EQ(ranked[2].rank.mean, (1 + 2) / 2.0);
    for (const Ranked& r : ranked) EXPECT_EQ(r.rank.count, 2);
}

TEST(Rank, PointsOfAGridAreNoFurtherWorlds) {
    std::vector<Row> rows = rowsOf("s", "a", {1, 1}) + rowsOf("s", "b", {2, 2});
    for (const char* value : {"1", "2"}) {  // at world 1, b is the better at two more points
        rows.push_back(rowOf("s", "a", 1, 5));
        rows.push_back(rowOf("s", "b", 1, 4));
        for (std::size_t back : {1u, 2u}) rows[rows.size() - back].scenario_point = {{"x.y", value}};
    }
    const auto ranked = rank(rows, {"s"}, {"a", "b"}, rmse);
    EXPECT_EQ(ranked[0].rank.count, 2);
    EXPECT_DOUBLE_EQ(ranked[0].rank.mean, ((1 + 2 + 2) / 3.0 + 1) / 2);
    EXPECT_DOUBLE_EQ(ranked[1].rank.mean, ((2 + 1 + 1) / 3.0 + 2) / 2);
}

TEST(Rank, AWorldWhereOneHasNoSuchFigureDoesNotCount) {
    Row without = rowOf("s", "b", 1, 0);
    without.metrics.clear();
    for (const Ranked& r : rank({rowOf("s", "a", 1, 5), without}, {"s"}, {"a", "b"}, rmse))
        EXPECT_EQ(r.rank.count, 0);
}

}  // namespace analysis_test
}  // namespace slamot::study
