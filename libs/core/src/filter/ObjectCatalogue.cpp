#include "slamot/core/filter/ObjectCatalogue.h"

#include <algorithm>

namespace slamot {

LandmarkRecord& ObjectCatalogue::addLandmark(BlockId block, SourceId source, Stamp now) {
    const auto index = landmarks_.size();
    if (source.valid()) landmark_by_source_[source] = index;
    landmarks_.push_back({{static_cast<std::int64_t>(index)}, source, block, 1, now, now});
    return landmarks_.back();
}

TrackRecord& ObjectCatalogue::addTrack(BlockId block, SourceId source, Stamp now) {
    tracks_.push_back({{next_track_++}, source, block, now, now});
    return tracks_.back();
}

void ObjectCatalogue::removeTrack(TrackId id) {
    tracks_.erase(
        std::remove_if(tracks_.begin(), tracks_.end(), [id](const TrackRecord& t) { return t.id == id; }),
        tracks_.end());
}

void ObjectCatalogue::markSeen(LandmarkId id, Stamp now) {
    LandmarkRecord& landmark = landmarks_.at(static_cast<std::size_t>(id.value));
    landmark.last_seen = now;
    ++landmark.seen;
}

void ObjectCatalogue::markSeen(TrackId id, Stamp now) {
    for (TrackRecord& track : tracks_)
        if (track.id == id) track.last_seen = now;
}

LandmarkRecord* ObjectCatalogue::landmarkBySource(SourceId source) {
    const auto found = landmark_by_source_.find(source);
    return found == landmark_by_source_.end() ? nullptr : &landmarks_[found->second];
}

TrackRecord* ObjectCatalogue::trackBySource(SourceId source) {
    const auto found = std::find_if(tracks_.begin(), tracks_.end(),
                                    [source](const TrackRecord& t) { return t.source == source; });
    return found == tracks_.end() ? nullptr : &*found;
}

const LandmarkRecord* ObjectCatalogue::landmark(LandmarkId id) const {
    return id.valid() && id.value < static_cast<std::int64_t>(landmarks_.size()) ? &landmarks_[id.value]
                                                                                 : nullptr;
}

}  // namespace slamot
