#pragma once
// What rows say together: means with intervals, paired differences, consistency, divergence, ranks. Runs are
// heavy-tailed, so whatever has a mean has a median beside it.
#include <limits>
#include <string>
#include <vector>

#include "slamot/eval/Consistency.h"
#include "slamot/study/Row.h"

namespace slamot::study {

/// The rows that differ in nothing but the replicate.
struct Cell {
    std::string source, variant;
    GridPoint scenario_point, config_point;
    std::vector<const Row*> rows;  ///< by replicate
};
/// In the order in which they first occur. The cells point into `rows`.
std::vector<Cell> cellsOf(const std::vector<Row>& rows);

bool hasFailed(const Row& row);

/// A figure of every row of the cell, in their order; NaN where the row has none or failed: costs and counts
/// of the part of a run that went well are not those of a run.
std::vector<double> figureOf(const Cell& cell, const std::string& figure);

/// Of the finite values among those given. A number that cannot be had from so few of them is NaN:
/// `half_width` and `deviation` need two, the median's interval six.
struct Statistic {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    int count = 0;
    /// `half_width`: of Student's 95 % interval of the mean.
    double mean = none, half_width = none, deviation = none;
    /// The interval is the shortest symmetric one between order statistics that holds the median with at
    /// least 95 %.
    double median = none, median_low = none, median_high = none;
    double minimum = none, maximum = none;
};
Statistic statisticOf(const std::vector<double>& values);

/// Of `factor` times the values, for a factor above zero.
Statistic scaled(Statistic statistic, double factor);

/// Differences a - b and ratios a / b of the rows of the same world that both have the figure, and in how
/// many of them a is the smaller, and neither. Failed rows have no figure; worlds where b is zero no ratio.
struct Paired {
    Statistic difference, ratio;
    int smaller = 0, equal = 0;
    /// Of the means over those worlds, a's and b's.
    double mean_a = Statistic::none, mean_b = Statistic::none;
};
/// Throws std::invalid_argument for cells of two sources or two points of the scenario's grid.
Paired compare(const Cell& a, const Cell& b, const std::string& figure);

/// Part of `of`, with Wilson's 95 % interval. NaN when `of` is zero.
struct Rate {
    int count = 0, of = 0;
    double rate = Statistic::none, low = Statistic::none, high = Statistic::none;
};
Rate rateOf(int count, int of);

/// Rows that failed, whose robot.position.rmse is above `diverged_above`, or whose errors from truth are not
/// finite. A row that did not fail and has no errors (no truth) says nothing and is not counted.
struct Divergence {
    Rate diverged;
    int failed = 0;
};
Divergence divergence(const Cell& cell, double diverged_above);

/// From the series `robot_nees` or another one with dimensions; absent when no row has it. Failed rows
/// are left out.
eval::Measured<eval::ConsistencyOverRuns> consistencyOf(const Cell& cell, const std::string& series);

/// A variant's rank by a figure over worlds: 1 is the smallest, ties share the mean of their ranks, a failed
/// run is last. Variants are ranked at each point of the grids where each has the figure or failed, and one
/// at least has it. All points of a replicate share its world's seed, so that their ranks are not
/// independent: their mean is the world's rank, and counts once.
struct Ranked {
    std::string variant;
    Statistic rank;
};
/// In the order of `variants`.
std::vector<Ranked> rank(const std::vector<Row>& rows, const std::vector<std::string>& sources,
                         const std::vector<std::string>& variants, const std::string& figure);

}  // namespace slamot::study
