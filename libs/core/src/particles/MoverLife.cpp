#include "slamot/core/particles/MoverLife.h"

#include <algorithm>

#include "slamot/core/objects/FieldOfView.h"

namespace slamot {
namespace {

/// Whether a sensor could not but show what may move, as one particle has it.
bool surelySeen(const RangeBearingSet& seen, const TargetParticles::FoundLandmark& found) {
    return surelySeenByAny(seen, ObjectKind::unknown, [&](const RangeBearingSensor& sensor) {
        const PointSight sight =
            sightOf(found.landmark->point, placeOf(found.pose, sensor.pose), GaussianTransform::linear);
        return ExpectedDetection{sight.z, sight.covariance};
    });
}

}  // namespace

MoverLife::MoverLife(const ObjectLifeParameters& parameters, Consistency consistency, double velocity_std,
                     double acceleration_std, double gate_probability)
    : parameters_(parameters),
      consistency_(consistency),
      pair_gate_(chiSquareQuantile(gate_probability, 2)),
      watch_(parameters, consistency, velocity_std, acceleration_std, gate_probability) {}

void MoverLife::clear() {
    watch_.clear();
    mixed_.clear();
    last_watch_ = robot_block;
}

void MoverLife::follow(TargetParticles& particles, ObjectCatalogue& tracks, const MoverBatch& batch,
                       std::vector<Innovation>& innovations) {
    judge(particles, tracks, batch);
    changeKinds(particles, tracks, batch);
    const std::vector<int> unexplained = findMoved(particles, tracks, batch, innovations);
    const std::vector<TrackRecord> all = tracks.tracks();
    for (const TrackRecord& track : all) {
        if (!track.life || !track.life->existence.lost(parameters_.movers)) continue;
        lost(particles, track, batch.now);
        removeTrack(particles, tracks, track);
    }

    for (const int d : unexplained) innovations[static_cast<std::size_t>(d)].outcome = Outcome::tentative;
    for (const ConfirmedObject& confirmed :
         watch_.confirmed(batch.seen, batch.now, unexplained, batch.may_be_new))
        admit(particles, tracks, confirmed, batch.now,
              innovations[static_cast<std::size_t>(confirmed.detection)]);
}

double MoverLife::movingProbability(LandmarkId landmark) const {
    const auto found = mixed_.find(landmark);
    return found == mixed_.end() ? 0.0 : found->second.moving;
}

// --- existence
// ---------------------------------------------------------------------------------------------------

void MoverLife::judge(const TargetParticles& particles, ObjectCatalogue& tracks, const MoverBatch& batch) {
    if (!tracks.living()) return;
    const MergedTargets view = particles.merged();
    for (TrackRecord& track : tracks.tracks()) {
        if (!track.life) continue;
        Existence& existence = track.life->existence;
        existence.pass(secondsBetween(track.life->looked, batch.now), parameters_.movers);
        track.life->looked = batch.now;
        const auto in_doubt = std::find(batch.in_doubt.begin(), batch.in_doubt.end(), track.block);
        if (in_doubt != batch.in_doubt.end()) continue;
        const auto sights = batch.sights.equal_range(track.block);
        for (auto sight = sights.first; sight != sights.second; ++sight)
            existence.detected(batch.likelihood_ratio[static_cast<std::size_t>(sight->second)]);
        const auto expectedBy = [&](const RangeBearingSensor& sensor) {
            return expectedSight(view, track.block, sensor.pose, consistency_).detection;
        };
        if (sights.first == sights.second && surelySeenByAny(batch.seen, track.life->seen_as, expectedBy))
            existence.missed(parameters_.movers.detection_probability);
    }
}

void MoverLife::lost(const TargetParticles& particles, const TrackRecord& track, Stamp now) {
    watch_.lost(track, particles.target(track.block), now);
}

void MoverLife::removeTrack(TargetParticles& particles, ObjectCatalogue& tracks, const TrackRecord& track) {
    watch_.forget(track.block);
    particles.removeTarget(track.block);
    tracks.removeTrack(TrackId(track.id));
}

// --- objects of unknown kind
// ---------------------------------------------------------------------------------------------------

void MoverLife::changeKinds(TargetParticles& particles, ObjectCatalogue& tracks, const MoverBatch& batch) {
    for (const LandmarkVerdict& verdict : batch.landmarks) {
        const auto found = mixed_.find(verdict.landmark);
        if (found == mixed_.end()) continue;
        MixedLandmark& landmark = found->second;
        landmark.last_seen = batch.now;
        landmark.moving = watch_.look(landmark.watched_as, landmark.moving, batch.seen, verdict.detection);
        if (watch_.moves(landmark.moving))
            becomeMover(particles, tracks, verdict.landmark, batch, verdict.detection);
    }
    for (const auto& [block, d] : batch.sights) {
        TrackRecord* track = tracks.trackOf(block);
        if (!track || !track->life || track->life->seen_as != ObjectKind::unknown) continue;
        track->life->moving = watch_.look(block, track->life->moving, batch.seen, d);
        if (watch_.stands(track->life->moving)) becomeLandmark(particles, tracks, *track, batch, d);
    }
}

TrackId MoverLife::becomeMover(TargetParticles& particles, ObjectCatalogue& tracks, LandmarkId landmark,
                               const MoverBatch& batch, int d) {
    const MixedLandmark was = mixed_.at(landmark);
    const LandmarkFilter* record = particles.findMostly(landmark).landmark;
    const Stamp first_seen = record ? record->first_seen : batch.now;
    const Existence existence = record ? record->existence : Existence(parameters_.landmarks);
    const RelativeGaussian mover = watch_.asMover(was.watched_as, batch.seen, d);
    watch_.forget(was.watched_as);
    mixed_.erase(landmark);
    particles.removeLandmark(landmark);
    TrackRecord& started = tracks.addTrack(particles.addTarget(mover), {}, batch.now);
    started.first_seen = first_seen;
    tracks.giveLife(started, {ObjectKind::unknown, existence, was.moving, batch.now});
    return started.id;
}

void MoverLife::becomeLandmark(TargetParticles& particles, ObjectCatalogue& tracks, const TrackRecord& track,
                               const MoverBatch& batch, int d) {
    const TrackRecord was = track;
    removeTrack(particles, tracks, was);
    LandmarkFilter landmark;
    landmark.existence = was.life->existence;
    landmark.first_seen = was.first_seen;
    const RangeBearingSensor& sensor = batch.seen.sensorOf(d);
    addLandmark(particles,
                {{batch.now, batch.seen.detection(d), sensor.pose,
                  unexplainedDensity(parameters_.landmarks, sensor)}},
                landmark, was.life->moving, batch.now);
}

LandmarkId MoverLife::addLandmark(TargetParticles& particles, const std::vector<TentativeSight>& sights,
                                  LandmarkFilter landmark, double moving, Stamp now) {
    landmark.last_seen = landmark.looked = now;
    const LandmarkId id = particles.addLandmark(sights, pair_gate_, landmark);
    mixed_[id] = {--last_watch_, moving, now};  // below the numbers of movers, which count up
    return id;
}

std::vector<int> MoverLife::findMoved(TargetParticles& particles, ObjectCatalogue& tracks,
                                      const MoverBatch& batch, std::vector<Innovation>& innovations) {
    std::vector<LandmarkId> missed;
    std::vector<BlockId> watched_as;
    for (auto at = mixed_.begin(); at != mixed_.end();) {
        const auto& [id, landmark] = *at;
        const TargetParticles::FoundLandmark found = particles.findMostly(id);
        if (!found.landmark) {  // particles have let go of it
            particles.removeLandmark(id);
            watch_.forget(landmark.watched_as);
            at = mixed_.erase(at);
            continue;
        }
        if (landmark.last_seen != batch.now && surelySeen(batch.seen, found)) {
            missed.push_back(id);
            watched_as.push_back(landmark.watched_as);
        }
        ++at;
    }

    std::vector<int> unexplained = batch.unexplained;
    for (const ObjectWatch::Aside& aside : watch_.lookAside(watched_as, batch.seen, batch.unexplained)) {
        const LandmarkId landmark = missed[aside.object];
        mixed_.at(landmark).moving = aside.moving;
        if (!watch_.moves(aside.moving)) continue;
        const TrackId track = becomeMover(particles, tracks, landmark, batch, aside.detection);
        tellStarted(innovations[static_cast<std::size_t>(aside.detection)], track);
        unexplained.erase(std::find(unexplained.begin(), unexplained.end(), aside.detection));
    }
    return unexplained;
}

// --- new objects
// ---------------------------------------------------------------------------------------------------

void MoverLife::admit(TargetParticles& particles, ObjectCatalogue& tracks, const ConfirmedObject& confirmed,
                      Stamp now, Innovation& innovation) {
    const TentativeObject& object = confirmed.object;
    const double moving = object.track.movingProbability();
    if (!confirmed.moving) {
        LandmarkFilter landmark;
        landmark.existence = object.existence;
        landmark.seen = object.seen;
        landmark.first_seen = object.first_seen;
        tellStarted(innovation, addLandmark(particles, object.sights, landmark, moving, now));
        return;
    }
    const BlockId block = particles.addTarget(watch_.firstMover(object));
    TrackRecord& track = tracks.addTrack(block, {}, now, watch_.continuedBy(particles.target(block)));
    track.first_seen = object.first_seen;
    tracks.giveLife(track, {object.kind, object.existence, moving, now});
    tellStarted(innovation, track.id);
}

}  // namespace slamot
