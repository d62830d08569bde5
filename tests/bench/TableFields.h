#pragma once
// Fields of the tables of map_size_bench.
#include <fmt/format.h>

#include <cmath>

#include "slamot/study/Tables.h"

namespace slamot::bench {

/// Three significant digits, never rounded before the point; a dash where there is no number.
inline study::Field numberField(double value) {
    if (!std::isfinite(value)) return {"–", {""}};
    const std::string shown =
        std::abs(value) >= 100 ? fmt::format("{:.0f}", value) : fmt::format("{:#.3g}", value);
    return {shown.back() == '.' ? shown.substr(0, shown.size() - 1) : shown, {fmt::format("{}", value)}};
}

template <class Integer>
study::Field countField(Integer value) {
    return {fmt::format("{}", value), {fmt::format("{}", value)}};
}

inline study::Field textField(const std::string& text) {
    return {text, {text}};
}

inline study::Column numberColumn(const std::string& heading, const std::string& csv) {
    return {heading, {csv}, true};
}

inline study::Column textColumn(const std::string& heading, const std::string& csv) {
    return {heading, {csv}, false};
}

}  // namespace slamot::bench
