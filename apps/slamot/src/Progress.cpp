#include "Progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "slamot/eval/TerminalText.h"

namespace slamot::app {
namespace {

std::size_t columnsOfTerminal() {
    winsize size{};
    const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
    return std::min(known ? size.ws_col : eval::terminal_width, eval::terminal_width);
}

}  // namespace

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1), begin_(Clock::now()), last_(begin_) {}

Progress::~Progress() {
    if (drawn_ > 0) fmt::print(stderr, "\r{:{}}\r", "", drawn_);
}

void Progress::show(double done, const std::string& detail) {
    if (quiet_) return;
    const auto now = Clock::now();
    const auto wait = terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(5000);
    if (now - last_ < wait) return;
    last_ = now;
    const double elapsed = std::chrono::duration<double>(now - begin_).count();
    const double part = std::clamp(done, 0.0, 1.0);
    const std::string left = part > 0 ? fmt::format("{:.0f} s left", elapsed * (1 - part) / part) : "";
    const std::string text = fmt::format("{} {:3.0f} % {:.0f} s, {}{}{}", what_, 100 * part, elapsed, left,
                                         detail.empty() || left.empty() ? "" : ", ", detail);
    if (!terminal_) {
        fmt::print(stderr, "{}\n", text);
        return;
    }
    constexpr int width = 24;
    const auto filled = static_cast<std::size_t>(part * width);
    // A line that is longer than the terminal would begin a new one each time.
    const std::string line = fmt::format("[{:<{}}] {:<50}", std::string(filled, '#'), width, text);
    drawn_ = columnsOfTerminal() - 1;
    fmt::print(stderr, "\r{}", line.substr(0, drawn_));
    std::fflush(stderr);
}

}  // namespace slamot::app
