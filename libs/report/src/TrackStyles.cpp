#include "TrackStyles.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "slamot/eval/BestTrack.h"

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

const TrackEstimate* FollowedObject::among(const std::vector<TrackEstimate>& tracks) const {
    const TrackEstimate* found = nullptr;
    for (const TrackEstimate& candidate : tracks) {
        const bool follows = source.valid() ? candidate.source == source : candidate.id == track;
        if (follows && (!found || eval::countsBefore(candidate, *found))) {
            found = &candidate;
        }
    }
    return found;
}

std::vector<FollowedObject> followedObjects(const eval::RunRecord& run) {
    const std::vector<StyledTrack> tracks = styledTracks(run);
    std::map<SourceId, std::size_t> count, length;
    for (const StyledTrack& track : tracks) {
        ++count[track.source];
        length[track.source] += track.length;
    }
    std::vector<std::pair<std::size_t, FollowedObject>> objects;
    std::map<SourceId, bool> taken;
    for (const StyledTrack& track : tracks) {
        if (!track.source.valid()) {
            objects.push_back({track.length, {nameOf(track), {}, track.id, track.style}});
        } else if (!std::exchange(taken[track.source], true)) {
            const std::size_t n = count[track.source];
            const std::string name =
                n > 1 ? fmt::format("Object {} ({} tracks)", track.source.value, n) : nameOf(track);
            objects.push_back({length[track.source], {name, track.source, track.id, track.style}});
        }
    }
    std::stable_sort(objects.begin(), objects.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<FollowedObject> sorted;
    for (auto& [stamps, object] : objects) {
        sorted.push_back(std::move(object));
    }
    return sorted;
}

}  // namespace slamot::report
