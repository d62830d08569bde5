#pragma once
// The numbers of summary.json that tables for people show.
#include <optional>
#include <string>
#include <vector>

#include "slamot/report/RunFolder.h"

namespace slamot::report {

/// Which of several values is the best: the smallest, the largest, or the one nearest to 1 in proportion.
enum class Better { none, smaller, larger, near_one };

struct MetricRow {
    std::string group, name;
    std::string unit;  ///< empty for pure numbers
    Better better = Better::none;
    std::string path;               ///< in summary.json, as RunFolder::number has it
    double factor = 1;              ///< from the file's unit to `unit`
    std::string divisor_path = {};  ///< of what it is divided by; empty for 1
    std::size_t least_runs = 1;     ///< that decide which is the best; times depend on what else runs
};

/// In the order of tables; the rows of one group stand together.
const std::vector<MetricRow>& metricRows();

/// The value in the row's unit; nothing where the run has none.
std::optional<double> valueOf(const MetricRow& row, const RunFolder& run);

/// Name and unit.
std::string headingOf(const MetricRow& row);

/// Four significant digits; no exponent for what tables usually hold; "nan" and "inf" for what is none.
std::string shortNumber(double value);

/// Whether `a` is better than `b`; false for metrics without a best.
bool isBetter(const MetricRow& row, double a, double b);

}  // namespace slamot::report
