#include "slamot/core/data/Stamp.h"

#include <fmt/format.h>

#include <cctype>
#include <stdexcept>

namespace slamot {

std::string toText(Stamp stamp) {
    const bool negative = stamp.ticks < 0;
    const auto magnitude =
        negative ? -static_cast<std::uint64_t>(stamp.ticks) : static_cast<std::uint64_t>(stamp.ticks);
    constexpr auto per_second = static_cast<std::uint64_t>(Stamp::ticks_per_second);
    return fmt::format("{}{}.{:07d}", negative ? "-" : "", magnitude / per_second, magnitude % per_second);
}

Stamp stampFromText(const std::string& text) {
    const auto fail = [&]() -> Stamp {
        throw std::invalid_argument("'" + text + "' is no time in decimal seconds");
    };
    std::size_t i = 0;
    const bool negative = !text.empty() && text[0] == '-';
    if (negative) ++i;

    // Whole ticks are gathered as integers: a double has too few digits for seconds since the epoch.
    std::int64_t ticks = 0, weight = Stamp::ticks_per_second;
    bool any_digit = false, after_point = false, rounded = false;
    for (; i < text.size(); ++i) {
        if (text[i] == '.' && !after_point) {
            after_point = true;
            continue;
        }
        if (!std::isdigit(static_cast<unsigned char>(text[i]))) return fail();
        any_digit = true;
        const std::int64_t digit = text[i] - '0';
        if (!after_point) {
            if (ticks > (INT64_MAX / 10) / 10 - weight) return fail();
            ticks = ticks * 10 + digit * weight;
        } else if (weight > 1) {
            weight /= 10;
            ticks += digit * weight;
        } else if (!rounded) {
            ticks += digit >= 5 ? 1 : 0;
            rounded = true;
        }
    }
    if (!any_digit) return fail();
    return {negative ? -ticks : ticks};
}

}  // namespace slamot
