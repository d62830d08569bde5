#include "slamot/core/filter/ObjectCatalogue.h"

#include <algorithm>
#include <iterator>

#include "slamot/core/estimation/ModalState.h"

namespace slamot {
namespace {

template <class Records, class Id>
auto* find(Records& records, Id id) {
    const auto at = std::find_if(records.begin(), records.end(), [id](const auto& r) { return r.id == id; });
    return at == records.end() ? nullptr : &*at;
}

}  // namespace

double visiblePart(const std::optional<ObjectLifeRecord>& life) {
    return life ? std::max(life->existence.visibility() / life->existence.probability(), 0.1) : 1.0;
}

TrackEstimate estimateOf(const TrackRecord& track, const TargetBelief& belief, bool tell_modes) {
    TrackEstimate out;
    out.id = track.id;
    out.source = track.source;
    out.mean = belief.mean;
    out.covariance = belief.covariance;
    if (track.life) {
        out.existence = track.life->existence.probability();
        out.moving = track.life->moving;
    }
    if (tell_modes)
        out.mode_probabilities.assign(belief.mode_probabilities.begin(), belief.mode_probabilities.end());
    return out;
}

LandmarkRecord& ObjectCatalogue::addLandmark(BlockId block, SourceId source, Stamp now) {
    const LandmarkId id{next_landmark_++};
    if (source.valid()) landmark_by_source_[source] = id;
    landmark_by_block_[block] = id;
    landmarks_.push_back({id, source, block, 1, now, now, std::nullopt});
    return landmarks_.back();
}

TrackRecord& ObjectCatalogue::addTrack(BlockId block, SourceId source, Stamp now,
                                       std::optional<TrackId> again) {
    const TrackId id = again ? *again : TrackId{next_track_++};
    const auto after =
        std::find_if(tracks_.begin(), tracks_.end(), [id](const auto& t) { return id < t.id; });
    return *tracks_.insert(after, {id, source, block, now, now, std::nullopt});
}

void ObjectCatalogue::removeLandmark(LandmarkId id) {
    LandmarkRecord* gone = landmark(id);
    if (gone->life) {
        --living_;
        positions_.remove(gone->block);
    }
    landmark_by_source_.erase(gone->source);
    landmark_by_block_.erase(gone->block);
    landmarks_.erase(landmarks_.begin() + (gone - landmarks_.data()));
}

void ObjectCatalogue::removeTrack(TrackId id) {
    const TrackRecord* gone = track(id);
    if (gone->life) --living_;
    tracks_.erase(tracks_.begin() + (gone - tracks_.data()));
}

void ObjectCatalogue::markSeen(LandmarkId id, Stamp now) {
    LandmarkRecord* record = landmark(id);
    record->last_seen = now;
    ++record->seen;
}

void ObjectCatalogue::markSeen(TrackId id, Stamp now) {
    track(id)->last_seen = now;
}

LandmarkRecord* ObjectCatalogue::landmarkBySource(SourceId source) {
    const auto found = landmark_by_source_.find(source);
    return found == landmark_by_source_.end() ? nullptr : landmark(found->second);
}

TrackRecord* ObjectCatalogue::trackBySource(SourceId source) {
    const auto found = std::find_if(tracks_.begin(), tracks_.end(),
                                    [source](const TrackRecord& t) { return t.source == source; });
    return found == tracks_.end() ? nullptr : &*found;
}

LandmarkRecord* ObjectCatalogue::landmark(LandmarkId id) {
    const auto at =
        std::lower_bound(landmarks_.begin(), landmarks_.end(), id.value,
                         [](const LandmarkRecord& r, std::int64_t value) { return r.id.value < value; });
    return at == landmarks_.end() || at->id != id ? nullptr : &*at;
}

const LandmarkRecord* ObjectCatalogue::landmark(LandmarkId id) const {
    return const_cast<ObjectCatalogue*>(this)->landmark(id);
}

LandmarkRecord* ObjectCatalogue::landmarkOf(BlockId block) {
    const auto found = landmark_by_block_.find(block);
    return found == landmark_by_block_.end() ? nullptr : landmark(found->second);
}

TrackRecord* ObjectCatalogue::track(TrackId id) {
    return find(tracks_, id);
}

TrackRecord* ObjectCatalogue::trackOf(BlockId block) {
    const auto found =
        std::find_if(tracks_.begin(), tracks_.end(), [block](const auto& t) { return t.block == block; });
    return found == tracks_.end() ? nullptr : &*found;
}

std::vector<TrackRecord> ObjectCatalogue::tracksUnseenFor(double longest, Stamp now) const {
    std::vector<TrackRecord> out;
    std::copy_if(tracks_.rbegin(), tracks_.rend(), std::back_inserter(out),
                 [&](const TrackRecord& track) { return secondsBetween(track.last_seen, now) > longest; });
    return out;
}

}  // namespace slamot
