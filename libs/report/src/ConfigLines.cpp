#include "ConfigLines.h"

#include <sstream>

namespace slamot::report {

void forEachConfigLine(
    const std::string& config,
    const std::function<void(const std::string&, const std::string&, const std::string&)>& line_of) {
    std::istringstream in(config);
    std::string line, section;
    while (std::getline(in, line)) {
        const bool heads = !line.empty() && line.front() == '[';
        if (heads) {
            section = line.substr(1, line.find(']') - 1);
        }
        const std::size_t equals = line.find('=');
        std::string key = heads || equals == std::string::npos ? std::string() : line.substr(0, equals);
        while (!key.empty() && key.back() == ' ') {
            key.pop_back();
        }
        line_of(section, key, line);
    }
}

std::string configValue(const std::string& line) {
    const std::size_t equals = line.find('=');
    const std::size_t begin = equals == std::string::npos ? equals : line.find_first_not_of(' ', equals + 1);
    return begin == std::string::npos ? std::string() : line.substr(begin);
}

bool configHolds(const std::string& config, const std::string& section, const std::string& key) {
    bool holds = false;
    forEachConfigLine(config, [&](const std::string& s, const std::string& k, const std::string&) {
        holds = holds || (s == section && k == key);
    });
    return holds;
}

}  // namespace slamot::report
