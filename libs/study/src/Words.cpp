#include "Words.h"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace slamot::study {

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, separator);) {
        const auto first = part.find_first_not_of(" \t");
        parts.push_back(
            first == std::string::npos ? "" : part.substr(first, part.find_last_not_of(" \t") - first + 1));
    }
    if (!text.empty() && text.back() == separator) parts.emplace_back();
    return parts;
}

bool isPlainName(const std::string& name) {
    return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return std::isalnum(c) || c == '_' || c == '-';
    });
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace slamot::study
