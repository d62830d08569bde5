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

/// The tracks of a run, the longest first, each with the style it has in every figure: tracks of one object share
/// it.
std::vector<StyledTrack> styledTracks(const eval::RunRecord& run);

/// "Track 7 (object 3)", or "Track 7" where the log does not name the object.
std::string nameOf(const StyledTrack& track);

}  // namespace slamot::report
