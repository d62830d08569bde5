#pragma once
// Lists within one value of a config.
#include <sstream>
#include <string>
#include <vector>

namespace slamot {

/// Parts between separators, without the spaces around them.
inline std::vector<std::string> splitAt(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);) {
        const auto first = part.find_first_not_of(' '), last = part.find_last_not_of(' ');
        parts.push_back(first == std::string::npos ? "" : part.substr(first, last - first + 1));
    }
    return parts;
}

}  // namespace slamot
