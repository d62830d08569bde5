#pragma once
// Reading the analysis sections of a study file: one section whose keys depend on its kind, and values that
// must be names of something in the study.
#include <string>
#include <utility>
#include <vector>

#include "slamot/core/config/Config.h"
#include "slamot/eval/Consistency.h"

namespace slamot::study {

/// Without blanks at either end.
std::string trimmed(const std::string& text);

/// The line at the end of an origin, `study.ini:12`; 0 where there is none, as with --set.
int lineOf(const std::string& origin);

/// Names of the sections `prefix`NAME, in the order of the file.
std::vector<std::string> sectionsOf(const Config& config, const std::string& prefix);

/// What follows `prefix` in a section's name: letters, digits, '_' and '-', since files are named by it.
/// Throws ConfigError.
std::string nameOf(const Config& config, const std::string& section, const std::string& prefix);

/// A comma-separated list of names.
void addWords(ParameterTable& table, const std::string& key, std::vector<std::string>& field,
              const std::string& help);

/// `low, high`, each may be infinite.
void addBounds(ParameterTable& table, const std::string& key, eval::Band& field, const std::string& help);

/// Throws ConfigError for an entry whose word is none of `known`; `what` names the kind of thing.
[[noreturn]] void refuse(const Config::Entry& entry, const std::string& section, const std::string& problem);
void requireWord(const Config::Entry& entry, const std::string& section, const std::string& word,
                 const std::vector<std::string>& known, const std::string& what);

/// The entry of a key that must be there. Throws ConfigError.
const Config::Entry& requiredEntry(const Config& config, const std::string& section, const std::string& key,
                                   const std::string& expected);

/// The key that decides which others there may be.
template <class Enum>
Enum requiredChoice(const Config& config, const std::string& section, const std::string& key,
                    const std::vector<std::pair<std::string, Enum>>& names) {
    Enum value{};
    ParameterTable table(section, "");
    table.choice(key, value, names, "");
    const Parameter& parameter = table.parameters().front();
    const Config::Entry& entry = requiredEntry(config, section, key, parameter.expected);
    if (const auto expected = parameter.parse(entry.value))
        throw ConfigError(entry.origin + ": " + key + " = '" + entry.value + "' in [" + section +
                          "], expected " + *expected);
    return value;
}

}  // namespace slamot::study
