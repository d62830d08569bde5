#include "slamot/core/filter/ObjectLife.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <set>
#include <tuple>

#include "slamot/core/objects/FieldOfView.h"

namespace slamot {
namespace {

/// Landmarks further apart than this [m] are never one, however uncertain.
constexpr double farthest_duplicate = 5;
/// What two landmarks that are one may lie apart [m] when they are merged.
constexpr double merged_apart = 0.01;

const RangeBearingDetection& detectionOf(const AssociatedBatch& batch, int d) {
    return batch.seen.detections[static_cast<std::size_t>(d)];
}

const Pose2& sensorOf(const AssociatedBatch& batch, const RangeBearingDetection& detection) {
    return batch.seen.sensors[static_cast<std::size_t>(detection.sensor)].pose;
}

/// Neither seen nor missed.
bool isInDoubt(const AssociatedBatch& batch, BlockId block) {
    return std::find(batch.in_doubt.begin(), batch.in_doubt.end(), block) != batch.in_doubt.end();
}

bool surelySeenByAny(const GatheredView& view, BlockId block, ObjectKind kind, const RangeBearingSet& seen,
                     Consistency consistency) {
    return std::any_of(seen.sensors.begin(), seen.sensors.end(), [&](const RangeBearingSensor& sensor) {
        return reports(sensor, kind) && sensor.max_range > 0 &&
               surelyInView(sensor, expectedSight(view, block, sensor.pose, consistency).detection);
    });
}

TentativeParameters tentativeParameters(const ObjectLifeParameters& p, double velocity_std,
                                        double acceleration_std, double gate_probability) {
    return {p.landmarks,      p.movers,     p.change,        p.decide_probability,
            gate_probability, velocity_std, acceleration_std};
}

}  // namespace

void describeLandmarks(ObjectLifeParameters& p, ParameterTable& landmarks) {
    describe(p.landmarks, "landmarks", landmarks);
    landmarks.real("merge_probability", p.merge_probability, "-", Interval::openProbability(),
                   "Of two landmarks being one, at which they are merged.");
}

void describeMovers(ObjectLifeParameters& p, ParameterTable& movers) {
    describe(p.movers, "movers", movers);
    movers
        .choice("birth", p.birth,
                {{"two_point", TrackBirth::two_point}, {"one_point", TrackBirth::one_point}},
                "two_point: a new mover has the velocity that the detections before its confirmation show; "
                "one_point: the prior, whatever they show.")
        .real("reidentify_within", p.reidentify_within, "s", Interval::nonNegative(),
              "A mover that comes back within that time after its track ended has its number again.")
        .real("reidentify_probability", p.reidentify_probability, "-", Interval::openProbability(),
              "Part of the movers that come back which lie inside the gate of the ended track's prediction.");
}

ParameterTable describeMixed(ObjectLifeParameters& p, const std::string& name) {
    ParameterTable mixed(name + ".mixed",
                         "Detections of which the sensor does not tell landmark from mover.");
    mixed
        .real("moving_probability", p.change.moving_probability, "-", Interval::openProbability(),
              "P(moving) of an object at first sight.")
        .real("start_every", p.change.start_every, "s", Interval::positiveOrInfinite(),
              "Time that a still object stays still, on average.")
        .real("stop_every", p.change.stop_every, "s", Interval::positiveOrInfinite(),
              "Time that a mover keeps moving, on average.")
        .real("velocity_std", p.change.velocity_std, "m/s", Interval::positive(),
              "Of each velocity component of what begins to move.")
        .real("decide_probability", p.decide_probability, "-", Interval{0.5, 1, true, true},
              "P(moving) above which an object becomes a mover; below 1 - this it becomes a landmark.");
    return mixed;
}

ObjectLife::ObjectLife(const ObjectLifeParameters& parameters, Consistency consistency, double velocity_std,
                       double acceleration_std, double gate_probability)
    : parameters_(parameters),
      consistency_(consistency),
      velocity_std_(velocity_std),
      acceleration_std_(acceleration_std),
      pair_gate_(chiSquareQuantile(gate_probability, 2)),
      tentative_(tentativeParameters(parameters, velocity_std, acceleration_std, gate_probability)),
      kinds_(parameters.change),
      duplicates_(parameters.landmarks.detection_probability, parameters.merge_probability),
      lost_(parameters.reidentify_probability, parameters.reidentify_within) {}

void ObjectLife::clear() {
    tentative_.clear();
    poses_.clear();
    kinds_.clear();
    duplicates_ = DuplicateWatch(parameters_.landmarks.detection_probability, parameters_.merge_probability);
    lost_.clear();
    last_scan_ = {};
}

void ObjectLife::predict(const RelativeStep& step, const TargetModel& model) {
    tentative_.predict(step, model);
    kinds_.predict(step, model);
    lost_.predict(step.dt, model);
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
    lost_.forgetOld(now);

    for (const int d : unexplained) innovations[static_cast<std::size_t>(d)].outcome = Outcome::tentative;
    for (const ConfirmedObject& confirmed :
         tentative_.update(batch.seen, now, unexplained, batch.may_be_new, consistency_))
        admit(belief, objects, confirmed, now, innovations[static_cast<std::size_t>(confirmed.detection)]);

    if (tentative_.size() > 0) poses_.remember(*belief, now);
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
    if (sight == sights.end() && !surelySeenByAny(view, block, life.seen_as, batch.seen, consistency_))
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
    const TargetBelief last = belief.target(track.block);
    lost_.add({track.id, last.mean, last.covariance, now});
    kinds_.forget(track.block);
}

void ObjectLife::removeLandmark(ModalBelief& belief, ObjectCatalogue& objects,
                                const LandmarkRecord& landmark) {
    duplicates_.forget(landmark.block);
    kinds_.forget(landmark.block);
    belief->removeLandmark(landmark.block);
    objects.removeLandmark(landmark.id);
}

void ObjectLife::removeTrack(ModalBelief& belief, ObjectCatalogue& objects, const TrackRecord& track) {
    kinds_.forget(track.block);
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
                       surelySeenByAny(view, block, ObjectKind::landmark, batch.seen, consistency_);
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
        kinds_.forget(gone);
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
        const RangeBearingDetection& detection = detectionOf(batch, d);
        const Pose2& sensor = sensorOf(batch, detection);
        life->moving = kinds_.look(block, life->moving, detection, sensor, consistency_);
        if (landmark && (life->moving < parameters_.decide_probability || !belief.hasRoom())) continue;
        if (track && life->moving > 1 - parameters_.decide_probability) continue;

        if (landmark)
            becomeMover(belief, objects, *landmark, detection, sensor, now);
        else
            becomeLandmark(belief, objects, *track, detection, sensor, now);
    }
}

// An object's position begins anew with the detection that shows its kind: what came before was of another.

TrackId ObjectLife::becomeMover(ModalBelief& belief, ObjectCatalogue& objects, const LandmarkRecord& landmark,
                                const RangeBearingDetection& detection, const Pose2& sensor, Stamp now) {
    const RelativeGaussian point = firstSight(detection, sensor, consistency_);
    RelativeGaussian mover = kinds_.asMover(landmark.block);
    mover.mean.head<2>() = point.mean;
    mover.covariance.topRows<2>().setZero();
    mover.covariance.leftCols<2>().setZero();
    mover.covariance.topLeftCorner<2, 2>() = point.covariance;
    const LandmarkRecord was = landmark;
    removeLandmark(belief, objects, was);
    TrackRecord& started = objects.addTrack(belief.addTarget(mover).value(), {}, now);
    started.first_seen = was.first_seen;
    objects.giveLife(started, *was.life);
    return started.id;
}

void ObjectLife::becomeLandmark(ModalBelief& belief, ObjectCatalogue& objects, const TrackRecord& track,
                                const RangeBearingDetection& detection, const Pose2& sensor, Stamp now) {
    const TrackRecord was = track;
    removeTrack(belief, objects, was);
    LandmarkRecord& stopped =
        objects.addLandmark(belief->addLandmark(firstSight(detection, sensor, consistency_)), {}, now);
    stopped.first_seen = was.first_seen;
    objects.place(stopped.block, belief->mean(stopped.block).head<2>());
    objects.giveLife(stopped, *was.life);
}

std::vector<int> ObjectLife::findMoved(ModalBelief& belief, ObjectCatalogue& objects,
                                       const AssociatedBatch& batch, const std::vector<BlockId>& missed,
                                       Stamp now, std::vector<Innovation>& innovations) {
    struct Aside {
        double nis;
        BlockId block;
        int detection;
        bool operator<(const Aside& other) const {
            return std::tie(nis, block, detection) < std::tie(other.nis, other.block, other.detection);
        }
    };
    std::vector<Aside> all;
    for (const int d : batch.unexplained) {
        const RangeBearingDetection& detection = detectionOf(batch, d);
        if (detection.kind != ObjectKind::unknown) continue;
        for (const BlockId block : missed) {
            const auto nis = kinds_.nisAsMover(block, detection, sensorOf(batch, detection));
            if (nis && *nis <= pair_gate_) all.push_back({*nis, block, d});
        }
    }
    std::sort(all.begin(), all.end());

    std::vector<int> unexplained = batch.unexplained;
    std::set<BlockId> looked;
    std::set<int> taken;
    for (const Aside& aside : all) {
        if (looked.count(aside.block) > 0 || taken.count(aside.detection) > 0) continue;
        looked.insert(aside.block);
        taken.insert(aside.detection);
        LandmarkRecord* landmark = objects.landmarkOf(aside.block);
        const RangeBearingDetection& detection = detectionOf(batch, aside.detection);
        const RangeBearingSensor& sensor = batch.seen.sensors[static_cast<std::size_t>(detection.sensor)];
        landmark->life->moving =
            kinds_.lookAside(aside.block, detection, sensor.pose, parameters_.landmarks.detection_probability,
                             unexplainedDensity(parameters_.landmarks, sensor));
        if (landmark->life->moving < parameters_.decide_probability || !belief.hasRoom()) continue;
        const TrackId track = becomeMover(belief, objects, *landmark, detection, sensor.pose, now);
        Innovation& innovation = innovations[static_cast<std::size_t>(aside.detection)];
        innovation.kind = ObjectKind::mover;
        innovation.track = track;
        innovation.outcome = Outcome::initiated;
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
        innovation.kind = ObjectKind::landmark;
        innovation.landmark = landmark.id;
    } else {
        RelativeGaussian mover = object.track.asMover();
        if (parameters_.birth == TrackBirth::one_point)
            mover = moverAt({mover.mean.head<2>(), mover.covariance.topLeftCorner<2, 2>()}, velocity_std_,
                            acceleration_std_);
        const std::optional<BlockId> block = belief.addTarget(mover);
        if (!block) return;
        const TargetBelief born = belief->target(*block);
        TrackRecord& track = objects.addTrack(*block, {}, now, lost_.continuedBy(born.mean, born.covariance));
        track.first_seen = object.first_seen;
        objects.giveLife(track, life);
        innovation.kind = ObjectKind::mover;
        innovation.track = track.id;
    }
    innovation.outcome = Outcome::initiated;
}

}  // namespace slamot
