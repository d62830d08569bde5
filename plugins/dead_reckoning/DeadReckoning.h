#pragma once
#include <slamot/core/models/RobotMotion.h>
#include <slamot/core/plugin/Estimator.h>

namespace slamot {

/// Adds up odometry and its noise; looks at nothing. The baseline every estimator must beat, and a plugin
/// small enough to copy.
class DeadReckoning : public Estimator {
    DEFINE_MRPT_OBJECT(DeadReckoning, slamot)

  public:
    std::string name() const override { return "dead_reckoning"; }
    bool usesDetections() const override { return false; }
    std::string missingInOdometry(const OdometryIncrement& odometry) const override {
        return missingField(motion_, odometry);
    }

  protected:
    std::vector<ParameterTable> onParameters() override;
    void onStart(const Start& start) override;
    void onPredict(const OdometryIncrement& odometry) override;
    UpdateReport onUpdate(const DetectionSet& detections) override;
    PoseGaussian onRobot() const override { return pose_; }

  private:
    RobotMotionParameters motion_;
    double noise_scale_ = 1.0;
    PoseGaussian pose_;
};

}  // namespace slamot
