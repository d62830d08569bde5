// A comparison for the terminal.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "Text.h"
#include "slamot/report/Comparison.h"

namespace slamot::report {
namespace {

constexpr std::size_t name_width = 32, column_width = 16, columns = 3;  // 32 + 3 * 16 = 80

/// Three significant digits where there is an interval, so that both fit.
std::string cell(const GroupValue& value) {
    if (value.count == 0) {
        return "-";
    }
    const std::string text = std::isfinite(value.half_width)
                                 ? fmt::format("{:.3g}+-{:.2g}", value.mean, value.half_width)
                                 : fmt::format("{:.4g}", value.mean);
    return value.best ? text + "*" : text + " ";
}

/// The end of a long text: names of runs differ there.
std::string fitted(const std::string& text, std::size_t width) {
    return text.size() <= width ? text : ".." + text.substr(text.size() - width + 2);
}

}  // namespace

std::string comparisonText(const std::vector<RunGroup>& groups) {
    const std::vector<ComparedMetric> metrics = compareMetrics(groups);
    std::string text;
    for (std::size_t first = 0; first < groups.size(); first += columns) {
        const std::size_t end = std::min(first + columns, groups.size());
        text += first > 0 ? "\n" : "";
        text += fmt::format("{:{}}", "", name_width);
        for (std::size_t g = first; g < end; ++g) {
            text += fmt::format("{:>{}} ", fitted(groups[g].name, column_width - 2), column_width - 1);
        }
        text += fmt::format("\n{:{}}", "runs", name_width);
        for (std::size_t g = first; g < end; ++g) {
            text += fmt::format("{:>{}} ", groups[g].runs.size(), column_width - 1);
        }
        text += "\n";
        std::string group;
        for (const ComparedMetric& metric : metrics) {
            if (metric.group != group) {
                group = metric.group;
                text += group + "\n";
            }
            // The degree sign has two bytes and one column.
            const std::size_t extra = metric.heading.find("°") != std::string::npos ? 1 : 0;
            text += fmt::format("  {:{}}", metric.heading, name_width - 2 + extra);
            for (std::size_t g = first; g < end; ++g) {
                text += fmt::format("{:>{}}", cell(metric.values[g]), column_width);
            }
            text += "\n";
        }
    }
    return text + "* the best of its row; where intervals (95 %) overlap that may be chance\n";
}

}  // namespace slamot::report
