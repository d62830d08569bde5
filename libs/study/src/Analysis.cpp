#include "slamot/study/Analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "Words.h"

namespace slamot::study {
namespace {

/// The errors were measured: a truth was there. Where the rmse is not finite, the row lacks it nonetheless.
bool hasTruth(const Row& row) {
    return row.metrics.count("robot.position.count") > 0;
}

/// As figureOf(Cell) has it.
double figureOfEnded(const Row& row, const std::string& figure) {
    return hasFailed(row) ? Statistic::none : figureOf(row, figure);
}

/// 1 for the smallest; equal values share the mean of the ranks they take up.
std::vector<double> ranksOf(const std::vector<double>& values) {
    std::vector<double> ranks;
    for (const double value : values) {
        const auto smaller = std::count_if(values.begin(), values.end(), [&](double v) { return v < value; });
        const auto equal = std::count(values.begin(), values.end(), value);
        ranks.push_back(static_cast<double>(smaller) + static_cast<double>(equal + 1) / 2);
    }
    return ranks;
}

using Values = std::map<std::string, double>;  // by variant

/// In the order of `variants`; empty where one of them has no value or none a finite one.
std::vector<double> ranksAt(const Values& by_variant, const std::vector<std::string>& variants) {
    std::vector<double> values;
    for (const std::string& variant : variants)
        if (const auto found = by_variant.find(variant); found != by_variant.end())
            values.push_back(found->second);
    const bool one_ended =
        std::any_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    if (values.size() != variants.size() || !one_ended) return {};
    return ranksOf(values);
}

}  // namespace

bool hasFailed(const Row& row) {
    return row.status == "failed";
}

std::vector<Cell> cellsOf(const std::vector<Row>& rows) {
    std::vector<Cell> cells;
    std::map<std::tuple<std::string, GridPoint, std::string, GridPoint>, std::size_t> places;
    for (const Row& row : rows) {
        const auto [place, is_new] =
            places.try_emplace({row.source, row.scenario_point, row.variant, row.config_point}, cells.size());
        if (is_new) cells.push_back({row.source, row.variant, row.scenario_point, row.config_point, {}});
        cells[place->second].rows.push_back(&row);
    }
    for (Cell& cell : cells)
        std::stable_sort(cell.rows.begin(), cell.rows.end(),
                         [](const Row* a, const Row* b) { return a->replicate < b->replicate; });
    return cells;
}

std::vector<double> figureOf(const Cell& cell, const std::string& figure) {
    std::vector<double> values;
    for (const Row* row : cell.rows) values.push_back(figureOfEnded(*row, figure));
    return values;
}

Paired compare(const Cell& a, const Cell& b, const std::string& figure) {
    if (a.source != b.source || a.scenario_point != b.scenario_point)
        throw std::invalid_argument(
            fmt::format("runs of '{}' and '{}' are not of the same worlds", a.source, b.source));
    std::map<int, double> value_of_b;  // by replicate
    for (const Row* row : b.rows) value_of_b[row->replicate] = figureOfEnded(*row, figure);

    Paired paired;
    std::vector<double> values_a, values_b, differences, ratios;
    for (const Row* row : a.rows) {
        const auto found = value_of_b.find(row->replicate);
        const double in_a = figureOfEnded(*row, figure);
        if (found == value_of_b.end() || !std::isfinite(in_a) || !std::isfinite(found->second)) continue;
        const double in_b = found->second;
        values_a.push_back(in_a);
        values_b.push_back(in_b);
        differences.push_back(in_a - in_b);
        if (in_b != 0) ratios.push_back(in_a / in_b);
        paired.smaller += in_a < in_b;
        paired.equal += in_a == in_b;
    }
    paired.difference = statisticOf(differences);
    paired.ratio = statisticOf(ratios);
    paired.mean_a = statisticOf(values_a).mean;
    paired.mean_b = statisticOf(values_b).mean;
    return paired;
}

Divergence divergence(const Cell& cell, double diverged_above) {
    int diverged = 0, failed = 0, known = 0;
    for (const Row* row : cell.rows) {
        const double rmse = figureOf(*row, "robot.position.rmse");
        failed += hasFailed(*row);
        if (!hasFailed(*row) && !hasTruth(*row) && std::isnan(rmse)) continue;
        ++known;
        diverged += !hasFailed(*row) && (!std::isfinite(rmse) || rmse > diverged_above);
    }
    return {failed, diverged, rateOf(failed + diverged, known)};
}

eval::Measured<eval::ConsistencyOverRuns> consistencyOf(const Cell& cell, const std::string& name) {
    using Result = eval::Measured<eval::ConsistencyOverRuns>;
    std::vector<eval::NeesSeries> runs;
    for (const Row* row : cell.rows) {
        const auto found = row->series.find(name);
        if (hasFailed(*row) || found == row->series.end()) continue;
        const Series& series = found->second;
        if (series.dimension.size() != series.value.size() || series.seconds.size() != series.value.size())
            return Result::absent(fmt::format("series '{}' has no dimensions, expected one of NEES", name));
        eval::NeesSeries& run = runs.emplace_back();
        for (std::size_t i = 0; i < series.value.size(); ++i)
            if (std::isfinite(series.value[i]))
                run.push_back({Stamp::fromSeconds(series.seconds[i]),
                               {series.value[i], static_cast<int>(std::lround(series.dimension[i]))}});
    }
    if (runs.empty()) return Result::absent(fmt::format("no run has a series '{}'", name));
    return eval::consistencyOverRuns(runs, 0.95);
}

std::vector<Ranked> rank(const std::vector<Row>& rows, const std::vector<std::string>& sources,
                         const std::vector<std::string>& variants, const std::string& figure) {
    // A failed run is worse than any that ended.
    using Points = std::map<std::pair<GridPoint, GridPoint>, Values>;
    std::map<std::pair<std::string, int>, Points> worlds;
    for (const Row& row : rows) {
        if (!contains(sources, row.source) || !contains(variants, row.variant)) continue;
        const double value = hasFailed(row) ? std::numeric_limits<double>::infinity() : figureOf(row, figure);
        if (!std::isnan(value))
            worlds[{row.source, row.replicate}][{row.scenario_point, row.config_point}][row.variant] = value;
    }

    std::vector<std::vector<double>> ranks(variants.size());
    for (const auto& [world, points] : worlds) {
        std::vector<double> sums(variants.size(), 0);
        int count = 0;
        for (const auto& [point, by_variant] : points) {
            const std::vector<double> here = ranksAt(by_variant, variants);
            if (here.empty()) continue;
            ++count;
            for (std::size_t i = 0; i < variants.size(); ++i) sums[i] += here[i];
        }
        if (count == 0) continue;
        for (std::size_t i = 0; i < variants.size(); ++i) ranks[i].push_back(sums[i] / count);
    }

    std::vector<Ranked> result;
    for (std::size_t i = 0; i < variants.size(); ++i) result.push_back({variants[i], statisticOf(ranks[i])});
    return result;
}

}  // namespace slamot::study
