#include "slamot/core/filter/JointFilter.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace slamot {

std::shared_ptr<const ModalSettings> settingsFrom(const JointFilterParameters& p,
                                                  const RobotMotionParameters& motion) {
    return std::make_shared<const ModalSettings>(ModalSettings{motion,
                                                               {p.outliers, p.gate_probability},
                                                               chainOf(p.imm),
                                                               initialProbabilities(p.imm),
                                                               p.imm.likelihood});
}

namespace {

std::vector<Innovation> innovationsOf(const RangeBearingSet& seen) {
    std::vector<Innovation> out(seen.detections.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i].detection = static_cast<int>(i);
        out[i].kind = seen.detections[i].kind;
    }
    return out;
}

}  // namespace

JointFilter::JointFilter(const JointFilterParameters& p, const RobotMotionParameters& motion)
    : parameters_(p),
      motion_(motion),
      belief_(settingsFrom(p, motion), p.imm.form, p.imm.max_exact_targets),
      association_(p.association, p.life.landmarks, p.life.movers, p.consistency),
      life_(p.life, p.consistency, p.target_velocity_std, p.target_acceleration_std,
            p.association.gate_probability),
      models_(modelsOf(p.imm)) {
    if (models_.empty()) models_.push_back(parameters_.target);
}

void JointFilter::start(Stamp stamp, const PoseGaussian& pose) {
    start_ = stamp;
    belief_.start(makeJointBank(parameters_.engine, pose, parameters_.consistency, 1));
    objects_ = {};
    limits_.clear();
    life_.clear();
}

void JointFilter::predict(const OdometryIncrement& odometry) {
    setModels(odometry.t0);
    belief_->predict(odometry, models_);
    if (life_.busy()) life_.predict(relativeStep(motion_, odometry), simplestOf(models_));
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

void JointFilter::endUnseenTracks(Stamp now) {
    for (const TrackRecord& track : objects_.tracksUnseenFor(parameters_.target_max_unseen, now)) {
        if (track.life) life_.lost(*belief_, track, now);
        belief_.removeTarget(track.block);
        objects_.removeTrack(track.id);
    }
}

// --- one batch
// ---------------------------------------------------------------------------------------------------

UpdateReport JointFilter::update(const DetectionSet& set) {
    const RangeBearingSet& seen = set.rangeBearing();
    if (!objects_.living() && !life_.busy() && !association_.concerns(seen))
        return updateByIdentity(seen, set.stamp);
    return updateByAssociation(limits_.completed(seen), set.stamp);
}

UpdateReport JointFilter::updateByIdentity(const RangeBearingSet& seen, Stamp now) {
    UpdateReport report{innovationsOf(seen)};
    known_.clear();
    ObjectAssociation::byIdentity(objects_, seen, report.innovations, known_);
    measured_.clear();
    for (const auto* sights : {&known_.landmarks, &known_.targets})
        for (const auto& sight : *sights) measured_.push_back(sight.block);
    belief_->attend(seen, measured_);
    update(seen, known_, report.innovations, now);
    startNamed(seen, now, report.innovations);
    return report;
}

UpdateReport JointFilter::updateByAssociation(const RangeBearingSet& seen, Stamp now) {
    UpdateReport report{innovationsOf(seen)};
    const AssociatedBatch batch = association_.associate(*belief_, objects_, seen, report.innovations);
    update(batch.used, batch.known, report.innovations, now);
    startNamed(seen, now, report.innovations);
    life_.follow(belief_, objects_, batch, now, report.innovations);
    return report;
}

void JointFilter::update(const RangeBearingSet& used, const KnownObjects& known,
                         std::vector<Innovation>& innovations, Stamp now) {
    belief_->update(used, known, innovations);
    for (const Innovation& innovation : innovations) markSeen(innovation, now);
    for (const auto& sight : known.targets) holdFloor(sight.block);
}

void JointFilter::markSeen(const Innovation& innovation, Stamp now) {
    if (innovation.outcome != Outcome::updated && innovation.outcome != Outcome::inflated) return;
    if (innovation.kind == ObjectKind::mover)
        objects_.markSeen(innovation.track, now);
    else
        objects_.markSeen(innovation.landmark, now);
}

void JointFilter::holdFloor(BlockId target) {
    holdFloor(target, belief_->covariance(target, target).topLeftCorner<2, 2>());
    // The scalable form's banks, which are reported, may be surer than the joint state, which detections are
    // compared with.
    if (!parameters_.imm.modes.empty())
        holdFloor(target, belief_->target(target).covariance.topLeftCorner<2, 2>());
}

void JointFilter::holdFloor(BlockId target, const Matrix2& P) {
    const double floor = parameters_.target_position_floor * parameters_.target_position_floor;
    const Eigen::SelfAdjointEigenSolver<Matrix2> axes(P);
    if (axes.eigenvalues()(0) >= floor) return;
    const Vector2 missing = (floor - axes.eigenvalues().array()).max(0);
    Matrix6 Q = Matrix6::Zero();
    Q.topLeftCorner<2, 2>() = axes.eigenvectors() * missing.asDiagonal() * axes.eigenvectors().transpose();
    belief_->widenTarget(target, Q);
}

void JointFilter::startNamed(const RangeBearingSet& seen, Stamp now, std::vector<Innovation>& innovations) {
    for (const ObjectKind kind : {ObjectKind::mover, ObjectKind::landmark})
        for (Innovation& innovation : innovations)
            if (innovation.outcome == Outcome::initiated && innovation.kind == kind)
                start(seen, now, innovation);
}

void JointFilter::start(const RangeBearingSet& seen, Stamp now, Innovation& innovation) {
    const RangeBearingDetection& detection = seen.detection(innovation.detection);
    const Pose2& sensor = seen.sensorOf(detection).pose;
    const RelativeGaussian point = firstSight(detection, sensor, parameters_.consistency);
    innovation.outcome = Outcome::ignored;
    // Known by now: the same new object twice in one batch, and the first has started it.
    if (innovation.kind == ObjectKind::mover) {
        if (objects_.trackBySource(detection.source)) return;
        const auto block = belief_.addTarget(
            moverAt(point, parameters_.target_velocity_std, parameters_.target_acceleration_std));
        if (!block) return;
        innovation.track = objects_.addTrack(*block, detection.source, now).id;
    } else {
        if (objects_.landmarkBySource(detection.source)) return;
        const BlockId block = belief_->addLandmark(point);
        innovation.landmark = objects_.addLandmark(block, detection.source, now).id;
    }
    innovation.outcome = Outcome::initiated;
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
    for (const TrackRecord& track : objects_.tracks())
        out.push_back(
            slamot::estimateOf(track, belief_->target(track.block), !parameters_.imm.modes.empty()));
    return out;
}

LandmarkEstimate JointFilter::estimateOf(const LandmarkRecord& landmark) const {
    return {landmark.id,
            landmark.source,
            belief_->mean(landmark.block),
            belief_->covariance(landmark.block, landmark.block),
            landmark.seen,
            landmark.first_seen,
            landmark.last_seen,
            landmark.life ? landmark.life->existence.probability() : 1.0,
            landmark.life ? landmark.life->moving : 0.0};
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

std::vector<LandmarkEstimate> JointFilter::tentative() const {
    std::vector<LandmarkEstimate> out;
    const PoseGaussian pose = robot();
    for (const TentativeObject& object : life_.tentative()) {
        const double moving = object.track.movingProbability();
        if (moving == 1) continue;
        const NewBlock place = inWorld(object.track.asLandmark(), pose.mean.vector());
        const Matrix2 covariance = place.G * pose.covariance * place.G.transpose() + place.own;
        out.push_back({{},
                       {},
                       place.mean,
                       covariance,
                       object.seen,
                       object.first_seen,
                       object.last_seen,
                       object.existence.probability(),
                       moving});
    }
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
