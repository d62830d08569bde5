#include "slamot/core/particles/TargetParticleFilter.h"

#include <algorithm>

namespace slamot {
namespace {

bool isNamed(const RangeBearingDetection& detection) {
    return detection.source.valid() && detection.kind != ObjectKind::unknown;
}

}  // namespace

TargetParticleFilter::TargetParticleFilter(const TargetParticleParameters& p,
                                           const RobotMotionParameters& motion, int threads)
    : parameters_(p),
      motion_(motion),
      consistency_(consistencyOf(p)),
      models_(modelsOf(p.imm)),
      particles_(p.particles, motion,
                 {LandmarkFilters::Settings(p.landmarks, p.particles.transform), targetSettings(p),
                  p.life.movers.detection_probability},
                 ScanMaker(p.landmarks.life, p.landmarks.association != ParticleAssociation::known, true),
                 p.weigh_targets, threads),
      associator_(associationOf(p), consistency_),
      life_(lifeOf(p), consistency_, p.velocity_std, p.acceleration_std, p.landmarks.gate_probability) {}

void TargetParticleFilter::start(const PoseGaussian& pose, std::uint64_t seed) {
    particles_.start(pose, seed);
    tracks_ = {};
    limits_.clear();
    life_.clear();
}

void TargetParticleFilter::predict(const OdometryIncrement& odometry) {
    particles_.predict(odometry);
    if (life_.busy()) life_.predict(relativeStep(motion_, odometry), simplestOf(models_));
    endUnseenTracks(odometry.t1);
}

void TargetParticleFilter::endUnseenTracks(Stamp now) {
    for (const TrackRecord& track : tracks_.tracksUnseenFor(parameters_.max_unseen, now)) {
        if (track.life) life_.lost(particles_, track, now);
        particles_.removeTarget(track.block);
        tracks_.removeTrack(track.id);
    }
}

// --- one batch
// ---------------------------------------------------------------------------------------------------

UpdateReport TargetParticleFilter::update(const DetectionSet& set) {
    const RangeBearingSet seen = limits_.completed(set.rangeBearing());
    const auto has = [&](const auto& property) {
        return std::any_of(seen.detections.begin(), seen.detections.end(), property);
    };
    const bool movers = has([](const RangeBearingDetection& d) { return d.kind != ObjectKind::landmark; });
    const bool nameless = has([this](const RangeBearingDetection& d) { return isAssociated(d); });

    std::map<BlockId, double> visible;
    for (const TrackRecord& track : tracks_.tracks())
        visible[track.block] = visiblePart(lifeNow(track, set.stamp));
    UpdateReport report = particles_.updateByLandmarks(set, movers, visible);
    MoverBatch batch{seen, set.stamp};
    if (movers) updateByMovers(batch, report.innovations);
    particles_.resample();
    startNamed(batch, report.innovations);
    if (nameless || tracks_.living() || life_.busy())
        life_.follow(particles_, tracks_, batch, report.innovations);
    return report;
}

/// A mover's, or maybe a mover's, without identity, where any use is made of these.
bool TargetParticleFilter::isAssociated(const RangeBearingDetection& detection) const {
    if (isNamed(detection) || detection.kind == ObjectKind::landmark) return false;
    return parameters_.association != MoverAssociation::known &&
           (detection.kind == ObjectKind::mover ||
            parameters_.landmarks.association != ParticleAssociation::known);
}

void TargetParticleFilter::updateByMovers(MoverBatch& batch, std::vector<Innovation>& innovations) {
    batch.landmarks = particles_.landmarkVerdicts();
    pairNamed(batch, innovations);
    const MergedTargets view = particles_.merged();
    const BatchAssociation found = pairNameless(view, batch);

    std::vector<TargetDetection> detections;
    for (const auto& [block, d] : batch.sights) {
        const auto number = static_cast<std::size_t>(d);
        const TrackRecord& track = *tracks_.trackOf(block);
        const RangeBearingDetection& seen = found.merged[number];
        const RangeBearingSensor& sensor = batch.seen.sensorOf(seen);
        Innovation& innovation = innovations[number];
        innovation.kind = ObjectKind::mover;
        innovation.track = track.id;

        // Judged at the moments over all particles, so that all of them treat it alike.
        const bool weighed = found.soft && track.life;
        const OutlierGate gate = weighed ? OutlierGate{OutlierTreatment::accept} : parameters_.outliers;
        const Linearisation expected = linearise(view, block, seen, sensor.pose, consistency_);
        const Matrix2 more_noise = gate.judge(Eigen::VectorXd::Ones(1), {expected}, seen, innovation);
        if (innovation.outcome == Outcome::rejected) continue;
        tracks_.markSeen(track.id, batch.now);
        TargetDetection detection{block, d, {seen.z(), seen.covariance + more_noise, sensor.pose}};
        if (track.life) {
            detection.named = false;
            detection.visible = lifeNow(track, batch.now)->existence.visibility();
            detection.detection_probability = parameters_.life.movers.detection_probability;
            detection.unexplained = unexplainedDensity(
                seen.kind == ObjectKind::mover ? parameters_.life.movers : parameters_.landmarks.life,
                sensor);
        }
        detections.push_back(detection);
    }
    particles_.updateByTargets(detections);
}

void TargetParticleFilter::pairNamed(MoverBatch& batch, std::vector<Innovation>& innovations) {
    for (std::size_t d = 0; d < batch.seen.detections.size(); ++d) {
        const RangeBearingDetection& detection = batch.seen.detections[d];
        if (detection.kind != ObjectKind::mover || !isNamed(detection)) continue;
        const TrackRecord* track = tracks_.trackBySource(detection.source);
        if (track)
            batch.sights.emplace(track->block, static_cast<int>(d));
        else
            innovations[d].outcome = Outcome::initiated;
    }
}

std::optional<ObjectLifeRecord> TargetParticleFilter::lifeNow(const TrackRecord& track, Stamp now) const {
    std::optional<ObjectLifeRecord> life = track.life;
    if (life) life->existence.pass(secondsBetween(life->looked, now), parameters_.life.movers);
    return life;
}

BatchAssociation TargetParticleFilter::pairNameless(const MergedTargets& view, MoverBatch& batch) {
    std::vector<int> nameless;
    for (std::size_t d = 0; d < batch.seen.detections.size(); ++d)
        if (isAssociated(batch.seen.detections[d])) nameless.push_back(static_cast<int>(d));
    for (const LandmarkVerdict& verdict : batch.landmarks)
        if (verdict.explained)
            nameless.erase(std::remove(nameless.begin(), nameless.end(), verdict.detection), nameless.end());
    std::vector<VisibleObject> visible;
    for (const TrackRecord& track : tracks_.tracks())
        if (batch.sights.count(track.block) == 0)  // what an identity names is seen already
            visible.push_back({track.block, ObjectKind::mover, parameters_.life.movers.detection_probability,
                               visiblePart(lifeNow(track, batch.now))});

    const std::vector<double> density =
        unexplainedDensities(parameters_.landmarks.life, parameters_.life.movers, batch.seen);
    BatchAssociation found = associator_.associate(view, visible, batch.seen, nameless, density);
    batch.likelihood_ratio.assign(batch.seen.detections.size(), 0);
    for (const int d : nameless) {
        const BatchAssociation::Pair& pair = found.of_detection[static_cast<std::size_t>(d)];
        if (pair.object < 0) {
            batch.unexplained.push_back(d);
            continue;
        }
        batch.sights.emplace(visible[static_cast<std::size_t>(pair.object)].block, d);
        batch.likelihood_ratio[static_cast<std::size_t>(d)] = pair.likelihood_ratio;
    }
    for (std::size_t o = 0; o < visible.size(); ++o)
        if (found.in_doubt[o]) batch.in_doubt.push_back(visible[o].block);
    batch.may_be_new = found.may_be_new;
    for (const LandmarkVerdict& verdict : batch.landmarks)
        if (!verdict.may_be_new) batch.may_be_new[static_cast<std::size_t>(verdict.detection)] = false;
    return found;
}

void TargetParticleFilter::startNamed(const MoverBatch& batch, std::vector<Innovation>& innovations) {
    for (Innovation& innovation : innovations) {
        const RangeBearingDetection& detection = batch.seen.detection(innovation.detection);
        if (innovation.outcome != Outcome::initiated || detection.kind != ObjectKind::mover) continue;
        innovation.outcome = Outcome::ignored;
        // Known by now: the same new mover twice in one batch, and the first has started it.
        if (tracks_.trackBySource(detection.source)) continue;
        const Pose2& sensor = batch.seen.sensorOf(detection).pose;
        const BlockId block =
            particles_.addTarget(moverAt(firstSight(detection, sensor, consistency_),
                                         parameters_.velocity_std, parameters_.acceleration_std));
        innovation.track = tracks_.addTrack(block, detection.source, batch.now).id;
        innovation.outcome = Outcome::initiated;
    }
}

// --- estimates
// ---------------------------------------------------------------------------------------------------

std::vector<TrackEstimate> TargetParticleFilter::tracks() const {
    std::vector<TrackEstimate> out;
    const bool has_modes = !modeNames().empty();
    for (const TrackRecord& track : tracks_.tracks())
        out.push_back(estimateOf(track, particles_.target(track.block), has_modes));
    return out;
}

std::vector<LandmarkEstimate> TargetParticleFilter::withMotion(
    std::vector<LandmarkEstimate> landmarks) const {
    for (LandmarkEstimate& landmark : landmarks) landmark.moving = life_.movingProbability(landmark.id);
    return landmarks;
}

std::vector<LandmarkEstimate> TargetParticleFilter::landmarks() const {
    return withMotion(particles_.particles().landmarks());
}

std::vector<LandmarkEstimate> TargetParticleFilter::landmarks(const std::vector<LandmarkId>& ids) const {
    return withMotion(particles_.particles().landmarks(ids));
}

std::vector<LandmarkEstimate> TargetParticleFilter::tentative() const {
    return withMotion(particles_.particles().tentative());
}

}  // namespace slamot
