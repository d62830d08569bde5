#pragma once
#include <string>
#include <string_view>

namespace slamot::report {

/// The order of preference; librsvg2-bin brings DejaVu, Verdana has its widths elsewhere.
inline constexpr const char* font = "DejaVu Sans, Verdana, sans-serif";
inline constexpr double label_size = 11, axis_title_size = 12, panel_title_size = 13, title_size = 17;

/// About how many pixels wide a UTF-8 text is: node has no font metrics. The classes are DejaVu Sans' widths.
inline double textWidth(const std::string& text, double size) {
    constexpr std::string_view narrow = "iljtfrI.,:;'|!()[] -", wide = "mwMW@%";
    double em = 0;
    for (const char c : text) {
        const bool continues = (static_cast<unsigned char>(c) & 0xC0) == 0x80;
        const bool capital_or_digit = (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        em += continues                                  ? 0
              : narrow.find(c) != std::string_view::npos ? 0.36
              : wide.find(c) != std::string_view::npos   ? 0.92
              : capital_or_digit                         ? 0.68
                                                         : 0.61;
    }
    return em * size;
}

/// The text, or as much of its beginning as fits, with an ellipsis.
inline std::string fitText(std::string text, double size, double width) {
    if (textWidth(text, size) <= width) {
        return text;
    }
    while (!text.empty() && textWidth(text, size) + size > width) {
        while ((static_cast<unsigned char>(text.back()) & 0xC0) == 0x80) {
            text.pop_back();
        }
        text.pop_back();
    }
    return text + "…";
}

}  // namespace slamot::report
