#include "slamot/core/particles/MoverLife.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "slamot/core/objects/FieldOfView.h"

namespace slamot {
namespace {

const RangeBearingDetection& detectionOf(const MoverBatch& batch, int d) {
    return batch.seen.detections[static_cast<std::size_t>(d)];
}

const RangeBearingSensor& sensorOf(const MoverBatch& batch, int d) {
    return batch.seen.sensors[static_cast<std::size_t>(detectionOf(batch, d).sensor)];
}

TentativeParameters tentativeParameters(const ObjectLifeParameters& p, double velocity_std, double acceleration_std,
                                        double gate_probability) {
    return {p.landmarks,      p.movers,     p.change,        p.decide_probability,
            gate_probability, velocity_std, acceleration_std};
}

/// Whether a sensor that reports `kind` could not but show it.
bool surelySeenByAny(const MoverBatch& batch, ObjectKind kind, const MergedTargets& view, BlockId mover,
                     Consistency consistency) {
    const auto& sensors = batch.seen.sensors;
    return std::any_of(sensors.begin(), sensors.end(), [&](const RangeBearingSensor& sensor) {
        return reports(sensor, kind) &&
               surelyInView(sensor, expectedSight(view, mover, sensor.pose, consistency).detection);
    });
}

/// The same of a landmark, as the heaviest particle has it.
bool surelySeenByAny(const MoverBatch& batch, const TargetParticles& particles, const LandmarkFilter& landmark) {
    const ParticleCloud& cloud = particles.particles().cloud();
    const PoseBelief& pose = cloud.pose(cloud.weights().best());
    const auto& sensors = batch.seen.sensors;
    return std::any_of(sensors.begin(), sensors.end(), [&](const RangeBearingSensor& sensor) {
        if (!reports(sensor, ObjectKind::unknown)) return false;
        const PointSight sight = sightOf(landmark.point, placeOf(pose.mean, sensor.pose), GaussianTransform::linear);
        return surelyInView(sensor, {sight.z, sight.covariance});
    });
}

}  // namespace

MoverLife::MoverLife(const ObjectLifeParameters& parameters, Consistency consistency, double velocity_std,
                     double acceleration_std, double gate_probability)
    : parameters_(parameters),
      consistency_(consistency),
      velocity_std_(velocity_std),
      acceleration_std_(acceleration_std),
      pair_gate_(chiSquareQuantile(gate_probability, 2)),
      tentative_(tentativeParameters(parameters, velocity_std, acceleration_std, gate_probability)),
      kinds_(parameters.change),
      lost_(parameters.reidentify_probability, parameters.reidentify_within) {}

void MoverLife::clear() {
    tentative_.clear();
    kinds_.clear();
    lost_.clear();
    mixed_.clear();
    last_watch_ = robot_block;
}

void MoverLife::predict(const RelativeStep& step, const TargetModel& model) {
    tentative_.predict(step, model);
    kinds_.predict(step, model);
    lost_.predict(step.dt, model);
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
    lost_.forgetOld(batch.now);

    for (const int d : unexplained) innovations[static_cast<std::size_t>(d)].outcome = Outcome::tentative;
    for (const ConfirmedObject& confirmed :
         tentative_.update(batch.seen, batch.now, unexplained, batch.may_be_new, consistency_))
        admit(particles, tracks, confirmed, batch.now, innovations[static_cast<std::size_t>(confirmed.detection)]);
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
        const auto sight = batch.sights.find(track.block);
        if (sight != batch.sights.end())
            existence.detected(batch.likelihood_ratio[static_cast<std::size_t>(sight->second)]);
        else if (surelySeenByAny(batch, track.life->seen_as, view, track.block, consistency_))
            existence.missed(parameters_.movers.detection_probability);
    }
}

void MoverLife::lost(const TargetParticles& particles, const TrackRecord& track, Stamp now) {
    const TargetBelief last = particles.target(track.block);
    lost_.add({track.id, last.mean, last.covariance, now});
    kinds_.forget(track.block);
}

void MoverLife::removeTrack(TargetParticles& particles, ObjectCatalogue& tracks, const TrackRecord& track) {
    kinds_.forget(track.block);
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
        landmark.moving = kinds_.look(landmark.watch, landmark.moving, detectionOf(batch, verdict.detection),
                                      sensorOf(batch, verdict.detection).pose, consistency_);
        if (landmark.moving >= parameters_.decide_probability)
            becomeMover(particles, tracks, verdict.landmark, batch, verdict.detection);
    }
    for (const auto& [block, d] : batch.sights) {
        TrackRecord* track = tracks.trackOf(block);
        if (!track->life || track->life->seen_as != ObjectKind::unknown) continue;
        track->life->moving = kinds_.look(block, track->life->moving, detectionOf(batch, d), sensorOf(batch, d).pose,
                                          consistency_);
        if (track->life->moving <= 1 - parameters_.decide_probability)
            becomeLandmark(particles, tracks, *track, batch, d);
    }
}

// An object's position begins anew with the detection that shows its kind: what came before was of another.

RelativeGaussian MoverLife::sightAlone(const MoverBatch& batch, int d) const {
    return firstSight(detectionOf(batch, d), sensorOf(batch, d).pose, consistency_);
}

TrackId MoverLife::becomeMover(TargetParticles& particles, ObjectCatalogue& tracks, LandmarkId landmark,
                               const MoverBatch& batch, int d) {
    const MixedLandmark was = mixed_.at(landmark);
    const LandmarkFilter* record = particles.particles().best().find(landmark);
    const Stamp first_seen = record ? record->first_seen : batch.now;
    const Existence existence = record ? record->existence : Existence(parameters_.landmarks);
    const RelativeGaussian point = sightAlone(batch, d);
    RelativeGaussian mover = kinds_.asMover(was.watch);
    mover.mean.head<2>() = point.mean;
    mover.covariance.topRows<2>().setZero();
    mover.covariance.leftCols<2>().setZero();
    mover.covariance.topLeftCorner<2, 2>() = point.covariance;
    kinds_.forget(was.watch);
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
    addLandmark(particles, {{batch.now, detectionOf(batch, d), sensorOf(batch, d).pose}}, landmark, was.life->moving,
                batch.now);
}

LandmarkId MoverLife::addLandmark(TargetParticles& particles, const std::vector<TentativeSight>& sights,
                                  LandmarkFilter landmark, double moving, Stamp now) {
    landmark.last_seen = landmark.looked = now;
    const LandmarkId id = particles.addLandmark(sights, pair_gate_, landmark);
    mixed_[id] = {--last_watch_, moving, now};  // below the numbers of movers, which count up
    return id;
}

std::vector<int> MoverLife::findMoved(TargetParticles& particles, ObjectCatalogue& tracks, const MoverBatch& batch,
                                      std::vector<Innovation>& innovations) {
    struct Aside {
        double nis;
        LandmarkId landmark;
        int detection;
        bool operator<(const Aside& other) const {
            return std::tie(nis, landmark, detection) < std::tie(other.nis, other.landmark, other.detection);
        }
    };
    std::vector<Aside> all;
    for (auto at = mixed_.begin(); at != mixed_.end();) {
        const auto& [id, landmark] = *at;
        const LandmarkFilter* record = particles.particles().best().find(id);
        if (!record) {  // particles have let go of it
            kinds_.forget(landmark.watch);
            at = mixed_.erase(at);
            continue;
        }
        if (landmark.last_seen != batch.now && surelySeenByAny(batch, particles, *record))
            for (const int d : batch.unexplained) {
                if (detectionOf(batch, d).kind != ObjectKind::unknown) continue;
                const auto nis = kinds_.nisAsMover(landmark.watch, detectionOf(batch, d), sensorOf(batch, d).pose);
                if (nis && *nis <= pair_gate_) all.push_back({*nis, id, d});
            }
        ++at;
    }
    std::sort(all.begin(), all.end());

    std::vector<int> unexplained = batch.unexplained;
    std::set<LandmarkId> looked;
    std::set<int> taken;
    for (const Aside& aside : all) {
        if (looked.count(aside.landmark) > 0 || taken.count(aside.detection) > 0) continue;
        looked.insert(aside.landmark);
        taken.insert(aside.detection);
        MixedLandmark& landmark = mixed_.at(aside.landmark);
        const RangeBearingSensor& sensor = sensorOf(batch, aside.detection);
        landmark.moving = kinds_.lookAside(landmark.watch, detectionOf(batch, aside.detection), sensor.pose,
                                           parameters_.landmarks.detection_probability,
                                           unexplainedDensity(parameters_.landmarks, sensor));
        if (landmark.moving < parameters_.decide_probability) continue;
        const TrackId track = becomeMover(particles, tracks, aside.landmark, batch, aside.detection);
        Innovation& innovation = innovations[static_cast<std::size_t>(aside.detection)];
        innovation.kind = ObjectKind::mover;
        innovation.track = track;
        innovation.outcome = Outcome::initiated;
        unexplained.erase(std::find(unexplained.begin(), unexplained.end(), aside.detection));
    }
    return unexplained;
}

// --- new objects
// ---------------------------------------------------------------------------------------------------

void MoverLife::admit(TargetParticles& particles, ObjectCatalogue& tracks, const ConfirmedObject& confirmed, Stamp now,
                      Innovation& innovation) {
    const TentativeObject& object = confirmed.object;
    const double moving = object.track.movingProbability();
    innovation.outcome = Outcome::initiated;
    if (!confirmed.moving) {
        innovation.kind = ObjectKind::landmark;
        LandmarkFilter landmark;
        landmark.existence = object.existence;
        landmark.seen = object.seen;
        landmark.first_seen = object.first_seen;
        innovation.landmark = addLandmark(particles, object.sights, landmark, moving, now);
        return;
    }
    RelativeGaussian mover = object.track.asMover();
    if (parameters_.birth == TrackBirth::one_point)
        mover = moverAt({mover.mean.head<2>(), mover.covariance.topLeftCorner<2, 2>()}, velocity_std_,
                        acceleration_std_);
    const BlockId block = particles.addTarget(mover);
    const TargetBelief born = particles.target(block);
    TrackRecord& track = tracks.addTrack(block, {}, now, lost_.continuedBy(born.mean, born.covariance));
    track.first_seen = object.first_seen;
    tracks.giveLife(track, {object.kind, object.existence, moving, now});
    innovation.kind = ObjectKind::mover;
    innovation.track = track.id;
}

}  // namespace slamot
