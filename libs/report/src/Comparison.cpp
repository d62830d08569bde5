#include "slamot/report/Comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "MetricRows.h"

namespace slamot::report {
namespace {

bool isComplete(const RunFolder& run) {
    return run.text("status") == "complete";
}

GroupValue valueOf(const MetricRow& row, const RunGroup& group) {
    std::vector<double> values;
    const bool some_are_complete = completeRuns(group) > 0;
    for (const RunFolder& run : group.runs) {
        const auto value = valueOf(row, run);
        if (value && (isComplete(run) || !some_are_complete)) {
            values.push_back(*value);
        }
    }
    GroupValue result;
    result.count = values.size();
    result.of = group.runs.size();
    result.contests =
        result.count == result.of && completeRuns(group) == result.of && result.of >= row.least_runs;
    const auto n = static_cast<double>(values.size());
    result.half_width = std::numeric_limits<double>::quiet_NaN();
    for (const double value : values) {
        result.mean += value / n;
    }
    if (values.size() > 1) {
        double squares = 0;
        for (const double value : values) {
            squares += (value - result.mean) * (value - result.mean);
        }
        const double t = boost::math::quantile(boost::math::students_t(n - 1), 0.975);
        result.half_width = t * std::sqrt(squares / (n - 1) / n);
    }
    return result;
}

void markBest(const MetricRow& row, std::vector<GroupValue>& values) {
    const auto beats = [&](const GroupValue& a, const GroupValue& b) {
        return a.contests && b.contests && shortNumber(a.mean) != shortNumber(b.mean) &&
               isBetter(row, a.mean, b.mean);
    };
    const bool differ = std::any_of(values.begin(), values.end(), [&](const GroupValue& a) {
        return std::any_of(values.begin(), values.end(), [&](const GroupValue& b) { return beats(a, b); });
    });
    for (GroupValue& value : values) {
        value.best = differ && value.contests &&
                     std::none_of(values.begin(), values.end(),
                                  [&](const GroupValue& other) { return beats(other, value); });
    }
}

std::set<std::string> logsOf(const RunGroup& group) {
    std::set<std::string> logs;
    for (const RunFolder& run : group.runs) {
        logs.insert(run.log_file);
    }
    return logs;
}

bool areOfTheSameLogs(const std::vector<RunGroup>& groups) {
    return std::all_of(groups.begin(), groups.end(),
                       [&](const RunGroup& g) { return logsOf(g) == logsOf(groups.front()); });
}

}  // namespace

std::size_t completeRuns(const RunGroup& group) {
    return static_cast<std::size_t>(std::count_if(group.runs.begin(), group.runs.end(), isComplete));
}

std::string statusOf(const RunGroup& group) {
    const std::size_t complete = completeRuns(group), all = group.runs.size();
    if (complete == all) {
        return "complete";
    }
    const std::string one = group.runs.front().text("status");
    return all > 1 ? fmt::format("{} of {} complete", complete, all) : one.empty() ? "not known" : one;
}

std::vector<std::string> comparisonNotes(const std::vector<RunGroup>& groups) {
    std::vector<std::string> notes;
    if (!areOfTheSameLogs(groups)) {
        notes.push_back("These runs are not of the same logs, so none is marked as the best.");
    }
    for (const RunGroup& group : groups) {
        for (const RunFolder& run : group.runs) {
            if (run.lost_truth) {
                notes.push_back(
                    fmt::format("{}: plots are without truth: {}.", run.folder, run.why_no_truth));
            }
        }
    }
    return notes;
}

std::vector<ComparedMetric> compareMetrics(const std::vector<RunGroup>& groups) {
    std::vector<ComparedMetric> compared;
    const bool comparable = areOfTheSameLogs(groups);
    for (const MetricRow& row : metricRows()) {
        ComparedMetric metric{row.group, headingOf(row), {}};
        for (const RunGroup& group : groups) {
            metric.values.push_back(valueOf(row, group));
        }
        if (comparable) {
            markBest(row, metric.values);
        }
        if (std::any_of(metric.values.begin(), metric.values.end(),
                        [](const GroupValue& v) { return v.count > 0; })) {
            compared.push_back(std::move(metric));
        }
    }
    return compared;
}

}  // namespace slamot::report
