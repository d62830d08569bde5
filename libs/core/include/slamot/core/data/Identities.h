#pragma once
// Three kinds of number that must never be taken for one another.
#include <cstdint>
#include <functional>

namespace slamot {

/// An integer that only compares with its own kind. -1 is 'none'.
template <class Tag>
struct StrongId {
    std::int64_t value = -1;
    bool valid() const { return value >= 0; }
    friend bool operator==(StrongId a, StrongId b) { return a.value == b.value; }
    friend bool operator!=(StrongId a, StrongId b) { return a.value != b.value; }
    friend bool operator<(StrongId a, StrongId b) { return a.value < b.value; }
};

/// An estimator's own number for a landmark; never reused within a run.
using LandmarkId = StrongId<struct LandmarkTag>;
/// An estimator's own number for a track; never reused within a run.
using TrackId = StrongId<struct TrackTag>;
/// What the log says an object is. Landmarks and movers have separate number spaces.
using SourceId = StrongId<struct SourceTag>;

}  // namespace slamot

template <class Tag>
struct std::hash<slamot::StrongId<Tag>> {
    std::size_t operator()(slamot::StrongId<Tag> id) const noexcept { return std::hash<std::int64_t>{}(id.value); }
};
