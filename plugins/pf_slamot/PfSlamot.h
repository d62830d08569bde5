#pragma once
#include <slamot/core/particles/TargetParticleFilter.h>
#include <slamot/core/plugin/Estimator.h>

#include <memory>
#include <string>
#include <vector>

namespace slamot {

/// Paper 2: particles over the robot's path, each with a filter for every landmark and for every mover.
class PfSlamot : public Estimator {
    DEFINE_MRPT_OBJECT(PfSlamot, slamot)

  public:
    std::string name() const override { return "pf_slamot"; }
    std::vector<std::string> modeNames() const override { return slamot::modeNames(parameters_); }
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

  private:
    RobotMotionParameters motion_;
    TargetParticleParameters parameters_;
    std::unique_ptr<TargetParticleFilter> filter_;
};

}  // namespace slamot
