#include "slamot/core/filter/JointFilter.h"

#include "slamot/core/estimation/BankedImm.h"
#include "slamot/core/estimation/DecoupledImm.h"

namespace slamot {

std::shared_ptr<const ModalSettings> settingsFrom(const JointFilterParameters& p,
                                                  const RobotMotionParameters& motion) {
    return std::make_shared<const ModalSettings>(ModalSettings{motion,
                                                               {p.outliers, p.gate_probability},
                                                               chainOf(p.imm),
                                                               initialProbabilities(p.imm),
                                                               p.imm.likelihood});
}

JointFilter::JointFilter(const JointFilterParameters& parameters, const RobotMotionParameters& motion)
    : parameters_(parameters),
      settings_(settingsFrom(parameters, motion)),
      models_(modelsOf(parameters.imm)) {
    if (models_.empty()) models_.push_back(parameters_.target);
}

void JointFilter::start(Stamp stamp, const PoseGaussian& pose) {
    start_ = stamp;
    auto bank = makeJointBank(parameters_.engine, pose, parameters_.consistency, 1);
    if (parameters_.imm.form == ImmForm::decoupled)
        belief_ = std::make_unique<DecoupledImm>(settings_, std::move(bank));
    else
        belief_ = std::make_unique<JointImm>(settings_, std::move(bank));
    if (parameters_.imm.form == ImmForm::scalable) becomeScalable();
    objects_ = {};
}

void JointFilter::predict(const OdometryIncrement& odometry) {
    setModels(odometry.t0);
    belief_->predict(odometry, models_);
    endUnseenTracks(odometry.t1);
}

void JointFilter::setModels(Stamp stamp) {
    if (!parameters_.imm.modes.empty()) return;
    models_.front() = parameters_.target;
    for (const ModelChange& change : parameters_.target_schedule) {
        if (stamp < later(start_, change.after)) continue;
        models_.front().kind = change.kind;
        models_.front().noise_std = change.noise_std;
    }
}

UpdateReport JointFilter::update(const DetectionSet& set) {
    const RangeBearingSet& seen = set.rangeBearing();
    UpdateReport report;
    report.innovations.reserve(seen.detections.size());
    known_.clear();
    measured_.clear();
    for (std::size_t i = 0; i < seen.detections.size(); ++i)
        report.innovations.push_back(associate(seen.detections[i], static_cast<int>(i)));

    belief_->attend(seen, measured_);
    belief_->update(seen, known_, report.innovations);

    for (const Innovation& innovation : report.innovations) markSeen(innovation, set.stamp);
    for (const ObjectKind kind : {ObjectKind::mover, ObjectKind::landmark})
        for (Innovation& innovation : report.innovations)
            if (innovation.outcome == Outcome::initiated && innovation.kind == kind)
                initiate(set, innovation);
    return report;
}

// --- life of objects
// ---------------------------------------------------------------------------------------------

Innovation JointFilter::associate(const RangeBearingDetection& detection, int index) {
    Innovation innovation;
    innovation.detection = index;
    innovation.kind = detection.kind;
    if (!detection.source.valid() || detection.kind == ObjectKind::unknown) return innovation;

    innovation.outcome = Outcome::initiated;
    if (detection.kind == ObjectKind::mover) {
        const TrackRecord* track = objects_.trackBySource(detection.source);
        if (!track) return innovation;
        innovation.track = track->id;
        known_.targets.push_back({index, track->block});
        measured_.push_back(track->block);
    } else {
        const LandmarkRecord* landmark = objects_.landmarkBySource(detection.source);
        if (!landmark) return innovation;
        innovation.landmark = landmark->id;
        known_.landmarks.push_back({index, landmark->block});
        measured_.push_back(landmark->block);
    }
    return innovation;
}

void JointFilter::markSeen(const Innovation& innovation, Stamp now) {
    if (innovation.outcome != Outcome::updated && innovation.outcome != Outcome::inflated) return;
    if (innovation.kind == ObjectKind::mover)
        objects_.markSeen(innovation.track, now);
    else
        objects_.markSeen(innovation.landmark, now);
}

void JointFilter::initiate(const DetectionSet& set, Innovation& innovation) {
    const RangeBearingSet& seen = set.rangeBearing();
    const RangeBearingDetection& detection = seen.detections[innovation.detection];
    const Pose2& sensor = seen.sensors[detection.sensor].pose;
    const RelativeGaussian point = firstSight(detection, sensor, parameters_.consistency);
    const bool mover = innovation.kind == ObjectKind::mover;
    const bool known = mover ? objects_.trackBySource(detection.source) != nullptr
                             : objects_.landmarkBySource(detection.source) != nullptr;
    // Known by now: the same new object twice in one batch, and the first has started it.
    if (known || (mover && !admitTarget())) {
        innovation.outcome = Outcome::ignored;
        return;
    }
    if (mover) {
        const BlockId block = belief_->addTarget(
            moverAt(point, parameters_.target_velocity_std, parameters_.target_acceleration_std));
        innovation.track = objects_.addTrack(block, detection.source, set.stamp).id;
    } else {
        const BlockId block = belief_->addLandmark(point);
        innovation.landmark = objects_.addLandmark(block, detection.source, set.stamp).id;
    }
}

void JointFilter::endUnseenTracks(Stamp now) {
    for (std::size_t i = objects_.tracks().size(); i-- > 0;) {
        const TrackRecord track = objects_.tracks()[i];
        if (secondsBetween(track.last_seen, now) <= parameters_.target_max_unseen) continue;
        belief_->removeTarget(track.block);
        objects_.removeTrack(track.id);
    }
    if (objects_.tracks().empty() && parameters_.imm.form == ImmForm::automatic) becomeExact();
}

// --- forms of the IMM
// --------------------------------------------------------------------------------------------

bool JointFilter::admitTarget() {
    const bool room = settings_->chain.modes() == 1 ||
                      objects_.tracks().size() < static_cast<std::size_t>(parameters_.imm.max_exact_targets);
    if (!room && parameters_.imm.form == ImmForm::automatic) becomeScalable();
    return room || parameters_.imm.form != ImmForm::exact;
}

void JointFilter::becomeScalable() {
    if (auto* exact = dynamic_cast<JointImm*>(belief_.get()))
        belief_ = std::make_unique<BankedImm>(settings_, std::move(*exact));
}

void JointFilter::becomeExact() {
    if (auto* scalable = dynamic_cast<BankedImm*>(belief_.get()))
        belief_ = std::make_unique<JointImm>(settings_, scalable->release());
}

// --- estimates
// ---------------------------------------------------------------------------------------------------

std::vector<std::string> JointFilter::modeNames() const {
    std::vector<std::string> names;
    for (const TargetMode& mode : parameters_.imm.modes) names.push_back(mode.name);
    return names;
}

PoseGaussian JointFilter::robot() const {
    return {Pose2::fromVector(belief_->mean(robot_block)), belief_->covariance(robot_block, robot_block)};
}

std::vector<TrackEstimate> JointFilter::tracks() const {
    std::vector<TrackEstimate> out;
    out.reserve(objects_.tracks().size());
    for (const TrackRecord& track : objects_.tracks()) {
        const TargetBelief belief = belief_->target(track.block);
        TrackEstimate estimate;
        estimate.id = track.id;
        estimate.source = track.source;
        estimate.mean = belief.mean;
        estimate.covariance = belief.covariance;
        if (!parameters_.imm.modes.empty())
            estimate.mode_probabilities.assign(belief.mode_probabilities.begin(),
                                               belief.mode_probabilities.end());
        out.push_back(std::move(estimate));
    }
    return out;
}

LandmarkEstimate JointFilter::estimateOf(const LandmarkRecord& landmark) const {
    return {landmark.id,
            landmark.source,
            belief_->mean(landmark.block),
            belief_->covariance(landmark.block, landmark.block),
            landmark.seen,
            landmark.first_seen,
            landmark.last_seen};
}

std::vector<LandmarkEstimate> JointFilter::landmarks() const {
    std::vector<LandmarkEstimate> out;
    for (const LandmarkRecord& landmark : objects_.landmarks()) out.push_back(estimateOf(landmark));
    return out;
}

std::vector<LandmarkEstimate> JointFilter::landmarks(const std::vector<LandmarkId>& ids) const {
    std::vector<LandmarkEstimate> out;
    for (const LandmarkId id : ids)
        if (const LandmarkRecord* landmark = objects_.landmark(id)) out.push_back(estimateOf(*landmark));
    return out;
}

JointCovariance JointFilter::jointCovariance() const {
    JointCovariance out;
    std::vector<BlockId> blocks{robot_block};
    for (const TrackRecord& track : objects_.tracks()) {
        out.tracks.push_back(track.id);
        blocks.push_back(track.block);
    }
    for (const LandmarkRecord& landmark : objects_.landmarks()) {
        out.landmarks.push_back(landmark.id);
        blocks.push_back(landmark.block);
    }
    out.matrix = belief_->jointCovariance(blocks);
    return out;
}

}  // namespace slamot
