// What the run came to, in numbers.
#include <fmt/format.h>

#include "MetricRows.h"
#include "sections/Sections.h"

namespace slamot::report {
namespace {

PageTable metricsTable(const RunFolder& run) {
    PageTable table{"Metrics", {{"", false}, {"value"}}, {}};
    std::string group;
    for (const MetricRow& row : metricRows()) {
        const std::optional<double> value = valueOf(row, run);
        if (!value) {
            continue;
        }
        if (row.group != group) {
            group = row.group;
            table.rows.push_back({{{group}}, true});
        }
        table.rows.push_back({{{headingOf(row)}, {shortNumber(*value)}}});
    }
    return table;
}

PageTable runTable(const RunFolder& run) {
    PageTable table{"What was run", {{"", false}, {"", false}}, {}};
    const auto add = [&](const std::string& name, const std::string& value) {
        if (!value.empty()) {
            table.rows.push_back({{{name}, {value}}});
        }
    };
    const auto whole = [&](const char* path) {
        const std::optional<double> value = run.number(path);
        return value ? fmt::format("{}", *value) : std::string();
    };
    add("estimator", run.text("estimator"));
    add("detector", run.text("detector") == "none" ? "" : run.text("detector"));
    add("log", run.text("log"));
    add("truth", run.text("truth"));
    add("status", run.text("status"));
    add("why it ended", run.text("end_message"));
    add("seed", whole("seed"));
    add("version", fmt::format("{} {}", run.text("program"), run.text("version")));
    add("odometry readings", whole("counts/odometry"));
    add("detections", whole("counts/detections"));
    add("  used", whole("counts/detections_used"));
    add("  down-weighted", whole("counts/detections_inflated"));
    add("  rejected", whole("counts/detections_rejected"));
    add("  tentative", whole("counts/detections_tentative"));
    add("  ignored", whole("counts/detections_ignored"));
    return table;
}

std::string absent(const RunFolder&) {
    return {};
}

std::vector<Block> blocks(const RunFolder& run) {
    const PageTable metrics = metricsTable(run);
    std::vector<Block> result = {runTable(run)};
    if (!metrics.rows.empty()) {
        result.push_back(metrics);
    }
    for (const auto& warning : run.summary.value("warnings", nlohmann::json::array())) {
        if (warning.is_string()) {
            result.push_back(Paragraph{"Warning: " + warning.get<std::string>() + "."});
        }
    }
    return result;
}

}  // namespace

const ReportSection summary_section{"summary", "Summary",
                                    "NEES per degree of freedom is 1 where covariances tell the truth, more "
                                    "where they promise too much. Metrics are "
                                    "defined in doc/metrics.md.",
                                    absent, blocks};

}  // namespace slamot::report
