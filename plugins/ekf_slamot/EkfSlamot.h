#pragma once
#include <slamot/core/filter/JointFilter.h>
#include <slamot/core/plugin/Estimator.h>

#include <memory>

namespace slamot {

/// Paper 1, section 2.2: one EKF over [robot | targets | landmarks] with one motion model for all movers.
class EkfSlamot : public Estimator {
    DEFINE_MRPT_OBJECT(EkfSlamot, slamot)

  public:
    std::string name() const override { return "ekf_slamot"; }
    std::string missingInOdometry(const OdometryIncrement& odometry) const override {
        return missingField(motion_, odometry);
    }

  protected:
    std::vector<ParameterTable> onParameters() override;
    void onStart(const Start& start) override;
    void onPredict(const OdometryIncrement& odometry) override { filter_->predict(odometry); }
    UpdateReport onUpdate(const DetectionSet& detections) override { return filter_->update(detections); }
    PoseGaussian onRobot() const override { return filter_->robot(); }
    std::vector<TrackEstimate> onTracks() const override { return filter_->tracks(); }
    std::vector<LandmarkEstimate> onLandmarks() const override { return filter_->landmarks(); }
    std::vector<LandmarkEstimate> onLandmarks(const std::vector<LandmarkId>& ids) const override {
        return filter_->landmarks(ids);
    }
    std::int64_t onLandmarkCount() const override { return filter_->landmarkCount(); }
    std::vector<LandmarkEstimate> onTentative() const override { return filter_->tentative(); }
    JointCovariance onJointCovariance() const override { return filter_->jointCovariance(); }

  private:
    RobotMotionParameters motion_;
    JointFilterParameters parameters_;
    std::unique_ptr<JointFilter> filter_;
};

}  // namespace slamot
