#include "MrptKfSlam.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>

#include <cmath>
#include <set>

IMPLEMENTS_MRPT_OBJECT(MrptKfSlam, Estimator, slamot)

namespace slamot {
namespace {

mrpt::obs::CActionCollection::Ptr actionOf(const PoseGaussian& moved) {
    mrpt::poses::CPosePDFGaussian change;
    change.mean = mrpt::poses::CPose2D(moved.mean.x, moved.mean.y, moved.mean.theta);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) change.cov(i, j) = moved.covariance(i, j);
    mrpt::obs::CActionRobotMovement2D movement;
    movement.poseChange = mrpt::poses::CPosePDFGaussian::Create(change);
    auto actions = mrpt::obs::CActionCollection::Create();
    actions->insert(movement);
    return actions;
}

}  // namespace

/// The filter with its state open to a start that is not the origin.
class MrptKfSlam::Filter : public mrpt::slam::CRangeBearingKFSLAM2D {
  public:
    using CRangeBearingKFSLAM2D::getLandmarkIDsFromIndexInStateVector;

    Filter() { setMinLoggingLevel(mrpt::system::LVL_ERROR); }

    PoseGaussian robot() const {
        PoseGaussian pose{{m_xkk[0], m_xkk[1], m_xkk[2]}, Matrix3::Zero()};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) pose.covariance(i, j) = m_pkk(i, j);
        return pose;
    }
    void setRobot(const PoseGaussian& pose) {
        const Vector3 mean = pose.mean.vector();
        for (int i = 0; i < 3; ++i) {
            m_xkk[i] = mean[i];
            for (int j = 0; j < 3; ++j) m_pkk(i, j) = pose.covariance(i, j);
        }
    }
    Vector2 landmarkMean(unsigned index) const {
        const auto at = 3 + 2 * static_cast<int>(index);
        return {m_xkk[at], m_xkk[at + 1]};
    }
    Matrix2 landmarkCovariance(unsigned index) const {
        const auto at = 3 + 2 * static_cast<int>(index);
        Matrix2 P;
        P << m_pkk(at, at), m_pkk(at, at + 1), m_pkk(at + 1, at), m_pkk(at + 1, at + 1);
        return 0.5 * (P + P.transpose());
    }
};

MrptKfSlam::~MrptKfSlam() = default;

std::vector<ParameterTable> MrptKfSlam::onParameters() {
    return {describe(motion_),
            ParameterTable("mrpt_kf_slam", "MRPT's CRangeBearingKFSLAM2D with its defaults.")};
}

void MrptKfSlam::onStart(const Start& start) {
    filter_ = std::make_unique<Filter>();
    filter_->setRobot(start.pose);
    moved_ = {};
    seen_.clear();
}

void MrptKfSlam::onPredict(const OdometryIncrement& odometry) {
    const MotionPrediction step = predictMotion(motion_, moved_.mean.vector(), odometry);
    moved_.mean = Pose2::fromVector(step.pose);
    moved_.covariance = step.F * moved_.covariance * step.F.transpose() + step.Q;
}

PoseGaussian MrptKfSlam::onRobot() const {
    const PoseGaussian start = filter_->robot();
    const Pose2 robot = start.mean * moved_.mean;
    Matrix3 F = Matrix3::Identity(), G = Matrix3::Identity();
    F.topRightCorner<2, 1>() = quarterTurn() * (robot.position() - start.mean.position());
    G.topLeftCorner<2, 2>() = rotation(start.mean.theta);
    const Matrix3 P = F * start.covariance * F.transpose() + G * moved_.covariance * G.transpose();
    return {robot, 0.5 * (P + P.transpose())};
}

UpdateReport MrptKfSlam::onUpdate(const DetectionSet& set) {
    UpdateReport report;
    const auto& seen = set.rangeBearing().detections;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        Innovation innovation;
        innovation.detection = static_cast<int>(i);
        innovation.kind = seen[i].kind;
        report.innovations.push_back(innovation);
    }
    for (std::size_t sensor = 0; sensor < set.rangeBearing().sensors.size(); ++sensor)
        process(set, static_cast<int>(sensor), report);
    return report;
}

void MrptKfSlam::process(const DetectionSet& set, int sensor, UpdateReport& report) {
    const RangeBearingSet& all = set.rangeBearing();
    auto observation = mrpt::obs::CObservationBearingRange::Create();
    const Pose2& on_robot = all.sensors[sensor].pose;
    observation->sensorLocationOnRobot =
        mrpt::poses::CPose3D(on_robot.x, on_robot.y, 0, on_robot.theta, 0, 0);
    std::set<SourceId> in_this_scan;
    for (Innovation& innovation : report.innovations) {
        const RangeBearingDetection& detection = all.detections[innovation.detection];
        if (detection.sensor != sensor || detection.kind != ObjectKind::landmark || !detection.source.valid())
            continue;
        // MRPT stops at a landmark that is there twice.
        if (!in_this_scan.insert(detection.source).second) continue;
        if (observation->sensedData.empty()) {  // one noise for all: MRPT has no other
            filter_->options.std_sensor_range = static_cast<float>(std::sqrt(detection.covariance(0, 0)));
            filter_->options.std_sensor_yaw = static_cast<float>(std::sqrt(detection.covariance(1, 1)));
        }
        mrpt::obs::CObservationBearingRange::TMeasurement measurement;
        measurement.range = static_cast<float>(detection.range);
        measurement.yaw = static_cast<float>(detection.bearing);
        measurement.pitch = 0;

        const auto [entry, is_new] = seen_.try_emplace(detection.source);
        Seen& landmark = entry->second;
        if (is_new) landmark = {{static_cast<std::int64_t>(seen_.size()) - 1}, 0, set.stamp, set.stamp};
        ++landmark.count;
        landmark.last = set.stamp;
        // MRPT's ids have 32 bits, the log's 64.
        measurement.landmarkID = static_cast<std::int32_t>(landmark.id.value);
        observation->sensedData.push_back(measurement);
        innovation.landmark = landmark.id;
        innovation.outcome = is_new ? Outcome::initiated : Outcome::updated;
    }
    if (observation->sensedData.empty()) return;

    // MRPT stays where it is until it has a map; the way until then is taken here.
    if (filter_->isMapEmpty()) takeMovement();
    auto action = actionOf(moved_);
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(observation);
    filter_->processActionObservation(action, frame);
    moved_ = {};
}

void MrptKfSlam::takeMovement() {
    filter_->setRobot(onRobot());
    moved_ = {};
}

std::vector<LandmarkEstimate> MrptKfSlam::onLandmarks() const {
    std::map<unsigned, mrpt::maps::CLandmark::TLandmarkID> ids;
    filter_->getLandmarkIDsFromIndexInStateVector(ids);
    std::vector<LandmarkEstimate> landmarks(seen_.size());
    for (const auto& [source, seen] : seen_)
        landmarks[static_cast<std::size_t>(seen.id.value)] = {
            seen.id, source, Vector2::Zero(), Matrix2::Zero(), seen.count, seen.first, seen.last};
    for (const auto& [index, id] : ids) {
        landmarks[id].mean = filter_->landmarkMean(index);
        landmarks[id].covariance = filter_->landmarkCovariance(index);
    }
    return landmarks;
}

}  // namespace slamot
