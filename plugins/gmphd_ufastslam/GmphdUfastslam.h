#pragma once
#include <slamot/core/particles/ParticleFilter.h>
#include <slamot/core/particles/PhdMap.h>
#include <slamot/core/plugin/Estimator.h>

#include <memory>

namespace slamot {

/// GM-PHD-UFastSLAM (paper 4): particles whose poses are drawn from an unscented filter of motion and scan,
/// each with a probability hypothesis density in Gaussians for a map. Identities are not used.
class GmphdUfastslam : public Estimator {
    DEFINE_MRPT_OBJECT(GmphdUfastslam, slamot)

  public:
    std::string name() const override { return "gmphd_ufastslam"; }
    std::string missingInOdometry(const OdometryIncrement& odometry) const override {
        return missingField(motion_, odometry);
    }

  protected:
    std::vector<ParameterTable> onParameters() override;
    void onStart(const Start& start) override;
    void onPredict(const OdometryIncrement& odometry) override { filter_->predict(odometry); }
    UpdateReport onUpdate(const DetectionSet& detections) override {
        return filter_->update(withoutIdentities(detections));
    }
    PoseGaussian onRobot() const override { return filter_->robot(); }
    std::vector<LandmarkEstimate> onLandmarks() const override { return filter_->landmarks(); }
    std::vector<LandmarkEstimate> onLandmarks(const std::vector<LandmarkId>& ids) const override {
        return filter_->landmarks(ids);
    }
    std::int64_t onLandmarkCount() const override { return filter_->landmarkCount(); }

  private:
    RobotMotionParameters motion_;
    ParticleParameters particles_{10, PoseProposal::refined, GaussianTransform::unscented};
    PhdMapParameters map_;
    std::unique_ptr<ParticleFilter<PhdMap>> filter_;
};

}  // namespace slamot
