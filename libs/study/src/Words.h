#pragma once
#include <string>
#include <vector>

namespace slamot::study {

/// The parts between separators, without blanks around them; an empty text has none.
std::vector<std::string> split(const std::string& text, char separator);

/// Letters, digits, '_' and '-': what may be a part of keys and of folder names.
bool isPlainName(const std::string& name);

bool contains(const std::vector<std::string>& words, const std::string& word);

}  // namespace slamot::study
