#include "slamot/study/AnalysisFile.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "AnalysisReader.h"
#include "FigureNames.h"

namespace slamot::study {
namespace {

struct NamedUnit {
    std::string name;
    Dimension dimension;
    double factor;  ///< from SI units and radians
};
const std::vector<NamedUnit> unit_names = {
    {"deg", Dimension::angle, 57.295779513082320877},
    {"mrad", Dimension::angle, 1e3},
    {"rad", Dimension::angle, 1},
    {"mm", Dimension::length, 1e3},
    {"cm", Dimension::length, 100},
    {"m", Dimension::length, 1},
    {"km", Dimension::length, 1e-3},
    {"us", Dimension::time, 1e6},
    {"ms", Dimension::time, 1e3},
    {"s", Dimension::time, 1},
    {"%", Dimension::part, 100},
};

std::string inWords(Dimension dimension) {
    switch (dimension) {
        case Dimension::length:
            return "a length";
        case Dimension::angle:
            return "an angle";
        case Dimension::time:
            return "a time";
        case Dimension::part:
            return "a part of a whole";
        case Dimension::other:
            break;
    }
    return "a number";
}

/// Throws ConfigError for a unit of something else.
DisplayUnit displayUnit(const std::string& figure, const Config::Entry& entry, const std::string& section) {
    std::vector<std::string> known;
    for (const NamedUnit& unit : unit_names) known.push_back(unit.name);
    requireWord(entry, section, entry.value, known, "unit");
    const FigureUnit of = unitOf(figure);
    std::vector<std::string> fitting;
    for (const NamedUnit& unit : unit_names) {
        if (unit.dimension != of.dimension) continue;
        if (unit.name == entry.value) return {unit.name, unit.factor * of.si};
        fitting.push_back(unit.name);
    }
    refuse(entry, section,
           fmt::format("{} = '{}', but it is {}, expected {}", figure, entry.value, inWords(of.dimension),
                       fitting.empty() ? "no unit for it" : fmt::format("{}", fmt::join(fitting, " | "))));
}

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
        analysis.units[figure] = displayUnit(figure, entry, section);
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
