#include "TrackStyles.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace slamot::report {

std::vector<StyledTrack> styledTracks(const eval::RunRecord& run) {
    std::map<TrackId, StyledTrack> by_id;
    for (const auto& [stamp, tracks] : run.tracks) {
        for (const TrackEstimate& track : tracks) {
            StyledTrack& entry = by_id[track.id];
            entry.id = track.id;
            entry.source = track.source;
            ++entry.length;
        }
    }
    std::vector<StyledTrack> tracks;
    for (const auto& [id, track] : by_id) {
        tracks.push_back(track);
    }
    std::stable_sort(tracks.begin(), tracks.end(),
                     [](const StyledTrack& a, const StyledTrack& b) { return a.length > b.length; });
    // Named objects come first, so that adding tracks of unknown things does not change their colours.
    std::map<SourceId, SeriesStyle> of_object;
    std::size_t styles = 0;
    for (const StyledTrack& track : tracks) {
        if (track.source.valid() && of_object.count(track.source) == 0) {
            of_object[track.source] = seriesStyle(styles++);
        }
    }
    for (StyledTrack& track : tracks) {
        track.style = track.source.valid() ? of_object[track.source] : seriesStyle(styles++);
    }
    return tracks;
}

std::string nameOf(const StyledTrack& track) {
    return track.source.valid() ? fmt::format("Track {} (object {})", track.id.value, track.source.value)
                                : fmt::format("Track {}", track.id.value);
}

}  // namespace slamot::report
