#include "slamot/study/Report.h"

#include <fmt/format.h>

#include <algorithm>

#include "slamot/core/Version.h"
#include "slamot/report/FigureWriter.h"
#include "slamot/report/Page.h"
#include "slamot/study/Figures.h"

namespace slamot::study {
namespace {

report::PageTable pageTable(const Table& table, const std::string& name) {
    report::PageTable result{table.caption.empty() ? name : table.caption, {}, {}};
    for (const Column& column : table.columns) result.columns.push_back({column.heading, column.numeric});
    for (const TableLine& line : table.lines) {
        report::TableRow row;
        row.strong = line.summary;
        for (const Field& field : line.fields) row.cells.push_back({field.shown});
        result.rows.push_back(std::move(row));
    }
    return result;
}

report::PageSection tableSection(const Findings& findings) {
    report::PageSection section{
        "tables",
        "Tables",
        "Means with the half width of their 95 % interval behind ±, and the median in parentheses where a table "
        "shows both; an interval in brackets is of the value before it. Captions say more.",
        {}};
    for (const TableSpec& spec : findings.analysis.tables)
        section.blocks.push_back(pageTable(makeTable(spec, findings), spec.name));
    return section;
}

report::PageSection figureSection(const Findings& findings) {
    report::PageSection section{"figures", "Figures", "", {}};
    for (const PlotSpec& spec : findings.analysis.plots) {
        const std::string title = spec.title.empty() ? spec.name : spec.title;
        section.blocks.push_back(report::PageFigure{spec.name, title, makeFigure(spec, findings), ""});
    }
    return section;
}

report::PageSection runSection(const Findings& findings, const Provenance& provenance) {
    report::PageTable configs{"Configurations", {{"name", false}, {"settings of its own", false}}, {}};
    for (const Variant& variant : findings.study.variants) {
        std::string settings = variant.overrides.canonicalText();
        std::replace(settings.begin(), settings.end(), '\n', ' ');
        configs.rows.push_back({{{findings.analysis.label(variant.name)}, {settings}}});
    }
    return {"runs",
            "What was run",
            "",
            {report::Paragraph{"Made on " + originText(provenance, findings) + "."}, configs,
             report::Paragraph{"The command that makes this page again:"},
             report::Verbatim{provenance.command, "", true}}};
}

}  // namespace

void writeReport(const std::string& file, const Findings& findings, const Provenance& provenance,
                 const CheckReport* checks) {
    report::Page page;
    page.title = "Study " + findings.study.name;
    page.subtitle = findings.study.parameters.about;
    if (checks) {
        const std::string verdict = checks->passed() ? "All checks passed." : "Not all checks passed.";
        page.sections.push_back({"checks", "Checks", verdict, {pageTable(checkTable(*checks), "Checks")}});
    }
    if (!findings.analysis.tables.empty()) page.sections.push_back(tableSection(findings));
    if (!findings.analysis.plots.empty()) page.sections.push_back(figureSection(findings));
    page.sections.push_back(runSection(findings, provenance));
    page.footer = fmt::format("Made by slamot {} from the rows of the study.", version);
    report::writePage(page, file);
}

}  // namespace slamot::study
