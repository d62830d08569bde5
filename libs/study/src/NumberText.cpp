#include "NumberText.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slamot::study {
namespace {

bool isPlain(double magnitude) {
    return magnitude == 0 || (magnitude >= 1e-4 && magnitude < 1e6);
}

/// Decimals that show `magnitude` with so many significant digits.
int decimalsFor(double magnitude, int digits) {
    if (magnitude == 0) return std::max(0, digits - 1);
    // Through the rounded number: 0.9996 with three digits is 1.00.
    const std::string rounded = fmt::format("{:.{}e}", magnitude, digits - 1);
    const int exponent = std::stoi(rounded.substr(rounded.find('e') + 1));
    return std::max(0, digits - 1 - exponent);
}

std::string fixed(double value, int decimals) {
    const std::string text = fmt::format("{:.{}f}", value, decimals);
    const bool is_zero = text.find_first_of("123456789") == std::string::npos;
    return is_zero && text[0] == '-' ? text.substr(1) : text;
}

/// The value and its half width with the same decimals: those the larger needs.
std::string withHalfWidth(double value, double half_width, int digits) {
    if (std::isnan(half_width)) return numberText(value, digits);
    const double larger = std::max(std::abs(value), half_width);
    if (!isPlain(larger))
        return fmt::format("{} ± {}", numberText(value, digits), numberText(half_width, digits));
    const int decimals = decimalsFor(larger, digits);
    return fmt::format("{} ± {}", fixed(value, decimals), fixed(half_width, decimals));
}

}  // namespace

std::string numberText(double value, int digits) {
    if (std::isnan(value)) return no_number;
    if (std::isinf(value) || !isPlain(std::abs(value))) return fmt::format("{:.{}g}", value, digits);
    return fixed(value, decimalsFor(std::abs(value), digits));
}

std::string statisticText(const Statistic& s, Shown shown, int digits) {
    if (s.count == 0) return no_number;
    if (shown == Shown::median) {
        if (std::isnan(s.median_low)) return numberText(s.median, digits);
        return fmt::format("{} [{}, {}]", numberText(s.median, digits), numberText(s.median_low, digits),
                           numberText(s.median_high, digits));
    }
    const std::string mean = withHalfWidth(s.mean, s.half_width, digits);
    if (shown == Shown::mean || s.count == 1) return mean;
    return fmt::format("{} ({})", mean, numberText(s.median, digits));
}

std::string percentText(double part) {
    return std::isnan(part) ? no_number : fmt::format("{:.1f} %", 100 * part);
}

std::string rateText(const Rate& rate) {
    if (rate.of == 0) return no_number;
    return fmt::format("{} [{:.1f}, {:.1f}]", percentText(rate.rate), 100 * rate.low, 100 * rate.high);
}

}  // namespace slamot::study
