// What the run came to, in numbers.
#include <fmt/format.h>

#include "MetricRows.h"
#include "sections/Sections.h"

namespace slamot::report {
namespace section_summary {

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
    add("estimator", run.text("estimator"));
    add("detector", run.text("detector") == "none" ? "" : run.text("detector"));
    add("log", run.text("log"));
    add("truth", run.truth_folder);
    add("status", run.text("status"));
    add("why it ended", run.text("end_message"));
    add("seed", run.digits("seed"));
    add("version", fmt::format("{} {}", run.text("program"), run.text("version")));
    add("odometry readings", run.digits("counts/odometry"));
    add("detections", run.digits("counts/detections"));
    add("  used", run.digits("counts/detections_used"));
    add("  down-weighted", run.digits("counts/detections_inflated"));
    add("  rejected", run.digits("counts/detections_rejected"));
    add("  tentative", run.digits("counts/detections_tentative"));
    add("  ignored", run.digits("counts/detections_ignored"));
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
    for (const auto& warning : run.list("warnings")) {
        if (warning.is_string()) {
            result.push_back(Paragraph{"Warning: " + warning.get<std::string>() + "."});
        }
    }
    return result;
}

}  // namespace section_summary

const ReportSection summary_section{"summary", "Summary",
                                    "NEES per degree of freedom is 1 where covariances tell the truth, more "
                                    "where they promise too much. Metrics are "
                                    "defined in doc/metrics.md.",
                                    section_summary::absent, section_summary::blocks};

}  // namespace slamot::report
