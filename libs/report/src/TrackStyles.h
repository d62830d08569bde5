#pragma once
#include <string>
#include <vector>

#include "slamot/eval/RunRecord.h"
#include "slamot/report/Palette.h"

namespace slamot::report {

struct StyledTrack {
    TrackId id;
    SourceId source;
    std::size_t length = 0;  ///< stamps at which it was present
    SeriesStyle style;
};

/// The tracks of a run, the longest first, each with the style it has in every figure: tracks of one object
/// share it.
std::vector<StyledTrack> styledTracks(const eval::RunRecord& run);

/// What figures over time show as one thing: all tracks of an object that the log names, or a single track.
struct FollowedObject {
    std::string name;
    SourceId source;
    TrackId track;  ///< where the log names no object
    SeriesStyle style;

    /// Of the tracks of one stamp the one that follows the object, of several the one of highest existence;
    /// null for none.
    const TrackEstimate* among(const std::vector<TrackEstimate>& tracks) const;
};

/// The longest followed first.
std::vector<FollowedObject> followedObjects(const eval::RunRecord& run);

/// "Track 7 (object 3)", or "Track 7" where the log does not name the object.
std::string nameOf(const StyledTrack& track);

}  // namespace slamot::report
