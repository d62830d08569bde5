#pragma once
#include <optional>
#include <string>

#include "slamot/core/data/Stamp.h"

namespace slamot::eval {

struct StampSpan {
    Stamp first, last;
};

/// If one span, scaled as milliseconds, microseconds or nanoseconds, would cover most of the other and as it
/// stands does not: a clause naming which side is in which unit. Otherwise nothing.
std::optional<std::string> unitMistake(StampSpan run, StampSpan truth);

}  // namespace slamot::eval
