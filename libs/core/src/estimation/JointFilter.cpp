#include "slamot/core/estimation/JointFilter.h"

#include <cmath>

#include "slamot/core/estimation/RangeBearingUpdate.h"

namespace slamot {

JointFilter::JointFilter(const JointFilterParameters& parameters, const RobotMotionParameters& motion)
    : parameters_(parameters), motion_(motion) {}

void JointFilter::start(Stamp stamp, const PoseGaussian& pose) {
    start_ = stamp;
    bank_ = makeJointBank(parameters_.engine, pose, parameters_.consistency, 1);
    objects_ = {};
}

TargetModel JointFilter::targetModelAt(Stamp stamp) const {
    TargetModel model = parameters_.target;
    for (const ModelChange& change : parameters_.target_schedule) {
        if (stamp < later(start_, change.after)) continue;
        model.kind = change.kind;
        model.noise_std = change.noise_std;
    }
    return model;
}

void JointFilter::predict(const OdometryIncrement& odometry) {
    const MotionPrediction robot = predictMotion(motion_, belief().mean(robot_block), odometry);
    bank_->mode(0).propagate(robot_block, robot.pose, robot.F, robot.Q);

    const TargetModel model = targetModelAt(odometry.t0);
    for (const TrackRecord& track : objects_.tracks()) {
        const TargetPrediction target = predictTarget(model, belief().mean(track.block), odometry.seconds());
        bank_->mode(0).propagate(track.block, target.mean, target.F, target.Q);
    }
    endUnseenTracks(odometry.t1);
}

void JointFilter::endUnseenTracks(Stamp now) {
    for (std::size_t i = objects_.tracks().size(); i-- > 0;) {
        const TrackRecord track = objects_.tracks()[i];
        if (secondsBetween(track.last_seen, now) <= parameters_.target_max_unseen) continue;
        bank_->remove(track.block);
        objects_.removeTrack(track.id);
    }
}

UpdateReport JointFilter::update(const DetectionSet& set) {
    attend(set);
    UpdateReport report;
    batch_.clear();
    const int count = static_cast<int>(set.rangeBearing().detections.size());
    report.innovations.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) report.innovations.push_back(match(set, i));

    bank_->mode(0).update(batch_);

    for (const ObjectKind kind : {ObjectKind::mover, ObjectKind::landmark})
        for (Innovation& innovation : report.innovations)
            if (innovation.outcome == Outcome::initiated && innovation.kind == kind) initiate(set, innovation);
    return report;
}

void JointFilter::attend(const DetectionSet& set) {
    measured_.clear();
    for (const RangeBearingDetection& detection : set.rangeBearing().detections) {
        if (!detection.source.valid() || detection.kind != ObjectKind::landmark) continue;
        if (const LandmarkRecord* landmark = objects_.landmarkBySource(detection.source))
            measured_.push_back(landmark->block);
    }
    const Pose2 robot = Pose2::fromVector(belief().mean(robot_block));
    const Eigen::Matrix<double, 1, 1> sure(1.0);
    bank_->attend({robot, set.rangeBearing(), measured_}, sure);
}

Innovation JointFilter::match(const DetectionSet& set, int index) {
    const RangeBearingDetection& detection = set.rangeBearing().detections[index];
    Innovation innovation;
    innovation.detection = index;
    innovation.kind = detection.kind;
    if (!detection.source.valid() || detection.kind == ObjectKind::unknown) return innovation;

    if (detection.kind == ObjectKind::mover) {
        TrackRecord* track = objects_.trackBySource(detection.source);
        innovation.outcome = track ? addToBatch(set, index, track->block, innovation) : Outcome::initiated;
        if (track) innovation.track = track->id;
        if (track && innovation.outcome != Outcome::rejected) track->last_seen = set.stamp;
    } else {
        LandmarkRecord* landmark = objects_.landmarkBySource(detection.source);
        innovation.outcome = landmark ? addToBatch(set, index, landmark->block, innovation) : Outcome::initiated;
        if (landmark) innovation.landmark = landmark->id;
        if (landmark && innovation.outcome != Outcome::rejected) {
            landmark->last_seen = set.stamp;
            ++landmark->seen;
        }
    }
    return innovation;
}

Outcome JointFilter::addToBatch(const DetectionSet& set, int index, BlockId block, Innovation& innovation) {
    const RangeBearingSet& seen = set.rangeBearing();
    const RangeBearingDetection& detection = seen.detections[index];
    Linearisation linear =
        linearise(belief(), block, detection, seen.sensors[detection.sensor].pose, parameters_.consistency);
    innovation.residual = linear.measurement.residual;
    innovation.covariance = linear.S;
    innovation.nis = linear.nis;

    // NIS of two rows stays below this with gate_probability: the chi-square quantile in closed form.
    const double gate = -2.0 * std::log1p(-parameters_.gate_probability);
    Outcome outcome = Outcome::updated;
    if (linear.nis > gate && parameters_.outliers == OutlierTreatment::reject) return Outcome::rejected;
    if (linear.nis > gate && parameters_.outliers == OutlierTreatment::inflate) {
        outcome = Outcome::inflated;
        linear.measurement.R += (std::pow(linear.nis / gate, 2) - 1.0) * detection.covariance;
    }
    batch_.push_back(linear.measurement);
    return outcome;
}

void JointFilter::initiate(const DetectionSet& set, Innovation& innovation) {
    const RangeBearingSet& seen = set.rangeBearing();
    const RangeBearingDetection& detection = seen.detections[innovation.detection];
    const bool mover = innovation.kind == ObjectKind::mover;
    const bool known = mover ? objects_.trackBySource(detection.source) != nullptr
                             : objects_.landmarkBySource(detection.source) != nullptr;
    if (known) {  // the same new object twice in one batch: the first has started it
        innovation.outcome = Outcome::ignored;
        return;
    }

    const FirstSight sight = firstSight(belief(), detection, seen.sensors[detection.sensor].pose, parameters_.consistency);
    if (!mover) {
        const BlockId block = bank_->augment(BlockKind::landmark, {sight.position, sight.G, sight.own});
        innovation.landmark = objects_.addLandmark(block, detection.source, set.stamp).id;
        return;
    }
    // A mover's velocity and acceleration are not seen at first sight: priors around zero.
    Vector6 mean = Vector6::Zero();
    mean.head<2>() = sight.position;
    Eigen::Matrix<double, 6, 3> G = Eigen::Matrix<double, 6, 3>::Zero();
    G.topRows<2>() = sight.G;
    Matrix6 own = Matrix6::Zero();
    own.topLeftCorner<2, 2>() = sight.own;
    own.diagonal().segment<2>(2).setConstant(std::pow(parameters_.target_velocity_std, 2));
    own.diagonal().segment<2>(4).setConstant(std::pow(parameters_.target_acceleration_std, 2));
    const BlockId block = bank_->augment(BlockKind::target, {mean, G, own});
    innovation.track = objects_.addTrack(block, detection.source, set.stamp).id;
}

PoseGaussian JointFilter::robot() const {
    return {Pose2::fromVector(belief().mean(robot_block)), belief().covariance(robot_block, robot_block)};
}

std::vector<TrackEstimate> JointFilter::tracks() const {
    std::vector<TrackEstimate> out;
    out.reserve(objects_.tracks().size());
    for (const TrackRecord& track : objects_.tracks()) {
        TrackEstimate estimate;
        estimate.id = track.id;
        estimate.source = track.source;
        estimate.mean = belief().mean(track.block);
        estimate.covariance = belief().covariance(track.block, track.block);
        out.push_back(std::move(estimate));
    }
    return out;
}

LandmarkEstimate JointFilter::estimateOf(const LandmarkRecord& landmark) const {
    return {landmark.id,   landmark.source,     belief().mean(landmark.block),
            belief().covariance(landmark.block, landmark.block),
            landmark.seen, landmark.first_seen, landmark.last_seen};
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
    out.matrix = belief().jointCovariance(blocks);
    return out;
}

}  // namespace slamot
