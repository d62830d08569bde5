#include <fmt/format.h>

#include <algorithm>

#include "AnalysisReader.h"
#include "CheckStatistic.h"
#include "Words.h"

namespace slamot::study {
namespace {

std::vector<std::pair<std::string, const CheckStatistic*>> statisticNames() {
    std::vector<std::pair<std::string, const CheckStatistic*>> names;
    for (const CheckStatistic& statistic : checkStatistics()) names.emplace_back(statistic.name, &statistic);
    return names;
}

const Variant& variantOf(const StudyFile& study, const std::string& name) {
    return *std::find_if(study.variants.begin(), study.variants.end(),
                         [&](const Variant& v) { return v.name == name; });
}

/// One point of a grid: the one that has all of the wanted values, none of them twice.
const GridPoint& onePoint(const std::vector<GridPoint>& grid, const GridPoint& wanted,
                          const std::string& section, const std::string& origin) {
    std::vector<const GridPoint*> found;
    for (const GridPoint& point : grid) {
        const bool matches = std::all_of(wanted.begin(), wanted.end(), [&](const auto& assignment) {
            const auto addresses = addressesOf({point});
            return std::find(addresses.begin(), addresses.end(), assignment.first) == addresses.end() ||
                   std::find(point.begin(), point.end(), assignment) != point.end();
        });
        if (matches) found.push_back(&point);
    }
    if (found.size() != 1)
        throw ConfigError(
            fmt::format("{}: [{}] is about {} points of the grid, expected one: where = {} = value", origin,
                        section, found.size(), fmt::join(addressesOf(grid), " = value; ")));
    return *found.front();
}

/// `address=value; address=value`, each of a grid of the study.
GridPoint readWhere(const StudyFile& study, const std::string& section) {
    const auto& entries = study.text.section(section);
    const auto found = entries.find("where");
    if (found == entries.end()) return {};
    const Config::Entry& entry = found->second;
    GridPoint wanted;
    for (const std::string& part : split(entry.value, ';')) {
        const auto equals = part.find('=');
        if (equals == std::string::npos)
            refuse(entry, section,
                   fmt::format("where = '{}', expected address=value; address=value", entry.value));
        const std::string address = trimmed(part.substr(0, equals)), value = trimmed(part.substr(equals + 1));
        std::vector<std::string> addresses = addressesOf(study.scenario_grid), values;
        for (const std::string& other : addressesOf(study.config_grid)) addresses.push_back(other);
        requireWord(entry, section, address, addresses, "address of the grid");
        for (const auto* grid : {&study.scenario_grid, &study.config_grid})
            for (const GridPoint& point : *grid)
                for (const auto& [other, taken] : point)
                    if (other == address && std::find(values.begin(), values.end(), taken) == values.end())
                        values.push_back(taken);
        requireWord(entry, section, value, values, "value of " + address);
        wanted.emplace_back(address, value);
    }
    return wanted;
}

ParameterTable describe(CheckSpec& spec, eval::Band& short_interval, std::string& where, eval::Band& window) {
    ParameterTable table("check." + spec.name, "A figure of the study that must lie in an interval.");
    table.text("source", spec.source, "Of which source.")
        .text("config", spec.config, "Of which config.")
        .text("where", where, "Of which point of the grid: address=value; address=value.")
        .choice("statistic", spec.statistic, statisticNames(), "What of all runs.");
    if (spec.statistic->ofPairs())
        table.text("against", spec.against, "The config compared with, world by world.");
    if (spec.statistic->ofSeries()) {
        table.text("series", spec.series, spec.statistic->ofNees() ? "A series of NEES." : "A series.");
        if (spec.statistic->ofWindow())
            addBounds(table, "window", window, "Time of the series [s], ends included.");
    } else if (spec.statistic->ofFigure()) {
        table.text("figure", spec.figure, "A metric or cost of a run.");
    }
    if (spec.statistic->ofFigure() || spec.statistic->ofSeries())
        table.real("missing", spec.missing, "-", Interval::probability(),
                   "Largest part of the runs that may be without the figure or series: failed ones.");
    addBounds(table, "interval", spec.interval, "Where it must lie in the full study.");
    addBounds(table, "short_interval", short_interval, "In the short form; absent: not checked there.");
    table.text("about", spec.about, "Why these bounds.");
    return table;
}

}  // namespace

CheckSpec readCheck(const StudyFile& study, const std::string& section) {
    const Config& config = study.text;
    CheckSpec spec;
    spec.name = nameOf(config, section, "check.");
    spec.statistic = requiredChoice(config, section, "statistic", statisticNames());
    eval::Band short_interval, window;
    std::string where;
    load(describe(spec, short_interval, where, window), config);
    if (spec.statistic->ofWindow()) {
        requiredEntry(config, section, "window", "'low, high'");
        spec.window = window;
    }
    if (config.section(section).count("short_interval") > 0) spec.short_interval = short_interval;
    requiredEntry(config, section, "interval", "'low, high'");

    requireSource(study, requiredEntry(config, section, "source", "the name of a source"), section,
                  spec.source);
    const auto requireRun = [&](const char* key, const std::string& name) {
        const Config::Entry& entry = requiredEntry(config, section, key, "the name of a config");
        requireConfig(study, entry, section, name);
        const std::vector<std::string>& on = variantOf(study, name).on;
        if (!on.empty() && std::find(on.begin(), on.end(), spec.source) == on.end())
            refuse(entry, section, fmt::format("config '{}' does not run on source '{}'", name, spec.source));
    };
    requireRun("config", spec.config);
    if (spec.statistic->ofPairs()) requireRun("against", spec.against);
    if (spec.statistic->ofNees())
        requireNees(study, section, "series", {spec.series});
    else if (spec.statistic->ofWindow())
        requireSeries(study, section, "series", {spec.series});
    else if (spec.statistic->ofFigure())
        requireFigures(study, section, "figure", {spec.figure});

    const GridPoint wanted = readWhere(study, section);
    const std::string origin = config.origin(section);
    spec.scenario_point = onePoint(study.scenario_grid, wanted, section, origin);
    spec.config_point = onePoint(study.config_grid, wanted, section, origin);
    return spec;
}

}  // namespace slamot::study
