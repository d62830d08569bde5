#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "slamot/core/config/Parameters.h"
#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::eval {
namespace {

/// [s] since the epoch, about the year 3,200. What lies beyond is another unit: today is 1.8e12 in
/// milliseconds.
constexpr double latest_stamp = 4e10;

struct TumLine {
    double t, x, y, z, qx, qy, qz, qw;
    std::string stamp_text;
};

[[noreturn]] void fail(const std::string& file, int line, const std::string& what) {
    throw LogError(fmt::format("{}, line {}: {}", file, line, what));
}

TumLine parse(const std::string& text, const std::string& file, int line) {
    std::istringstream in(text);
    std::array<double, 8> numbers{};
    std::string word, stamp_text;
    std::size_t n = 0;
    for (; in >> word; ++n) {
        const auto number = numberFromText(word);
        if (!number || !std::isfinite(*number))
            fail(file, line, fmt::format("'{}', expected a finite number", word));
        if (n == 0) stamp_text = word;
        if (n < numbers.size()) numbers[n] = *number;
    }
    if (n != numbers.size())
        fail(file, line,
             fmt::format("{} numbers, expected the 8 of a TUM trajectory: t x y z qx qy qz qw", n));
    const auto [t, x, y, z, qx, qy, qz, qw] = numbers;
    return {t, x, y, z, qx, qy, qz, qw, stamp_text};
}

/// Decimal text is read exactly; a double of seconds since the epoch is only good to about 0.2 us.
Stamp stampOf(const TumLine& row, const std::string& file, int line) {
    if (std::abs(row.t) > latest_stamp)
        fail(
            file, line,
            fmt::format(
                "stamp {} is too large for seconds since the epoch, it looks like milliseconds, microseconds "
                "or nanoseconds; expected seconds",
                row.stamp_text));
    const bool decimal = row.stamp_text.find_first_of("eE") == std::string::npos;
    try {
        return decimal ? stampFromText(row.stamp_text) : Stamp::fromSeconds(row.t);
    } catch (const std::invalid_argument& e) {
        fail(file, line, fmt::format("{}, expected decimal seconds", e.what()));
    }
}

}  // namespace

RunRecord readTum(const std::string& file) {
    std::ifstream in(file);
    if (!in) throw LogError(fmt::format("{}: cannot be opened, expected a TUM trajectory", file));
    RunRecord run;
    std::string text;
    for (int line = 1; std::getline(in, text); ++line) {
        const auto start = text.find_first_not_of(" \t\r");
        if (start == std::string::npos || text[start] == '#') continue;
        const TumLine row = parse(text, file, line);
        const Stamp stamp = stampOf(row, file, line);
        if (!run.trajectory.empty() && stamp <= run.trajectory.back().stamp)
            fail(file, line,
                 fmt::format("time {}, expected one after the line before ({} s)", row.stamp_text,
                             slamot::toText(run.trajectory.back().stamp)));
        const double norm = row.qx * row.qx + row.qy * row.qy + row.qz * row.qz + row.qw * row.qw;
        // Written with few digits, a unit quaternion's norm is off by less than a hundredth.
        if (std::abs(norm - 1) > 0.02) fail(file, line, "no unit quaternion in qx qy qz qw, expected one");
        const double yaw = std::atan2(2 * (row.qw * row.qz + row.qx * row.qy),
                                      norm - 2 * (row.qy * row.qy + row.qz * row.qz));
        run.trajectory.push_back({stamp, {{row.x, row.y, yaw}, Matrix3::Zero()}});
    }
    if (run.trajectory.empty()) throw LogError(fmt::format("{}: no rows, expected a TUM trajectory", file));
    return run;
}

}  // namespace slamot::eval
