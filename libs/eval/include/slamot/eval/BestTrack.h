#pragma once
#include "slamot/core/data/Estimate.h"

namespace slamot::eval {

/// Which of two tracks of one object counts: the one of higher existence, of equals the one of lower id.
inline bool countsBefore(const TrackEstimate& a, const TrackEstimate& b) {
    return a.existence > b.existence || (a.existence == b.existence && a.id < b.id);
}

}  // namespace slamot::eval
