// Reading study files; doc/studies.md is their reference.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "SectionReader.h"
#include "Sources.h"
#include "Words.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/study/Plan.h"
#include "slamot/study/Series.h"

namespace slamot::study {
namespace {

namespace fs = std::filesystem;

const std::string scenario_prefix = "scenario.", log_prefix = "log.", told_prefix = "told.",
                  config_prefix = "config.";
/// Sections of Analysis, which reads them itself.
const std::vector<std::string> analysis_prefixes = {"table.", "figure.", "check."};

[[noreturn]] void fail(const std::string& origin, const std::string& what) {
    throw ConfigError(origin + ": " + what);
}

struct Setting {
    std::string key, value, origin;
};

/// A section's settings in the order of the file.
std::vector<Setting> settingsOf(const Config& text, const std::string& section) {
    std::vector<Setting> settings;
    for (const auto& [key, entry] : text.section(section))
        settings.push_back({key, entry.value, entry.origin});
    std::sort(settings.begin(), settings.end(),
              [](const Setting& a, const Setting& b) { return lineOf(a.origin) < lineOf(b.origin); });
    return settings;
}

/// Names of the sections that start with `prefix`, in the order of the file, without it.
std::vector<std::string> namesAfter(const Config& text, const std::string& prefix) {
    std::vector<std::string> sections = sectionsOf(text, prefix);
    for (std::string& section : sections) {
        const std::string name = section.substr(prefix.size());
        if (!isPlainName(name))
            fail(text.origin(section),
                 fmt::format("[{}], expected a name of letters, digits, '_' and '-' after '{}'", section,
                             prefix));
        section = name;
    }
    return sections;
}

/// `section.key`, split at the last dot as `--set` does. A seed is the study's own to set.
std::pair<std::string, std::string> addressOf(const Setting& setting) {
    const auto dot = setting.key.rfind('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == setting.key.size())
        fail(setting.origin, fmt::format("'{}', expected section.key", setting.key));
    if (setting.key == "run.seed" || setting.key == "clutter.seed")
        fail(setting.origin, setting.key + " is derived for every run, expected [study] seed instead");
    return {setting.key.substr(0, dot), setting.key.substr(dot + 1)};
}

/// Settings without a dot are the section's own and must be known; the others are overrides, which go into
/// `config`.
class SourceSection {
  public:
    SourceSection(const Config& text, std::string name, std::vector<std::string> known, bool overrides)
        : text_(text), name_(std::move(name)) {
        for (const Setting& setting : settingsOf(text, name_)) {
            if (overrides && setting.key.find('.') != std::string::npos) {
                overrides_.push_back(setting);
                continue;
            }
            if (std::find(known.begin(), known.end(), setting.key) == known.end()) {
                const auto near = nearestWord(setting.key, known);
                fail(setting.origin,
                     fmt::format(
                         "unknown key '{}' in [{}]{}, expected {}{}", setting.key, name_,
                         near ? "; did you mean '" + *near + "'?" : "", fmt::join(known, ", "),
                         overrides ? (known.empty() ? "section.key" : " or section.key of the file") : ""));
            }
            own_.push_back(setting);
        }
    }

    const Setting* find(const std::string& key) const {
        const auto found =
            std::find_if(own_.begin(), own_.end(), [&](const Setting& s) { return s.key == key; });
        return found == own_.end() || found->value.empty() ? nullptr : &*found;
    }
    std::string value(const std::string& key) const { return find(key) ? find(key)->value : std::string(); }

    /// The file that a key names, where it is given.
    std::optional<Config> file(const std::string& key, const std::string& what) const {
        const Setting* setting = find(key);
        if (!setting) return std::nullopt;
        const fs::path path = (fs::path(text_.folder()) / setting->value).lexically_normal();
        std::error_code ignored;
        if (!fs::is_regular_file(path, ignored))
            fail(setting->origin,
                 fmt::format("{} = '{}' in [{}] is not there ({}), expected {} relative to the study", key,
                             setting->value, name_, path.string(), what));
        return Config::fromFile(path.string());
    }
    Config overrides() const {
        Config config;
        for (const Setting& one : overrides_) {
            const auto [section, key] = addressOf(one);
            config.set(section, key, one.value, one.origin);
        }
        return config;
    }

  private:
    const Config& text_;
    std::string name_;
    std::vector<Setting> own_, overrides_;
};

void readStudySection(const Config& text, StudyParameters& p) {
    std::string series;
    ParameterTable table("study", "The study as a whole.");
    table.text("about", p.about, "What the study shows.")
        .seed("seed", p.seed, "Key of all worlds.")
        .integer("replicates", p.replicates, Interval::between(1, 1e6), "Worlds drawn of each scenario.")
        .integer("short_replicates", p.short_replicates, Interval::between(1, 1e6),
                 "The same, in the short form.")
        .real("diverged_above", p.diverged_above, "m", Interval::positive(),
              "A run whose position RMSE exceeds this counts as diverged.")
        .text("series", series, "Figures kept step by step.");
    load(table, text);
    p.series = split(series, ',');
    if (!p.series.empty()) requireKnownSeries(p.series, text.section("study").at("series").origin);
}

void readInteger(const SourceSection& section, const std::string& key, Interval interval, int& number) {
    const Setting* setting = section.find(key);
    if (!setting) return;
    ParameterTable table("", "");
    table.integer(key, number, interval, "");
    if (const auto expected = table.find(key)->parse(setting->value))
        fail(setting->origin, fmt::format("{} = '{}', expected {}", key, setting->value, *expected));
}

Source readScenario(const Config& text, const std::string& name) {
    const SourceSection section(text, scenario_prefix + name, {"file", "folder", "robot", "config"}, true);
    std::optional<Config> file = section.file("file", "a scenario");
    if (!file)
        fail(text.origin(scenario_prefix + name),
             fmt::format("[{}{}] has no 'file', expected a scenario", scenario_prefix, name));
    ScenarioSource source{withOverrides(*std::move(file), section.overrides()), 0, section.value("folder")};
    readInteger(section, "robot", Interval::between(0, 999999), source.robot);
    return {name, std::move(source), std::nullopt, section.file("config", "a run's config"), {}};
}

Source readLog(const Config& text, const std::string& name) {
    const std::string place = log_prefix + name;
    const SourceSection section(text, place, {"import", "folder", "files", "config", "replicates"}, false);
    LogSourceFiles source{section.value("import"), section.value("folder"), section.value("files"), 1};
    readInteger(section, "replicates", Interval::between(1, 1e6), source.replicates);
    if (source.files.empty())
        fail(text.origin(place),
             fmt::format("[{}] has no 'files', expected a pattern like robot_*.rawlog", place));
    if (!source.importer.empty() && source.folder.empty())
        fail(text.origin(place),
             fmt::format("[{}] has no 'folder', expected the dataset's folder in SLAMOT_DATASETS", place));
    return {name, std::nullopt, std::move(source), section.file("config", "a run's config"), {}};
}

Variant readVariant(const Config& text, const std::string& name, const std::vector<Source>& sources) {
    const SourceSection section(text, config_prefix + name, {"file", "on"}, true);
    Variant variant{name, section.file("file", "a run's config"), section.overrides(),
                    split(section.value("on"), ',')};
    std::vector<std::string> known;
    for (const Source& source : sources) known.push_back(source.name);
    for (const std::string& wanted : variant.on) {
        if (std::find(known.begin(), known.end(), wanted) != known.end()) continue;
        const auto near = nearestWord(wanted, known);
        fail(section.find("on")->origin,
             fmt::format("on = '{}' in [{}{}]: no source '{}'{}, expected some of {}", section.value("on"),
                         config_prefix, name, wanted, near ? " (did you mean '" + *near + "'?)" : "",
                         fmt::join(known, ", ")));
    }
    for (const Source& source : sources)
        if (!variant.file && !source.config && runsOn(variant, source))
            fail(text.origin(config_prefix + name),
                 fmt::format("[{}{}] has no 'file' and source {} no 'config', expected one of the two",
                             config_prefix, name, source.name));
    return variant;
}

/// All combinations of a grid section's values; the last key of the file runs fastest.
std::vector<GridPoint> readGrid(const Config& text, const std::string& section) {
    std::vector<GridPoint> points(1);
    for (const Setting& setting : settingsOf(text, section)) {
        addressOf(setting);
        const std::vector<std::string> values = split(setting.value, '|');
        if (values.empty() ||
            std::any_of(values.begin(), values.end(), [](const auto& v) { return v.empty(); }))
            fail(setting.origin, fmt::format("{} = '{}' in [{}], expected values separated by |", setting.key,
                                             setting.value, section));
        if (std::set<std::string>(values.begin(), values.end()).size() < values.size())
            fail(setting.origin, fmt::format("{} = '{}' in [{}] has a value twice, expected each once",
                                             setting.key, setting.value, section));
        std::vector<GridPoint> crossed;
        for (const GridPoint& point : points)
            for (const std::string& value : values) {
                crossed.push_back(point);
                crossed.back().emplace_back(setting.key, value);
            }
        points = std::move(crossed);
    }
    return points;
}

/// A key that a section sets and the grid sets again would never have the section's value.
void requireKeysOutsideGrid(const Config& text, const std::string& grid, const std::string& prefix) {
    for (const std::string& name : namesAfter(text, prefix))
        for (const auto& [key, entry] : text.section(prefix + name))
            if (text.section(grid).count(key))
                fail(entry.origin,
                     fmt::format("'{}' in [{}{}] is a key of [{}] too, expected it in one of the two", key,
                                 prefix, name, grid));
}

std::vector<Source> readSources(const Config& text) {
    std::vector<std::pair<int, Source>> by_line;
    for (const std::string& name : namesAfter(text, scenario_prefix))
        by_line.emplace_back(lineOf(text.origin(scenario_prefix + name)), readScenario(text, name));
    for (const std::string& name : namesAfter(text, log_prefix)) {
        if (text.has(scenario_prefix + name))
            fail(text.origin(log_prefix + name),
                 fmt::format("[{}{}] and [{}{}] have one name, expected names of their own", scenario_prefix,
                             name, log_prefix, name));
        by_line.emplace_back(lineOf(text.origin(log_prefix + name)), readLog(text, name));
    }
    std::sort(by_line.begin(), by_line.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Source> sources;
    for (auto& [line, source] : by_line) sources.push_back(std::move(source));
    return sources;
}

void readTold(const Config& text, std::vector<Source>& sources) {
    for (const std::string& name : namesAfter(text, told_prefix)) {
        const auto source =
            std::find_if(sources.begin(), sources.end(), [&](const Source& s) { return s.name == name; });
        if (source == sources.end())
            fail(
                text.origin(told_prefix + name),
                fmt::format("[{}{}] is about no source, expected the name of a [scenario.NAME] or [log.NAME]",
                            told_prefix, name));
        source->told = SourceSection(text, told_prefix + name, {}, true).overrides();
    }
}

}  // namespace

bool runsOn(const Variant& variant, const Source& source) {
    return variant.on.empty() ||
           std::find(variant.on.begin(), variant.on.end(), source.name) != variant.on.end();
}

Config withOverrides(Config config, const Config& overrides) {
    for (const std::string& section : overrides.sectionNames())
        for (const auto& [key, entry] : overrides.section(section))
            config.set(section, key, entry.value, entry.origin);
    return config;
}

StudyFile loadStudy(const std::string& path) {
    StudyFile study;
    study.path = path;
    study.name = fs::path(path).stem().string();
    study.text = Config::fromFile(path);
    const Config& text = study.text;
    std::vector<std::string> open = {scenario_prefix, log_prefix, told_prefix, config_prefix};
    open.insert(open.end(), analysis_prefixes.begin(), analysis_prefixes.end());
    requireKnownSections(text, {"study", "labels", "units", "grid", "grid.scenario"}, open);
    if (!text.has("study")) fail(path, "has no section [study], expected a study file");
    readStudySection(text, study.parameters);
    study.sources = readSources(text);
    readTold(text, study.sources);
    if (study.sources.empty()) fail(path, "has no worlds, expected [scenario.NAME] or [log.NAME]");
    for (const std::string& name : namesAfter(text, config_prefix))
        study.variants.push_back(readVariant(text, name, study.sources));
    if (study.variants.empty()) fail(path, "runs nothing, expected [config.NAME]");
    study.config_grid = readGrid(text, "grid");
    study.scenario_grid = readGrid(text, "grid.scenario");
    requireKeysOutsideGrid(text, "grid", config_prefix);
    requireKeysOutsideGrid(text, "grid", told_prefix);
    requireKeysOutsideGrid(text, "grid.scenario", scenario_prefix);
    const bool simulates = std::any_of(study.sources.begin(), study.sources.end(),
                                       [](const Source& s) { return s.scenario.has_value(); });
    if (text.has("grid.scenario") && !simulates)
        fail(text.origin("grid.scenario"),
             "[grid.scenario] changes nothing, expected a [scenario.NAME] for it");
    return study;
}

}  // namespace slamot::study
