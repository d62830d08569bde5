#pragma once
#include <cstddef>
#include <string>

namespace slamot::eval {

/// Columns that what is printed keeps to.
inline constexpr std::size_t terminal_width = 80;

/// The words of a text on lines of at most `terminal_width` columns (of one byte a character), the first
/// indented by `first`, the others by `others`; ends with a new line.
std::string wrapped(const std::string& text, std::size_t first = 0, std::size_t others = 4);

}  // namespace slamot::eval
