#include "slamot/eval/TerminalText.h"

#include <sstream>

namespace slamot::eval {

std::string wrapped(const std::string& text, std::size_t first, std::size_t others) {
    std::istringstream in(text);
    std::string word, line(first, ' '), all;
    bool empty = true;
    while (in >> word) {
        if (!empty && line.size() + 1 + word.size() > terminal_width) {
            all += line + "\n";
            line.assign(others, ' ');
            empty = true;
        }
        line += (empty ? "" : " ") + word;
        empty = false;
    }
    return all + line + "\n";
}

}  // namespace slamot::eval
