#pragma once
#include <slamot/core/filter/JointFilter.h>
#include <slamot/core/plugin/Estimator.h>

#include <memory>
#include <string>
#include <vector>

namespace slamot {

/// Paper 1: an interacting multiple model filter over [robot | targets | landmarks].
class ImmSlamot : public Estimator {
    DEFINE_MRPT_OBJECT(ImmSlamot, slamot)

  public:
    ImmSlamot();
    std::string name() const override { return "imm_slamot"; }
    std::vector<std::string> modeNames() const override;
    std::string missingInOdometry(const OdometryIncrement& odometry) const override {
        return missingField(motion_, odometry);
    }

  protected:
    std::vector<ParameterTable> onParameters() override;
    void onInitialize(const Config& config) override;
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
