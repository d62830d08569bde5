#include "StampUnits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace slamot::eval {
namespace {

struct Seconds {
    double first, last;
};

/// Length of the overlap over the length of both together, 0 to 1.
double overlap(Seconds a, Seconds b) {
    const double common = std::min(a.last, b.last) - std::max(a.first, b.first);
    const double both = std::max(a.last, b.last) - std::min(a.first, b.first);
    return common > 0 && both > 0 ? common / both : 0.0;
}

Seconds scaled(StampSpan span, double factor) {
    return {span.first.seconds() * factor, span.last.seconds() * factor};
}

struct Unit {
    const char* name;
    double factor;
};
constexpr std::array<Unit, 3> units{{{"milliseconds", 1e-3}, {"microseconds", 1e-6}, {"nanoseconds", 1e-9}}};

}  // namespace

std::optional<std::string> unitMistake(StampSpan run, StampSpan truth) {
    for (const Unit& unit : units) {
        if (overlap(scaled(run, 1), scaled(truth, unit.factor)) > 0.5)
            return fmt::format("truth's stamps look like {}, expected seconds", unit.name);
        if (overlap(scaled(run, unit.factor), scaled(truth, 1)) > 0.5)
            return fmt::format("the run's stamps look like {}, expected seconds", unit.name);
    }
    return std::nullopt;
}

}  // namespace slamot::eval
