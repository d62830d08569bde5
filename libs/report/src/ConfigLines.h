#pragma once
#include <functional>
#include <string>

namespace slamot::report {

/// Calls `line_of(section, key, line)` for each line of a configuration as summary.json has it; the key is
/// empty where the line sets none.
void forEachConfigLine(
    const std::string& config,
    const std::function<void(const std::string&, const std::string&, const std::string&)>& line_of);

/// What a line sets its key to.
std::string configValue(const std::string& line);

/// Whether the configuration sets a key.
bool configHolds(const std::string& config, const std::string& section, const std::string& key);

}  // namespace slamot::report
