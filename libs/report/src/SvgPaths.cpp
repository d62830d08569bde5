#include "SvgPaths.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <iterator>

namespace slamot::report {
namespace {

constexpr const char* path_attribute = " d=\"";

bool startsNumber(char c) {
    return (c >= '0' && c <= '9') || c == '-' || c == '.';
}

}  // namespace

std::string roundPathCoordinates(const std::string& svg) {
    std::string text;
    text.reserve(svg.size());
    std::size_t at = 0;
    for (std::size_t path; (path = svg.find(path_attribute, at)) != std::string::npos;) {
        const std::size_t begin = path + std::char_traits<char>::length(path_attribute);
        const std::size_t end = std::min(svg.find('"', begin), svg.size());
        text.append(svg, at, begin - at);
        for (at = begin; at < end;) {
            if (!startsNumber(svg[at])) {
                text += svg[at++];
                continue;
            }
            char* after = nullptr;
            const double number = std::strtod(svg.c_str() + at, &after);
            fmt::format_to(std::back_inserter(text), "{}", std::round(number * 100) / 100);
            at = static_cast<std::size_t>(after - svg.c_str());
        }
    }
    return text.append(svg, at, std::string::npos);
}

}  // namespace slamot::report
