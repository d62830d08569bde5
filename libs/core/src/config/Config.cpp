#include "slamot/core/config/Config.h"

#include <fmt/format.h>
#include <mrpt/config/CConfigFileMemory.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "Text.h"

namespace slamot {
namespace {

bool startsWith(const std::string& text, const std::string& prefix) {
    return text.compare(0, prefix.size(), prefix) == 0;
}

std::string lowered(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

bool isComment(const std::string& line) {
    return line[0] == '#' || line[0] == ';' || startsWith(line, "//");
}

/// `@define NAME value`, the only directive MRPT has; it skips other lines that start with '@' in silence.
bool isDefine(const std::string& line) {
    std::istringstream words(line);
    std::string directive, name, value;
    return words >> directive >> name >> value && directive == "@define" && value[0] != '=';
}

/// MRPT joins a line with the next when its very last character is '\\', blanks after it counting.
bool isJoinedWithNext(std::string raw) {
    if (!raw.empty() && raw.back() == '\r') raw.pop_back();
    return !raw.empty() && raw.back() == '\\';
}

/// A '\\' that continues anything but a value would swallow the next line, and the key on it, in silence.
void requireHarmless(const std::string& line, bool continues_before, bool continued,
                     const std::string& where) {
    const bool directive = !line.empty() && line[0] == '@';
    if (directive && (continues_before || continued || !isDefine(line)))
        throw ConfigError(
            fmt::format("{}: '{}' is no directive, expected @define NAME value on one line", where, line));
    if (!continued || line.empty()) return;
    if (isComment(line) || line.find("//") != std::string::npos)
        throw ConfigError(
            fmt::format("{}: the comment of '{}' ends in '\\', expected no comment on a line that "
                        "goes on in the next",
                        where, line));
    if (line[0] == '[' && !continues_before)
        throw ConfigError(
            fmt::format("{}: '{}' is no section header, expected [name] without a '\\'", where, line));
}

/// Where every section and key of an INI text stands. MRPT's reader forgets lines and keeps the last of
/// doubled keys, so this scan finds the places and the doubles; the values come from MRPT.
struct Places {
    std::map<std::string, int> sections;
    std::map<std::string, std::map<std::string, int>> keys;
};

Places scan(const std::string& text, const std::string& name) {
    Places places;
    // MRPT's reader takes no notice of case, so neither does the search for doubles.
    std::map<std::string, int> section_lines;
    std::map<std::pair<std::string, std::string>, int> key_lines;
    std::istringstream lines(text);
    std::string raw, section;
    bool continued = false;
    for (int number = 1; std::getline(lines, raw); ++number) {
        const std::string line = trimmed(raw);
        const bool continues_before = continued;
        continued = isJoinedWithNext(raw);
        requireHarmless(line, continues_before, continued, fmt::format("{}:{}", name, number));
        if (continues_before || line.empty() || line[0] == '@' || isComment(line)) continue;
        if (line[0] == '[') {
            const auto close = line.find(']');
            const std::string rest = close == std::string::npos ? "" : trimmed(line.substr(close + 1));
            section = close == std::string::npos ? "" : trimmed(line.substr(1, close - 1));
            if (section.empty() || !(rest.empty() || startsWith(rest, "//") || rest[0] == ';'))
                throw ConfigError(
                    fmt::format("{}:{}: '{}' is no section header, expected [name]", name, number, line));
            places.sections[section] = number;
            if (const auto [at, is_new] = section_lines.emplace(lowered(section), number); !is_new)
                throw ConfigError(fmt::format("{}:{}: section [{}] is there twice, first at line {}", name,
                                              number, section, at->second));
            continue;
        }
        const auto equals = line.find('=');
        if (equals == std::string::npos || equals == 0)
            throw ConfigError(
                fmt::format("{}:{}: '{}' is no setting, expected key = value", name, number, line));
        if (section.empty())
            throw ConfigError(fmt::format("{}:{}: '{}' stands before any section, expected [name] first",
                                          name, number, line));
        const std::string key = trimmed(line.substr(0, equals));
        places.keys[section][key] = number;
        if (const auto [at, is_new] = key_lines.emplace(std::pair(lowered(section), lowered(key)), number);
            !is_new)
            throw ConfigError(fmt::format("{}:{}: key '{}' of [{}] is there twice, first at line {}", name,
                                          number, key, section, at->second));
    }
    return places;
}

/// What MRPT says is wrong, without where in MRPT and its call stack.
std::string sentenceOf(const std::exception& error) {
    const std::string text = error.what(), label = "Message:";
    const auto found = text.find(label);
    const auto begin = found == std::string::npos ? 0 : found + label.size();
    return trimmed(text.substr(begin, text.find('\n', begin) - begin));
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& candidates) {
    const auto near = nearestWord(word, candidates);
    return near ? fmt::format("; did you mean '{}'?", *near) : std::string();
}

}  // namespace

Config Config::fromFile(const std::string& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
        throw ConfigError(fmt::format("{}: no such config file", path));
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    if (!file) throw ConfigError(fmt::format("{}: the config file cannot be read, expected INI text", path));
    // Editors of Windows write a byte order mark before the first letter.
    const std::string byte_order_mark = "\xEF\xBB\xBF", content = text.str();
    Config config =
        fromText(content.substr(startsWith(content, byte_order_mark) ? byte_order_mark.size() : 0), path);
    const auto parent = std::filesystem::path(path).parent_path();
    config.folder_ = parent.empty() ? "." : parent.string();
    return config;
}

Config Config::fromText(const std::string& text, const std::string& name) {
    if (text.find('\0') != std::string::npos)
        throw ConfigError(fmt::format("{}: holds binary data, expected INI text", name));
    const Places places = scan(text, name);
    mrpt::config::CConfigFileMemory values;
    try {
        values.setContent(text);
    } catch (const std::exception& error) {
        throw ConfigError(fmt::format("{}: {}", name, sentenceOf(error)));
    }

    Config config;
    for (const auto& [section, line] : places.sections) {
        config.sections_[section];
        config.section_origins_[section] = fmt::format("{}:{}", name, line);
    }
    for (const auto& [section, keys] : places.keys)
        for (const auto& [key, line] : keys)
            config.set(section, key, values.read_string(section, key, ""), fmt::format("{}:{}", name, line));
    return config;
}

void Config::set(const std::string& section, const std::string& key, const std::string& value,
                 const std::string& origin) {
    sections_[section][key] = {trimmed(value), origin};
    section_origins_.emplace(section, origin);
}

void Config::setFromAssignment(const std::string& assignment) {
    const auto equals = assignment.find('=');
    const auto dot = equals == std::string::npos ? std::string::npos : assignment.rfind('.', equals);
    const bool has_both = dot != std::string::npos;
    const std::string section = has_both ? trimmed(assignment.substr(0, dot)) : "";
    const std::string key = has_both ? trimmed(assignment.substr(dot + 1, equals - dot - 1)) : "";
    if (section.empty() || key.empty())
        throw ConfigError(fmt::format("--set {}: expected section.key=value", assignment));
    set(section, key, assignment.substr(equals + 1), "--set " + assignment);
}

const Config::Section& Config::section(const std::string& name) const {
    static const Section none;
    const auto found = sections_.find(name);
    return found == sections_.end() ? none : found->second;
}

std::vector<std::string> Config::sectionNames() const {
    std::vector<std::string> names;
    for (const auto& [name, section] : sections_) names.push_back(name);
    return names;
}

std::string Config::origin(const std::string& section) const {
    const auto found = section_origins_.find(section);
    return found == section_origins_.end() ? "config" : found->second;
}

std::string Config::canonicalText() const {
    std::string text;
    for (const auto& [name, section] : sections_) {
        text += "[" + name + "]\n";
        for (const auto& [key, entry] : section) text += key + " = " + entry.value + "\n";
    }
    return text;
}

void load(const ParameterTable& table, const Config& config) {
    std::vector<std::string> known;
    for (const auto& parameter : table.parameters()) known.push_back(parameter.key);
    for (const auto& [key, entry] : config.section(table.section())) {
        const Parameter* parameter = table.find(key);
        if (!parameter)
            throw ConfigError(fmt::format("{}: unknown key '{}' in [{}]{}", entry.origin, key,
                                          table.section(), didYouMean(key, known)));
        if (const auto expected = parameter->parse(entry.value))
            throw ConfigError(fmt::format("{}: {} = '{}' in [{}], expected {}", entry.origin, key,
                                          entry.value, table.section(), *expected));
    }
}

void requireKnownSections(const Config& config, const std::vector<std::string>& known,
                          const std::vector<std::string>& open_prefixes) {
    for (const auto& name : config.sectionNames()) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        if (std::any_of(open_prefixes.begin(), open_prefixes.end(),
                        [&](const std::string& prefix) { return startsWith(name, prefix); }))
            continue;
        throw ConfigError(
            fmt::format("{}: unknown section [{}]{}", config.origin(name), name, didYouMean(name, known)));
    }
}

}  // namespace slamot
