#pragma once
#include <string>
#include <string_view>

namespace slamot::report {

/// The order of preference; librsvg2-bin brings DejaVu, Verdana has its widths elsewhere.
inline constexpr const char* font = "DejaVu Sans, Verdana, sans-serif";
inline constexpr double label_size = 11, axis_title_size = 12, panel_title_size = 13, title_size = 17;

inline bool continuesCodePoint(char c) {
    return (static_cast<unsigned char>(c) & 0xC0) == 0x80;
}

/// Of a UTF-8 text: its columns in a terminal, but for characters of two columns and of none.
inline std::size_t codePoints(const std::string& text) {
    std::size_t count = 0;
    for (const char c : text) {
        count += continuesCodePoint(c) ? 0 : 1;
    }
    return count;
}

/// The text, or `mark` and as much of its end as fits: names of runs differ there.
inline std::string lastCodePoints(const std::string& text, std::size_t most, const std::string& mark) {
    std::size_t excess = codePoints(text);
    if (excess <= most) {
        return text;
    }
    excess += mark.size() - most;
    std::size_t at = 0;
    while (at < text.size() && (excess > 0 || continuesCodePoint(text[at]))) {
        excess -= continuesCodePoint(text[at]) ? 0 : 1;
        ++at;
    }
    return mark + text.substr(at);
}

/// The text, or as much of its beginning as fits and `mark`.
inline std::string firstCodePoints(const std::string& text, std::size_t most, const std::string& mark) {
    if (codePoints(text) <= most) {
        return text;
    }
    std::size_t at = 0;
    for (std::size_t count = 0; at < text.size(); ++at) {
        count += continuesCodePoint(text[at]) ? 0 : 1;
        if (count > most - mark.size()) {
            break;
        }
    }
    return text.substr(0, at) + mark;
}

/// About how many pixels wide a UTF-8 text is: node has no font metrics. The classes are DejaVu Sans' widths.
inline double textWidth(const std::string& text, double size) {
    constexpr std::string_view narrow = "iljtfrI.,:;'|!()[] -", wide = "mwMW@%";
    double em = 0;
    for (const char c : text) {
        const bool capital_or_digit = (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        em += continuesCodePoint(c)                      ? 0
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
        while (continuesCodePoint(text.back())) {
            text.pop_back();
        }
        text.pop_back();
    }
    return text + "…";
}

}  // namespace slamot::report
