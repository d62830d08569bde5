#pragma once
#include <string>

namespace slamot::study {

/// A text that GitHub's Markdown shows letter by letter, in a table's cell too.
std::string markdownText(const std::string& text);

}  // namespace slamot::study
