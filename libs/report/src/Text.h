#pragma once
#include <string>

namespace slamot::report {

/// The order of preference; librsvg2-bin brings DejaVu, Verdana has its widths elsewhere.
inline constexpr const char* font = "DejaVu Sans, Verdana, sans-serif";
inline constexpr double label_size = 11, axis_title_size = 12, panel_title_size = 13, title_size = 17;

/// About how many pixels wide a UTF-8 text is: node has no font metrics. Errs on the wide side for prose.
inline double textWidth(const std::string& text, double size) {
    double characters = 0;
    for (const char c : text) {
        characters += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    }
    return 0.61 * size * characters;
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
