// A comparison for the terminal.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "Text.h"
#include "slamot/eval/TerminalText.h"
#include "slamot/report/Comparison.h"

namespace slamot::report {
namespace {

constexpr std::size_t name_width = 32, usual_width = 16;  // 32 + 3 * 16 = 80

/// Three significant digits where there is an interval, so that both fit.
std::string cell(const GroupValue& value) {
    if (value.count == 0) {
        return "- ";
    }
    std::string text = std::isfinite(value.half_width)
                           ? fmt::format("{:.3g}+-{:.2g}", value.mean, value.half_width)
                           : fmt::format("{:.4g}", value.mean);
    if (value.count < value.of) {
        text += fmt::format(" n={}", value.count);
    }
    return text + (value.best ? "*" : " ");
}

std::string left(const std::string& text, std::size_t width) {
    return text + std::string(width - std::min(width, codePoints(text)), ' ');
}

std::string right(const std::string& text, std::size_t width) {
    return std::string(width - std::min(width, codePoints(text)), ' ') + text;
}

/// The groups of one block side by side.
struct Block {
    std::size_t first, end, width;

    template <class CellOf>
    std::string line(const std::string& name, CellOf cell_of) const {
        std::string text = left(name, name_width);
        for (std::size_t g = first; g < end; ++g) {
            text += right(cell_of(g), width);
        }
        return text + "\n";
    }
};

/// At most so many: two estimators of different kinds differ in more than one reads.
constexpr std::size_t most_settings = 8;

std::string settingText(const Block& block, const std::vector<ComparedSetting>& settings) {
    std::string text = settings.empty() ? "" : "Settings that differ\n", section;
    for (std::size_t i = 0; i < std::min(settings.size(), most_settings); ++i) {
        if (settings[i].section != section) {
            section = settings[i].section;
            text += fmt::format("  [{}]\n", section);
        }
        const auto value = [&](std::size_t g) {
            return settings[i].values[g].empty() ? "-" : settings[i].values[g];
        };
        text +=
            block.line(firstCodePoints("    " + settings[i].key, name_width - 1, ".."),
                       [&](std::size_t g) { return firstCodePoints(value(g), block.width - 2, "..") + " "; });
    }
    return settings.size() <= most_settings
               ? text
               : text + fmt::format("  and {} more, see the page\n", settings.size() - most_settings);
}

std::string blockText(const Block& block, const std::vector<RunGroup>& groups,
                      const std::vector<ComparedMetric>& metrics) {
    std::string text = block.line(
        "", [&](std::size_t g) { return lastCodePoints(groups[g].name, block.width - 2, "..") + " "; });
    text += block.line("runs", [&](std::size_t g) { return fmt::format("{} ", groups[g].runs.size()); });
    text += block.line("status", [&](std::size_t g) { return statusOf(groups[g]) + " "; });
    text += settingText(block, compareSettings(groups));
    std::string heading;
    for (const ComparedMetric& metric : metrics) {
        if (metric.group != heading) {
            heading = metric.group;
            text += heading + "\n";
        }
        text += block.line("  " + metric.heading, [&](std::size_t g) { return cell(metric.values[g]); });
    }
    return text;
}

}  // namespace

std::string comparisonText(const std::vector<RunGroup>& groups) {
    const std::vector<ComparedMetric> metrics = compareMetrics(groups);
    // Long numbers take columns from their neighbours: fewer groups stand side by side.
    std::size_t width = usual_width;
    bool some_lack_it = false, some_broke_off = false, some_best = false, some_interval = false;
    for (const RunGroup& group : groups) {
        width = std::max(width, 2 + statusOf(group).size());
        some_broke_off = some_broke_off || completeRuns(group) < group.runs.size();
    }
    for (const ComparedMetric& metric : metrics) {
        for (const GroupValue& value : metric.values) {
            width = std::max(width, 1 + cell(value).size());
            some_best = some_best || value.best;
            some_interval = some_interval || std::isfinite(value.half_width);
            some_lack_it = some_lack_it || (value.count > 0 && value.count < value.of);
        }
    }
    const std::size_t columns = std::max<std::size_t>(1, (eval::terminal_width - name_width) / width);
    std::string text;
    for (std::size_t first = 0; first < groups.size(); first += columns) {
        text += first > 0 ? "\n" : "";
        text += blockText({first, std::min(first + columns, groups.size()), width}, groups, metrics);
    }
    text += some_best ? "* the best of its row\n" : "";
    text += some_best && some_interval ? "  where intervals (+-, 95 %) overlap that may be chance\n" : "";
    text += some_broke_off ? "  runs that did not come to the end of their log are never the best\n" : "";
    text += some_lack_it ? "  n: runs with a value, where not all of a column have one\n" : "";
    for (const std::string& note : comparisonNotes(groups)) {
        text += eval::wrapped(note, 0, 2);
    }
    return text;
}

}  // namespace slamot::report
