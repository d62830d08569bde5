#include "slamot/report/Comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "ConfigLines.h"
#include "MetricRows.h"

namespace slamot::report {
namespace {

std::string folderName(const RunFolder& run) {
    const std::filesystem::path path = std::filesystem::path(run.folder).lexically_normal();
    return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

/// The settings without seeds.
std::string settingsOf(const RunFolder& run) {
    std::string settings;
    forEachConfigLine(run.text("config"),
                      [&](const std::string& section, const std::string& key, const std::string& line) {
                          if (key != "seed" || (section != "run" && section != "clutter")) {
                              settings += line + "\n";
                          }
                      });
    return settings;
}

/// What all names begin with, without the number or mark that it ends in.
std::string commonName(const std::vector<RunFolder>& runs) {
    std::string common = folderName(runs.front());
    for (const RunFolder& run : runs) {
        const std::string name = folderName(run);
        const auto differ = std::mismatch(common.begin(), common.end(), name.begin(), name.end());
        common.erase(differ.first, common.end());
    }
    while (!common.empty() && std::string("_-. 0123456789").find(common.back()) != std::string::npos) {
        common.pop_back();
    }
    return common.empty() ? runs.front().text("estimator") : common;
}

bool isComplete(const RunFolder& run) {
    return run.text("status") == "complete";
}

GroupValue valueOf(const MetricRow& row, const RunGroup& group) {
    std::vector<double> values;
    for (const RunFolder& run : group.runs) {
        if (const auto value = valueOf(row, run)) {
            values.push_back(*value);
        }
    }
    GroupValue result;
    result.count = values.size();
    result.of = group.runs.size();
    result.contests = result.count == result.of && completeRuns(group) == result.of;
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
        return a.contests && b.contests && isBetter(row, a.mean, b.mean);
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

std::vector<RunGroup> groupRuns(std::vector<RunFolder> runs) {
    std::vector<RunGroup> groups;
    std::map<std::string, std::size_t> place;
    for (RunFolder& run : runs) {
        const auto [found, is_new] = place.try_emplace(settingsOf(run), groups.size());
        if (is_new) {
            groups.emplace_back();
        }
        groups[found->second].runs.push_back(std::move(run));
    }
    std::map<std::string, int> used;
    for (RunGroup& group : groups) {
        group.name = group.runs.size() == 1 ? folderName(group.runs.front()) : commonName(group.runs);
        if (const int times = ++used[group.name]; times > 1) {
            group.name += fmt::format(" ({})", times);
        }
    }
    return groups;
}

std::vector<ComparedMetric> compareMetrics(const std::vector<RunGroup>& groups) {
    std::vector<ComparedMetric> compared;
    for (const MetricRow& row : metricRows()) {
        ComparedMetric metric{row.group, headingOf(row), {}};
        for (const RunGroup& group : groups) {
            metric.values.push_back(valueOf(row, group));
        }
        markBest(row, metric.values);
        if (std::any_of(metric.values.begin(), metric.values.end(),
                        [](const GroupValue& v) { return v.count > 0; })) {
            compared.push_back(std::move(metric));
        }
    }
    return compared;
}

}  // namespace slamot::report
