#pragma once
#include <string>
#include <string_view>

namespace slamot::report {

/// Text as HTML, in elements and in quoted attributes; bytes that are no UTF-8 and control characters that
/// HTML forbids become U+FFFD.
std::string escaped(std::string_view text);

/// JSON inside a script element: nothing in it can end the element.
std::string inScript(std::string json);

}  // namespace slamot::report
