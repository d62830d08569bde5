#include "SectionReader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "Words.h"

namespace slamot::study {

int lineOf(const std::string& origin) {
    const auto colon = origin.rfind(':');
    return colon == std::string::npos ? 0 : std::atoi(origin.c_str() + colon + 1);
}

std::string trimmed(const std::string& text) {
    const char* blanks = " \t\r";
    const auto first = text.find_first_not_of(blanks);
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string> sectionsOf(const Config& config, const std::string& prefix) {
    std::vector<std::string> sections;
    for (const std::string& name : config.sectionNames())
        if (name.rfind(prefix, 0) == 0) sections.push_back(name);
    std::stable_sort(sections.begin(), sections.end(), [&](const std::string& a, const std::string& b) {
        return lineOf(config.origin(a)) < lineOf(config.origin(b));
    });
    return sections;
}

std::string nameOf(const Config& config, const std::string& section, const std::string& prefix) {
    const std::string name = section.substr(prefix.size());
    if (!isPlainName(name))
        throw ConfigError(
            fmt::format("{}: [{}] names no file, expected letters, digits, '_' and '-' after '{}'",
                        config.origin(section), section, prefix));
    return name;
}

void addWords(ParameterTable& table, const std::string& key, std::vector<std::string>& field,
              const std::string& help) {
    const std::string expected = "names separated by commas, none twice";
    table.custom({key, "-", expected, help,
                  [&field, expected](const std::string& text) -> std::optional<std::string> {
                      std::vector<std::string> words = split(text, ','), sorted = words;
                      std::sort(sorted.begin(), sorted.end());
                      const bool doubled = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
                      if (doubled || sorted.empty() || sorted.front().empty()) return expected;
                      field = std::move(words);
                      return std::nullopt;
                  },
                  [&field] { return fmt::format("{}", fmt::join(field, ", ")); }});
}

void addBounds(ParameterTable& table, const std::string& key, eval::Band& field, const std::string& help) {
    const std::string expected = "two numbers 'low, high', low not above high";
    table.custom({key, "-", expected, help,
                  [&field, expected](const std::string& text) -> std::optional<std::string> {
                      const std::vector<std::string> parts = split(text, ',');
                      if (parts.size() != 2) return expected;
                      const auto low = numberFromText(parts[0]), high = numberFromText(parts[1]);
                      if (!low || !high || !(*low <= *high)) return expected;
                      field = {*low, *high};
                      return std::nullopt;
                  },
                  [&field] { return shortestText(field.low) + ", " + shortestText(field.high); }});
}

void refuse(const Config::Entry& entry, const std::string& section, const std::string& problem) {
    throw ConfigError(fmt::format("{}: {} in [{}]", entry.origin, problem, section));
}

void requireWord(const Config::Entry& entry, const std::string& section, const std::string& word,
                 const std::vector<std::string>& known, const std::string& what) {
    if (std::find(known.begin(), known.end(), word) != known.end()) return;
    const auto near = nearestWord(word, known);
    throw ConfigError(fmt::format(
        "{}: '{}' in [{}] is no {}{}", entry.origin, word, section, what,
        near ? fmt::format("; did you mean '{}'?", *near)
             : fmt::format(", expected {}", known.empty() ? "none: there is none"
                                                          : fmt::format("{}", fmt::join(known, " | ")))));
}

const Config::Entry& requiredEntry(const Config& config, const std::string& section, const std::string& key,
                                   const std::string& expected) {
    const Config::Section& entries = config.section(section);
    const auto found = entries.find(key);
    if (found == entries.end() || found->second.value.empty())
        throw ConfigError(
            fmt::format("{}: [{}] lacks '{}', expected {}", config.origin(section), section, key, expected));
    return found->second;
}

}  // namespace slamot::study
