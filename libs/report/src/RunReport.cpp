#include "slamot/report/RunReport.h"

#include <fmt/format.h>

#include <filesystem>

#include "sections/Sections.h"

namespace slamot::report {

const std::vector<const ReportSection*>& runSections() {
    static const std::vector<const ReportSection*> sections = {
        &summary_section, &map_section,     &replay_section, &robot_error_section,    &track_error_section,
        &nees_section,     &nis_section,   &mode_section,    &landmark_error_section, &correlation_section,
        &particle_section, &count_section, &outcome_section, &time_section,           &drop_section,
        &configuration_section};
    return sections;
}

Page runPage(const RunFolder& run) {
    Page page;
    page.title = fmt::format("{} on {}", run.text("estimator"),
                             std::filesystem::path(run.text("log")).filename().string());
    const auto counted = [&](const char* name, const char* thing) {
        const double count = run.number(std::string("counts/") + name).value_or(0);
        return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
    };
    page.subtitle = fmt::format("{:.1f} s, {}, {} and {} at the end; {}", run.duration(),
                                counted("detections", "detection"), counted("landmarks", "landmark"),
                                counted("tracks_at_end", "track"), run.text("status"));
    PageSection missing{"not-shown", "Not shown", "", {}};
    for (const ReportSection* section : runSections()) {
        const std::string why = section->why_absent(run);
        if (!why.empty()) {
            missing.blocks.push_back(Paragraph{fmt::format("{}: {}.", section->title, why)});
            continue;
        }
        page.sections.push_back({section->id, section->title, section->about, section->blocks(run)});
    }
    if (!missing.blocks.empty()) {
        page.sections.push_back(missing);
    }
    page.footer = fmt::format("Made by {} {} from the files of the run; its figures are Vega specifications.",
                              run.text("program"), run.text("version"));
    return page;
}

void writeRunReport(const std::string& folder) {
    writePage(runPage(readRunFolder(folder)), folder + "/report.html");
}

}  // namespace slamot::report
