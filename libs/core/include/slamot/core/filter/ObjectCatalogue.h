#pragma once
// Which block of the joint state is which landmark or mover, where landmarks are, and how sure it is that
// they are there.
#include <optional>
#include <unordered_map>
#include <vector>

#include "slamot/core/association/LandmarkIndex.h"
#include "slamot/core/data/Estimate.h"
#include "slamot/core/data/Identities.h"
#include "slamot/core/data/Stamp.h"
#include "slamot/core/objects/Existence.h"

namespace slamot {

struct TargetBelief;

/// The life of an object to which the log gives no identity.
struct ObjectLifeRecord {
    ObjectKind seen_as;  ///< kind of its detections
    Existence existence;
    double moving;  ///< P(moving)
    Stamp looked;   ///< when existence was judged last
};

/// Part of the time that nothing hides it, if it is there. Never so small that a detection could not be its
/// own.
double visiblePart(const std::optional<ObjectLifeRecord>& life);

struct LandmarkRecord {
    LandmarkId id;
    SourceId source;
    BlockId block;
    std::int64_t seen;
    Stamp first_seen, last_seen;
    std::optional<ObjectLifeRecord> life;  ///< none: the log's identity vouches for it
};

struct TrackRecord {
    TrackId id;
    SourceId source;
    BlockId block;
    Stamp first_seen, last_seen;
    std::optional<ObjectLifeRecord> life;
};

/// What is told of a track; without mode probabilities where it has one mode.
TrackEstimate estimateOf(const TrackRecord& track, const TargetBelief& belief, bool tell_modes);

/// Landmarks and live tracks; ids count up and are never given to another object.
class ObjectCatalogue {
  public:
    LandmarkRecord& addLandmark(BlockId block, SourceId source, Stamp now);
    /// `again`: the id of a track that was gone and goes on.
    TrackRecord& addTrack(BlockId block, SourceId source, Stamp now,
                          std::optional<TrackId> again = std::nullopt);
    void removeLandmark(LandmarkId id);
    void removeTrack(TrackId id);
    /// Another sight of it.
    void markSeen(LandmarkId id, Stamp now);
    void markSeen(TrackId id, Stamp now);
    /// A landmark's position has changed.
    void place(BlockId landmark, const Vector2& position) { positions_.set(landmark, position); }

    /// By the log's identity; null for none.
    LandmarkRecord* landmarkBySource(SourceId source);
    TrackRecord* trackBySource(SourceId source);
    LandmarkRecord* landmark(LandmarkId id);
    const LandmarkRecord* landmark(LandmarkId id) const;
    LandmarkRecord* landmarkOf(BlockId block);
    TrackRecord* track(TrackId id);
    TrackRecord* trackOf(BlockId block);

    /// Ascending by id.
    const std::vector<LandmarkRecord>& landmarks() const { return landmarks_; }
    const std::vector<TrackRecord>& tracks() const { return tracks_; }
    std::vector<TrackRecord>& tracks() { return tracks_; }
    /// Those not seen for longer than that [s], the latest first.
    std::vector<TrackRecord> tracksUnseenFor(double longest, Stamp now) const;
    /// Where landmarks are, as far as `place` was told.
    const LandmarkIndex& positions() const { return positions_; }
    /// Whether any object has a life of its own.
    bool living() const { return living_ > 0; }

    /// Says that an object has a life of its own.
    template <class Record>
    void giveLife(Record& record, ObjectLifeRecord life) {
        living_ += record.life ? 0 : 1;
        record.life = std::move(life);
    }

  private:
    std::vector<LandmarkRecord> landmarks_;  ///< ascending by id
    std::vector<TrackRecord> tracks_;        ///< ascending by id
    std::unordered_map<SourceId, LandmarkId> landmark_by_source_;
    std::unordered_map<BlockId, LandmarkId> landmark_by_block_;
    LandmarkIndex positions_;
    std::int64_t next_landmark_ = 0, next_track_ = 0;
    int living_ = 0;
};

}  // namespace slamot
