#include "page/Html.h"

#include "JsonText.h"

namespace slamot::report {
namespace {

constexpr const char* replacement = "\xEF\xBF\xBD";  // U+FFFD

/// nlohmann's writer knows UTF-8: a string through it and back has no other bytes left.
std::string validUtf8(std::string_view text) {
    return nlohmann::json::parse(jsonText(std::string(text))).get<std::string>();
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string html;
    for (const char c : validUtf8(text)) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '&') {
            html += "&amp;";
        } else if (c == '<') {
            html += "&lt;";
        } else if (c == '>') {
            html += "&gt;";
        } else if (c == '"') {
            html += "&quot;";
        } else if (c == '\'') {
            html += "&#39;";
        } else if ((code < 0x20 && c != '\n' && c != '\t') || code == 0x7F) {
            html += replacement;
        } else {
            html += c;
        }
    }
    return html;
}

std::string inScript(std::string json) {
    std::string safe;
    safe.reserve(json.size());
    for (const char c : json) {
        if (c == '<') {
            safe += "\\u003c";
        } else {
            safe += c;
        }
    }
    return safe;
}

}  // namespace slamot::report
