#include "MarkdownText.h"

#include <cctype>

namespace slamot::study {
namespace {

bool isWordCharacter(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// Only where it would mean something, so that tables read well as plain text: names like robot_nees and "a <
/// b" stay as they are.
bool needsBackslash(const std::string& text, std::size_t at) {
    const char c = text[at], before = at > 0 ? text[at - 1] : ' ',
               after = at + 1 < text.size() ? text[at + 1] : ' ';
    switch (c) {
        case '|':
        case '*':
        case '`':
        case '[':
        case ']':
            // A link needs its second half.
            return (c != '[' && c != ']') || text.find("](") != std::string::npos;
        case '_':
            return !isWordCharacter(before) || !isWordCharacter(after);
        case '~':
            return before == '~' || after == '~';
        case '<':
            return std::isalpha(static_cast<unsigned char>(after)) || after == '/' || after == '!' ||
                   after == '?';
        case '&':
            return std::isalpha(static_cast<unsigned char>(after)) || after == '#';
        case '\\':
            return std::ispunct(static_cast<unsigned char>(after));
        default:
            return false;
    }
}

}  // namespace

std::string markdownText(const std::string& text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (needsBackslash(text, i)) result += '\\';
        const bool line_end = text[i] == '\n' || text[i] == '\r';
        result += line_end ? ' ' : text[i];
    }
    return result;
}

}  // namespace slamot::study
