#include "AnalysisReader.h"

#include <fmt/format.h>

#include <algorithm>

#include "FigureNames.h"
#include "slamot/study/Series.h"

namespace slamot::study {
namespace {

const std::vector<std::pair<std::string, TableKind>> table_kinds = {{"means", TableKind::means},
                                                                    {"paired", TableKind::paired},
                                                                    {"consistency", TableKind::consistency},
                                                                    {"divergence", TableKind::divergence},
                                                                    {"ranks", TableKind::ranks},
                                                                    {"runs", TableKind::runs}};
const std::vector<std::pair<std::string, PlotKind>> plot_kinds = {
    {"over_parameter", PlotKind::over_parameter},
    {"against", PlotKind::against},
    {"over_time", PlotKind::over_time},
    {"bands", PlotKind::bands},
    {"one_run", PlotKind::one_run}};
const std::vector<std::pair<std::string, OneRunShow>> show_names = {
    {"map", OneRunShow::map},
    {"robot", OneRunShow::robot},
    {"target", OneRunShow::target},
    {"landmark_errors", OneRunShow::landmark_errors},
    {"correlation", OneRunShow::correlation},
    {"correlation_head", OneRunShow::correlation_head}};
const std::vector<std::pair<std::string, Shown>> shown_names = {
    {"mean", Shown::mean}, {"median", Shown::median}, {"both", Shown::both}};
const std::string figure_list = "names of figures separated by commas";

template <class Thing>
std::vector<std::string> namesOf(const std::vector<Thing>& things) {
    std::vector<std::string> names;
    for (const Thing& thing : things) names.push_back(thing.name);
    return names;
}

void addSelection(ParameterTable& table, Selection& selection) {
    addWords(table, "sources", selection.sources, "Which sources; by default all.");
    addWords(table, "configs", selection.configs, "Which configs; by default all.");
}

/// Which keys there are depends on the kind.
ParameterTable describe(TableSpec& spec) {
    ParameterTable table("table." + spec.name, "A table.");
    table.choice("kind", spec.kind, table_kinds, "What the table shows.");
    addSelection(table, spec.selection);
    table.text("caption", spec.caption, "A sentence above the table.");
    const bool of_series = spec.kind == TableKind::consistency;
    if (of_series) addWords(table, "series", spec.series, "Series of NEES.");
    if (!of_series && spec.kind != TableKind::divergence) {
        addWords(table, "figures", spec.figures, "Metrics or costs of a run, one column each.");
        table.choice("statistic", spec.shown, shown_names, "What is shown of many runs.");
    }
    if (spec.kind == TableKind::paired)
        table.text("baseline", spec.baseline, "The config others are compared with.");
    if (spec.kind != TableKind::divergence)
        table.integer("digits", spec.digits, Interval::between(1, 17), "Significant digits.");
    return table;
}

Parameter logarithmicAxes(PlotSpec& spec) {
    const std::string expected = "x | y | x, y | none";
    return {"logarithmic",
            "-",
            expected,
            "Logarithmic axes.",
            [&spec, expected](const std::string& text) -> std::optional<std::string> {
                std::string axes = text;
                axes.erase(std::remove(axes.begin(), axes.end(), ' '), axes.end());
                if (axes != "x" && axes != "y" && axes != "x,y" && axes != "none") return expected;
                spec.logarithmic_x = axes[0] == 'x';
                spec.logarithmic_y = axes == "y" || axes == "x,y";
                return std::nullopt;
            },
            [&spec] {
                return std::string(spec.logarithmic_x   ? spec.logarithmic_y ? "x, y" : "x"
                                   : spec.logarithmic_y ? "y"
                                                        : "none");
            }};
}

ParameterTable describe(PlotSpec& spec) {
    ParameterTable table("figure." + spec.name, "A figure.");
    table.choice("kind", spec.kind, plot_kinds, "What the figure shows.");
    if (spec.kind == PlotKind::one_run)
        return table.text("title", spec.title, "Stands above the figure.")
            .text("source", spec.source, "Of which source.")
            .text("config", spec.config, "Of which config.")
            .integer("replicate", spec.replicate, Interval::between(1, 1000000), "Of which world.")
            .choice("show", spec.show, show_names, "What of the run.");
    addSelection(table, spec.selection);
    table.text("title", spec.title, "Stands above the figure.");
    table.custom(logarithmicAxes(spec));
    if (spec.kind == PlotKind::over_parameter) {
        addWords(table, "figures", spec.figures, "Metrics or costs of a run, one panel each.");
        table.text("parameter", spec.parameter, "Address of the grid.");
    } else if (spec.kind == PlotKind::against) {
        addWords(table, "figures", spec.figures, "Two metrics or costs of a run, along x and y.");
    } else {
        addWords(table, "series", spec.series, "Series, one panel each.");
    }
    if (spec.kind != PlotKind::bands)
        table.choice("statistic", spec.shown, {shown_names[0], shown_names[1]},
                     "What is shown of many runs.");
    return table;
}

}  // namespace

void requireFigures(const StudyFile& study, const std::string& section, const std::string& key,
                    const std::vector<std::string>& figures) {
    const Config::Entry& entry = requiredEntry(study.text, section, key, figure_list);
    for (const std::string& figure : figures)
        if (!isFigure(figure)) {
            const auto near = nearestFigure(figure);
            refuse(
                entry, section,
                fmt::format(
                    "'{}' is no figure of a run, expected a number of summary.json's metrics or cost.<...>{}",
                    figure, near ? fmt::format("; did you mean '{}'?", *near) : ""));
        }
}

void requireSeries(const StudyFile& study, const std::string& section, const std::string& key,
                   const std::vector<std::string>& series) {
    const Config::Entry& entry =
        requiredEntry(study.text, section, key, "names of series separated by commas");
    for (const std::string& name : series)
        requireWord(entry, section, name, study.parameters.series, "series of [study]");
}

void requireNees(const StudyFile& study, const std::string& section, const std::string& key,
                 const std::vector<std::string>& series) {
    requireSeries(study, section, key, series);
    for (const std::string& name : series)
        if (!isNeesSeries(name))
            refuse(study.text.section(section).at(key), section,
                   fmt::format("series '{}' has no chi-square band, expected one of NEES (..._nees)", name));
}

void requireSource(const StudyFile& study, const Config::Entry& entry, const std::string& section,
                   const std::string& source) {
    requireWord(entry, section, source, namesOf(study.sources), "source");
}

void requireConfig(const StudyFile& study, const Config::Entry& entry, const std::string& section,
                   const std::string& config) {
    requireWord(entry, section, config, namesOf(study.variants), "config");
}

void completeSelection(const StudyFile& study, const std::string& section, Selection& selection) {
    const Config::Section& entries = study.text.section(section);
    for (const std::string& source : selection.sources)
        requireSource(study, entries.at("sources"), section, source);
    for (const std::string& config : selection.configs)
        requireConfig(study, entries.at("configs"), section, config);
    if (selection.sources.empty()) selection.sources = namesOf(study.sources);
    if (selection.configs.empty()) selection.configs = namesOf(study.variants);
}

TableSpec readTable(const StudyFile& study, const std::string& section) {
    TableSpec spec;
    spec.name = nameOf(study.text, section, "table.");
    spec.kind = requiredChoice(study.text, section, "kind", table_kinds);
    load(describe(spec), study.text);
    completeSelection(study, section, spec.selection);
    if (spec.kind == TableKind::consistency)
        requireNees(study, section, "series", spec.series);
    else if (spec.kind != TableKind::divergence)
        requireFigures(study, section, "figures", spec.figures);
    if (spec.kind == TableKind::paired)
        requireConfig(study, requiredEntry(study.text, section, "baseline", "the name of a config"), section,
                      spec.baseline);
    return spec;
}

PlotSpec readPlot(const StudyFile& study, const std::string& section) {
    PlotSpec spec;
    spec.name = nameOf(study.text, section, "figure.");
    spec.kind = requiredChoice(study.text, section, "kind", plot_kinds);
    load(describe(spec), study.text);
    if (spec.kind == PlotKind::one_run) {
        requireSource(study, requiredEntry(study.text, section, "source", "the name of a source"), section,
                      spec.source);
        requireConfig(study, requiredEntry(study.text, section, "config", "the name of a config"), section,
                      spec.config);
        return spec;
    }
    completeSelection(study, section, spec.selection);
    if (spec.kind == PlotKind::over_time || spec.kind == PlotKind::bands) {
        const auto require = spec.kind == PlotKind::bands ? requireNees : requireSeries;
        require(study, section, "series", spec.series);
        return spec;
    }
    requireFigures(study, section, "figures", spec.figures);
    if (spec.kind == PlotKind::against) {
        if (spec.figures.size() != 2)
            refuse(study.text.section(section).at("figures"), section,
                   fmt::format("{} in 'figures', expected two: along x and along y,", spec.figures.size()));
        return spec;
    }
    const Config::Entry& entry = requiredEntry(study.text, section, "parameter", "an address of the grid");
    std::vector<std::string> addresses = addressesOf(study.scenario_grid);
    for (const std::string& address : addressesOf(study.config_grid)) addresses.push_back(address);
    requireWord(entry, section, spec.parameter, addresses, "address of the grid");
    for (const auto* grid : {&study.scenario_grid, &study.config_grid})
        for (const GridPoint& point : *grid)
            for (const auto& [address, value] : point)
                if (address == spec.parameter && !numberFromText(value))
                    refuse(entry, section,
                           fmt::format("'{}' takes the value '{}', expected numbers along an axis", address,
                                       value));
    return spec;
}

}  // namespace slamot::study
