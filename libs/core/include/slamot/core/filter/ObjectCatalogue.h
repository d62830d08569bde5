#pragma once
// Which block of the joint state is which landmark or mover.
#include <unordered_map>
#include <vector>

#include "slamot/core/data/Identities.h"
#include "slamot/core/data/Stamp.h"
#include "slamot/core/estimation/Blocks.h"

namespace slamot {

struct LandmarkRecord {
    LandmarkId id;
    SourceId source;
    BlockId block;
    std::int64_t seen;
    Stamp first_seen, last_seen;
};

struct TrackRecord {
    TrackId id;
    SourceId source;
    BlockId block;
    Stamp first_seen, last_seen;
};

/// Landmarks and live tracks in the order they were added; ids count up and are never reused.
class ObjectCatalogue {
   public:
    LandmarkRecord& addLandmark(BlockId block, SourceId source, Stamp now);
    TrackRecord& addTrack(BlockId block, SourceId source, Stamp now);
    void removeTrack(TrackId id);
    /// Another sight of it.
    void markSeen(LandmarkId id, Stamp now);
    void markSeen(TrackId id, Stamp now);

    /// By the log's identity; null for none.
    LandmarkRecord* landmarkBySource(SourceId source);
    TrackRecord* trackBySource(SourceId source);
    const LandmarkRecord* landmark(LandmarkId id) const;

    const std::vector<LandmarkRecord>& landmarks() const { return landmarks_; }
    const std::vector<TrackRecord>& tracks() const { return tracks_; }

   private:
    std::vector<LandmarkRecord> landmarks_;  ///< at the index that is its id
    std::vector<TrackRecord> tracks_;
    std::unordered_map<SourceId, std::size_t> landmark_by_source_;
    std::int64_t next_track_ = 0;
};

}  // namespace slamot
