#pragma once
// What rows say together: means with intervals, paired differences, consistency, divergence, ranks.
#include <optional>
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
std::vector<Cell> cellsOf(const std::vector<Row>& rows);

/// Of the finite values. The interval is Student's t at 95 % for the mean; for the median by order statistics.
struct Statistic {
    int count = 0;
    double mean = 0, half_width = 0, deviation = 0, median = 0, median_low = 0, median_high = 0;
};
Statistic statisticOf(const std::vector<double>& values);

/// Differences a - b of rows of the same world, and in how many of them a is the smaller.
struct Paired {
    Statistic difference, ratio;
    int smaller = 0;
};
Paired compare(const Cell& a, const Cell& b, const std::string& figure);

/// Part of the rows that diverged, with Wilson's 95 % interval.
struct Rate {
    int count = 0, of = 0;
    double rate = 0, low = 0, high = 0;
};
Rate divergence(const Cell& cell, double diverged_above);

/// From the series robot_nees (or another name); absent when no row has it.
eval::Measured<eval::ConsistencyOverRuns> consistencyOf(const Cell& cell, const std::string& series);

/// Mean over worlds of each variant's rank by a figure (1 is the smallest; ties share), where all variants ran.
struct Ranked {
    std::string variant;
    double mean_rank = 0;
    int worlds = 0;
};
std::vector<Ranked> rank(const std::vector<Row>& rows, const std::vector<std::string>& sources,
                         const std::vector<std::string>& variants, const std::string& figure);

}  // namespace slamot::study
