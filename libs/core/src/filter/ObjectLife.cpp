#include "slamot/core/filter/ObjectLife.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "slamot/core/objects/FieldOfView.h"

namespace slamot {
namespace {

/// Landmarks further apart than this [m] are never one, however uncertain.
constexpr double farthest_duplicate = 5;
/// What two landmarks that are one may lie apart [m] when they are merged.
constexpr double merged_apart = 0.01;

/// Neither seen nor missed.
bool isInDoubt(const AssociatedBatch& batch, BlockId block) {
    return std::find(batch.in_doubt.begin(), batch.in_doubt.end(), block) != batch.in_doubt.end();
}

bool surelySeen(const GatheredView& view, BlockId block, ObjectKind kind, const RangeBearingSet& seen,
                Consistency consistency) {
    return surelySeenByAny(seen, kind, [&](const RangeBearingSensor& sensor) {
        return expectedSight(view, block, sensor.pose, consistency).detection;
    });
}

}  // namespace

ObjectLife::ObjectLife(const ObjectLifeParameters& parameters, Consistency consistency, double velocity_std,
                       double acceleration_std, double gate_probability)
    : parameters_(parameters),
      consistency_(consistency),
      pair_gate_(chiSquareQuantile(gate_probability, 2)),
      watch_(parameters, consistency, velocity_std, acceleration_std, gate_probability),
      duplicates_(parameters.landmarks.detection_probability, parameters.merge_probability) {}

void ObjectLife::clear() {
    watch_.clear();
    poses_.clear();
    duplicates_ = DuplicateWatch(parameters_.landmarks.detection_probability, parameters_.merge_probability);
    last_scan_ = {};
}

void ObjectLife::follow(ModalBelief& belief, ObjectCatalogue& objects, const AssociatedBatch& batch,
                        Stamp now, std::vector<Innovation>& innovations) {
    Sights sights;
    for (const auto* known : {&batch.known.landmarks, &batch.known.targets})
        for (const auto& sight : *known) sights[sight.block] = sight.detection;

    const std::vector<BlockId> missed = judge(belief, objects, batch, sights, now);
    changeKinds(belief, objects, batch, sights, now);
    const std::vector<int> unexplained = findMoved(belief, objects, batch, missed, now, innovations);
    merge(belief, objects);
    removeLost(belief, objects, batch, now);
    last_scan_ = now;

    for (const int d : unexplained) innovations[static_cast<std::size_t>(d)].outcome = Outcome::tentative;
    for (const ConfirmedObject& confirmed : watch_.confirmed(batch.seen, now, unexplained, batch.may_be_new))
        admit(belief, objects, confirmed, now, innovations[static_cast<std::size_t>(confirmed.detection)]);

    if (!watch_.tentative().empty()) poses_.remember(*belief, now);
    for (const BlockId block : belief->bank().landmarksWithinReach())
        objects.place(block, belief->mean(block).head<2>());
}

// --- existence
// ----------------------------------------------------------------------------------------------

std::vector<BlockId> ObjectLife::judge(ModalBelief& belief, ObjectCatalogue& objects,
                                       const AssociatedBatch& batch, const Sights& sights, Stamp now) {
    std::vector<BlockId> blocks = batch.landmarks, missed;
    for (const TrackRecord& track : objects.tracks()) blocks.push_back(track.block);
    const GatheredView view(*belief, blocks);
    for (const BlockId block : batch.landmarks)
        if (LandmarkRecord* landmark = objects.landmarkOf(block); landmark->life)
            if (!look(view, *landmark->life, block, ObjectKind::landmark, batch, sights, now))
                missed.push_back(block);
    for (TrackRecord& track : objects.tracks())
        if (track.life) look(view, *track.life, track.block, ObjectKind::mover, batch, sights, now);
    compare(view, objects, batch, sights);
    return missed;
}

bool ObjectLife::look(const GatheredView& view, ObjectLifeRecord& life, BlockId block, ObjectKind kind,
                      const AssociatedBatch& batch, const Sights& sights, Stamp now) const {
    const LifeParameters& parameters = kind == ObjectKind::mover ? parameters_.movers : parameters_.landmarks;
    life.existence.pass(secondsBetween(life.looked, now), parameters);
    life.looked = now;
    if (isInDoubt(batch, block)) return true;
    const auto sight = sights.find(block);
    if (sight == sights.end() && !surelySeen(view, block, life.seen_as, batch.seen, consistency_))
        return true;  // out of view, or at its rim, nothing is held against it
    // What may move leaves the place where it stood.
    if (kind == ObjectKind::landmark && life.seen_as == ObjectKind::unknown)
        life.existence.mayLeave(secondsBetween(last_scan_, now), parameters_.change.start_every);
    if (sight != sights.end()) {
        life.existence.detected(batch.likelihood_ratio[static_cast<std::size_t>(sight->second)]);
        return true;
    }
    life.existence.missed(parameters.detection_probability);
    return false;
}

void ObjectLife::removeLost(ModalBelief& belief, ObjectCatalogue& objects, const AssociatedBatch& batch,
                            Stamp now) {
    for (const BlockId block : batch.landmarks) {
        const LandmarkRecord* landmark = objects.landmarkOf(block);  // none: it is a mover now, or merged
        if (landmark && landmark->life && landmark->life->existence.lost(parameters_.landmarks))
            removeLandmark(belief, objects, *landmark);
    }
    const std::vector<TrackRecord> tracks = objects.tracks();
    for (const TrackRecord& track : tracks) {
        if (!track.life || !track.life->existence.lost(parameters_.movers)) continue;
        lost(*belief, track, now);
        removeTrack(belief, objects, track);
    }
}

void ObjectLife::lost(const ModalState& belief, const TrackRecord& track, Stamp now) {
    watch_.lost(track, belief.target(track.block), now);
}

void ObjectLife::removeLandmark(ModalBelief& belief, ObjectCatalogue& objects,
                                const LandmarkRecord& landmark) {
    duplicates_.forget(landmark.block);
    watch_.forget(landmark.block);
    belief->removeLandmark(landmark.block);
    objects.removeLandmark(landmark.id);
}

void ObjectLife::removeTrack(ModalBelief& belief, ObjectCatalogue& objects, const TrackRecord& track) {
    watch_.forget(track.block);
    belief.removeTarget(track.block);
    objects.removeTrack(track.id);
}

// --- landmarks that are one
// ---------------------------------------------------------------------------------

void ObjectLife::compare(const GatheredView& view, ObjectCatalogue& objects, const AssociatedBatch& batch,
                         const Sights& sights) {
    const auto living = [&](BlockId block) { return objects.landmarkOf(block)->life.has_value(); };
    for (std::size_t i = 0; i < batch.landmarks.size(); ++i) {
        const BlockId a = batch.landmarks[i];
        for (std::size_t j = i + 1; j < batch.landmarks.size(); ++j) {
            const BlockId b = batch.landmarks[j];
            const Vector2 apart = view.mean(a) - view.mean(b);
            if (apart.norm() > farthest_duplicate || !(living(a) || living(b))) continue;
            if (isInDoubt(batch, a) || isInDoubt(batch, b)) continue;
            const Matrix2 P =
                view.covariance(a, a) + view.covariance(b, b) - view.covariance(a, b) - view.covariance(b, a);
            if (apart.dot(P.llt().solve(apart)) > pair_gate_) {
                duplicates_.forget(a, b);
                continue;
            }
            const auto in_view = [&](BlockId block) {
                return sights.count(block) > 0 ||
                       surelySeen(view, block, ObjectKind::landmark, batch.seen, consistency_);
            };
            // Neighbours may be hidden together: a scan that shows neither says nothing of the two.
            const bool a_seen = sights.count(a) > 0, b_seen = sights.count(b) > 0;
            if ((a_seen || b_seen) && in_view(a) && in_view(b)) duplicates_.look(a, b, a_seen, b_seen);
        }
    }
}

void ObjectLife::merge(ModalBelief& belief, ObjectCatalogue& objects) {
    for (auto [kept, gone] : duplicates_.merged()) {
        LandmarkRecord *first = objects.landmarkOf(kept), *second = objects.landmarkOf(gone);
        if (!first || !second) continue;  // merged with a third
        if (!second->life) {              // named by the log: that one stays
            std::swap(kept, gone);
            std::swap(first, second);
        }
        first->seen += second->seen;
        first->first_seen = std::min(first->first_seen, second->first_seen);
        first->last_seen = std::max(first->last_seen, second->last_seen);
        const LandmarkId second_id = second->id;
        duplicates_.forget(gone);
        watch_.forget(gone);
        belief->mergeLandmarks(kept, gone, merged_apart);
        objects.removeLandmark(second_id);
    }
}

// --- objects of unknown kind
// --------------------------------------------------------------------------------

void ObjectLife::changeKinds(ModalBelief& belief, ObjectCatalogue& objects, const AssociatedBatch& batch,
                             const Sights& sights, Stamp now) {
    for (const auto& [block, d] : sights) {
        LandmarkRecord* landmark = objects.landmarkOf(block);
        TrackRecord* track = objects.trackOf(block);
        std::optional<ObjectLifeRecord>& life = landmark ? landmark->life : track->life;
        if (!life || life->seen_as != ObjectKind::unknown) continue;
        life->moving = watch_.look(block, life->moving, batch.seen, d);
        if (landmark && watch_.moves(life->moving) && belief.hasRoom())
            becomeMover(belief, objects, *landmark, batch, d, now);
        else if (track && watch_.stands(life->moving))
            becomeLandmark(belief, objects, *track, batch, d, now);
    }
}

TrackId ObjectLife::becomeMover(ModalBelief& belief, ObjectCatalogue& objects, const LandmarkRecord& landmark,
                                const AssociatedBatch& batch, int d, Stamp now) {
    const RelativeGaussian mover = watch_.asMover(landmark.block, batch.seen, d);
    const LandmarkRecord was = landmark;
    removeLandmark(belief, objects, was);
    TrackRecord& started = objects.addTrack(belief.addTarget(mover).value(), {}, now);
    started.first_seen = was.first_seen;
    objects.giveLife(started, *was.life);
    return started.id;
}

void ObjectLife::becomeLandmark(ModalBelief& belief, ObjectCatalogue& objects, const TrackRecord& track,
                                const AssociatedBatch& batch, int d, Stamp now) {
    const TrackRecord was = track;
    removeTrack(belief, objects, was);
    LandmarkRecord& stopped = objects.addLandmark(belief->addLandmark(watch_.anew(batch.seen, d)), {}, now);
    stopped.first_seen = was.first_seen;
    objects.place(stopped.block, belief->mean(stopped.block).head<2>());
    objects.giveLife(stopped, *was.life);
}

std::vector<int> ObjectLife::findMoved(ModalBelief& belief, ObjectCatalogue& objects,
                                       const AssociatedBatch& batch, const std::vector<BlockId>& missed,
                                       Stamp now, std::vector<Innovation>& innovations) {
    std::vector<int> unexplained = batch.unexplained;
    for (const ObjectWatch::Aside& aside : watch_.lookAside(missed, batch.seen, batch.unexplained)) {
        LandmarkRecord* landmark = objects.landmarkOf(missed[aside.object]);
        landmark->life->moving = aside.moving;
        if (!watch_.moves(aside.moving) || !belief.hasRoom()) continue;
        const TrackId track = becomeMover(belief, objects, *landmark, batch, aside.detection, now);
        tellStarted(innovations[static_cast<std::size_t>(aside.detection)], track);
        unexplained.erase(std::find(unexplained.begin(), unexplained.end(), aside.detection));
    }
    return unexplained;
}

// --- new objects
// --------------------------------------------------------------------------------------------

std::vector<PastSight> ObjectLife::pastSights(const TentativeObject& object, Stamp now) const {
    std::vector<PastSight> out;
    for (const TentativeSight& sight : object.sights) {
        const std::optional<BlockId> from = sight.at == now ? robot_block : poses_.at(sight.at);
        if (from) out.push_back({*from, sight.detection, sight.sensor});
    }
    return out;
}

void ObjectLife::admit(ModalBelief& belief, ObjectCatalogue& objects, const ConfirmedObject& confirmed,
                       Stamp now, Innovation& innovation) {
    const TentativeObject& object = confirmed.object;
    const ObjectLifeRecord life{object.kind, object.existence, object.track.movingProbability(), now};
    if (!confirmed.moving) {
        const BlockId block = belief->addLandmark(pastSights(object, now), pair_gate_);
        LandmarkRecord& landmark = objects.addLandmark(block, {}, now);
        landmark.seen = object.seen;
        landmark.first_seen = object.first_seen;
        objects.place(landmark.block, belief->mean(landmark.block).head<2>());
        objects.giveLife(landmark, life);
        tellStarted(innovation, landmark.id);
    } else if (const std::optional<BlockId> block = belief.addTarget(watch_.firstMover(object))) {
        TrackRecord& track = objects.addTrack(*block, {}, now, watch_.continuedBy(belief->target(*block)));
        track.first_seen = object.first_seen;
        objects.giveLife(track, life);
        tellStarted(innovation, track.id);
    }
}

}  // namespace slamot
