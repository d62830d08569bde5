#include <mrpt/obs/CObservationRobotPose.h>

#include <cmath>

#include "slamot/rawlog/Conventions.h"
#include "slamot/run/MrptSinks.h"

namespace slamot::run {
namespace {

/// A planar pose with covariance of [x y theta] as MRPT's 3-D one.
mrpt::obs::CObservationRobotPose poseObservation(Stamp stamp, const std::string& label, const Pose2& pose,
                                                 const Matrix3& covariance) {
    mrpt::obs::CObservationRobotPose out;
    out.timestamp = toMrpt(stamp);
    out.sensorLabel = label;
    out.pose.mean = mrpt::poses::CPose3D(pose.x, pose.y, 0, pose.theta, 0, 0);
    out.pose.cov.setZero();
    const int index[] = {0, 1, 3};  // [x y z yaw pitch roll]
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) out.pose.cov(index[i], index[j]) = covariance(i, j);
    return out;
}

}  // namespace

EstimateLogSink::EstimateLogSink(const std::string& folder) : writer_(folder + "/estimate.rawlog") {}

void EstimateLogSink::step(const Step& step) {
    if (!step.has_detections) return;
    const Stamp now = step.estimate.stamp;
    writer_.write(poseObservation(now, "slamot_robot", step.estimate.robot.mean, step.estimate.robot.covariance));
    for (const TrackEstimate& track : step.estimate.tracks) {
        // The heading shown is that of the velocity; it is no part of the state, so it gets no variance.
        const Vector2 v = track.mean.segment<2>(2);
        const Pose2 pose{track.mean(0), track.mean(1), v.norm() > 0 ? std::atan2(v.y(), v.x()) : 0.0};
        Matrix3 covariance = Matrix3::Zero();
        covariance.topLeftCorner<2, 2>() = track.covariance.topLeftCorner<2, 2>();
        writer_.write(poseObservation(now, "slamot_track_" + std::to_string(track.id.value), pose, covariance));
    }
}

}  // namespace slamot::run
