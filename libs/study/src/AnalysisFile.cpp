#include "slamot/study/AnalysisFile.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "AnalysisReader.h"

namespace slamot::study {
namespace {

/// From SI units and radians.
const std::vector<std::pair<std::string, DisplayUnit>> unit_names = {{"deg", {"deg", 57.295779513082320877}},
                                                                     {"mrad", {"mrad", 1e3}},
                                                                     {"mm", {"mm", 1e3}},
                                                                     {"cm", {"cm", 100}},
                                                                     {"km", {"km", 1e-3}},
                                                                     {"ms", {"ms", 1e3}},
                                                                     {"us", {"us", 1e6}},
                                                                     {"%", {"%", 100}}};

/// Everything the file's tables, figures and checks show.
std::vector<std::string> shownNames(const Analysis& analysis) {
    std::set<std::string> names;
    for (const TableSpec& table : analysis.tables) {
        names.insert(table.figures.begin(), table.figures.end());
        names.insert(table.series.begin(), table.series.end());
    }
    for (const PlotSpec& plot : analysis.plots) {
        names.insert(plot.figures.begin(), plot.figures.end());
        names.insert(plot.series.begin(), plot.series.end());
    }
    for (const CheckSpec& check : analysis.checks) {
        names.insert(check.figure);
        names.insert(check.series);
    }
    names.erase("");
    return {names.begin(), names.end()};
}

void readUnits(const Config& config, Analysis& analysis) {
    const std::string section = "units";
    for (const auto& [figure, entry] : config.section(section)) {
        requireWord(entry, section, figure, shownNames(analysis), "figure of a table, figure or check");
        DisplayUnit& unit = analysis.units[figure];
        std::vector<std::string> known;
        for (const auto& [name, value] : unit_names) {
            known.push_back(name);
            if (name == entry.value) unit = value;
        }
        requireWord(entry, section, entry.value, known, "unit");
    }
}

void readLabels(const StudyFile& study, Analysis& analysis) {
    const std::string section = "labels";
    std::vector<std::string> known = shownNames(analysis);
    for (const Source& source : study.sources) known.push_back(source.name);
    for (const Variant& variant : study.variants) known.push_back(variant.name);
    for (const auto* grid : {&study.scenario_grid, &study.config_grid})
        for (const std::string& address : addressesOf(*grid)) known.push_back(address);
    for (const char* column : {"source", "config", "replicate"}) known.push_back(column);
    for (const auto& [name, entry] : study.text.section(section)) {
        requireWord(entry, section, name, known, "figure, series, source, config or address shown anywhere");
        if (entry.value.empty()) refuse(entry, section, fmt::format("the label of '{}' is empty", name));
        analysis.labels[name] = entry.value;
    }
}

template <class Spec>
const Spec& named(const std::vector<Spec>& specs, const std::string& name, const char* what) {
    std::vector<std::string> known;
    for (const Spec& spec : specs) {
        if (spec.name == name) return spec;
        known.push_back(spec.name);
    }
    const auto near = nearestWord(name, known);
    throw ConfigError(fmt::format("the study has no {} '{}'{}", what, name,
                                  near ? fmt::format("; did you mean '{}'?", *near)
                                       : fmt::format(", it has: {}", fmt::join(known, ", "))));
}

}  // namespace

std::string Analysis::label(const std::string& name) const {
    if (const auto found = labels.find(name); found != labels.end()) return found->second;
    const auto unit = units.find(name);
    return unit == units.end() ? name : fmt::format("{} [{}]", name, unit->second.name);
}

double Analysis::factor(const std::string& figure) const {
    const auto unit = units.find(figure);
    return unit == units.end() ? 1 : unit->second.factor;
}

const TableSpec& Analysis::table(const std::string& name) const {
    return named(tables, name, "table");
}

const PlotSpec& Analysis::plot(const std::string& name) const {
    return named(plots, name, "figure");
}

std::vector<std::string> addressesOf(const std::vector<GridPoint>& grid) {
    std::vector<std::string> addresses;
    for (const GridPoint& point : grid)
        for (const auto& [address, value] : point)
            if (std::find(addresses.begin(), addresses.end(), address) == addresses.end())
                addresses.push_back(address);
    return addresses;
}

Analysis readAnalysis(const StudyFile& study) {
    Analysis analysis;
    for (const std::string& section : sectionsOf(study.text, "table."))
        analysis.tables.push_back(readTable(study, section));
    for (const std::string& section : sectionsOf(study.text, "figure."))
        analysis.plots.push_back(readPlot(study, section));
    for (const std::string& section : sectionsOf(study.text, "check."))
        analysis.checks.push_back(readCheck(study, section));
    readUnits(study.text, analysis);
    readLabels(study, analysis);
    return analysis;
}

}  // namespace slamot::study
