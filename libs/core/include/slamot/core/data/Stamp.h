#pragma once
// Time: integer ticks of 100 ns since the Unix epoch, the resolution of MRPT's clock, so that stamps compare
// exactly and intervals are differences of integers.
#include <cmath>
#include <cstdint>
#include <string>

namespace slamot {

/// An instant; `ticks` counts 100 ns since the Unix epoch.
struct Stamp {
    static constexpr std::int64_t ticks_per_second = 10'000'000;
    std::int64_t ticks = 0;

    static Stamp fromSeconds(double seconds) {
        return {static_cast<std::int64_t>(std::llround(seconds * static_cast<double>(ticks_per_second)))};
    }
    double seconds() const { return static_cast<double>(ticks) / static_cast<double>(ticks_per_second); }
};

inline bool operator==(Stamp a, Stamp b) {
    return a.ticks == b.ticks;
}
inline bool operator!=(Stamp a, Stamp b) {
    return a.ticks != b.ticks;
}
inline bool operator<(Stamp a, Stamp b) {
    return a.ticks < b.ticks;
}
inline bool operator>(Stamp a, Stamp b) {
    return b < a;
}
inline bool operator<=(Stamp a, Stamp b) {
    return !(b < a);
}
inline bool operator>=(Stamp a, Stamp b) {
    return !(a < b);
}

/// Seconds from `from` to `to`, exact to a tick.
inline double secondsBetween(Stamp from, Stamp to) {
    return static_cast<double>(to.ticks - from.ticks) / static_cast<double>(Stamp::ticks_per_second);
}

/// `stamp` moved by `seconds`, rounded to a tick.
inline Stamp later(Stamp stamp, double seconds) {
    return {stamp.ticks + Stamp::fromSeconds(seconds).ticks};
}

/// Seconds with seven decimals, made from the ticks without rounding: how every CSV writes time.
std::string toText(Stamp stamp);

/// The inverse of `toText`: decimal seconds to the nearest tick; throws std::invalid_argument on other text.
Stamp stampFromText(const std::string& text);

}  // namespace slamot
