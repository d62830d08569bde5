#include "DeadReckoning.h"

IMPLEMENTS_MRPT_OBJECT(DeadReckoning, Estimator, slamot)

namespace slamot {

std::vector<ParameterTable> DeadReckoning::onParameters() {
    ParameterTable own("dead_reckoning", "Odometry alone.");
    own.real("noise_scale", noise_scale_, "-", Interval::positive(),
             "Factor on the variance of the odometry's noise.");
    return {describe(motion_), own};
}

void DeadReckoning::onStart(const Start& start) {
    pose_ = start.pose;
}

void DeadReckoning::onPredict(const OdometryIncrement& odometry) {
    const MotionPrediction moved = predictMotion(motion_, pose_.mean.vector(), odometry);
    pose_.mean = Pose2::fromVector(moved.pose);
    pose_.covariance = moved.F * pose_.covariance * moved.F.transpose() + noise_scale_ * moved.Q;
}

UpdateReport DeadReckoning::onUpdate(const DetectionSet& detections) {
    UpdateReport report;
    const auto& seen = detections.rangeBearing().detections;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        Innovation unused;
        unused.detection = static_cast<int>(i);
        unused.kind = seen[i].kind;
        report.innovations.push_back(unused);
    }
    return report;
}

}  // namespace slamot
