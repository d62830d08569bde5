#pragma once
#include <slamot/core/particles/BernoulliMap.h>
#include <slamot/core/particles/ParticleFilter.h>
#include <slamot/core/plugin/Estimator.h>

#include <memory>

namespace slamot {

/// UFastSLAM (paper 4, section 3) with another map: each particle has a Poisson multi-Bernoulli density of landmarks
/// instead of landmarks and decisions about them.
class PmbUfastslam : public Estimator {
    DEFINE_MRPT_OBJECT(PmbUfastslam, slamot)

  public:
    std::string name() const override { return "pmb_ufastslam"; }
    std::string missingInOdometry(const OdometryIncrement& odometry) const override {
        return missingField(motion_, odometry);
    }

  protected:
    std::vector<ParameterTable> onParameters() override;
    void onStart(const Start& start) override;
    void onPredict(const OdometryIncrement& odometry) override { filter_->predict(odometry); }
    UpdateReport onUpdate(const DetectionSet& detections) override { return filter_->update(detections); }
    PoseGaussian onRobot() const override { return filter_->robot(); }
    std::vector<LandmarkEstimate> onLandmarks() const override { return filter_->landmarks(); }
    std::vector<LandmarkEstimate> onLandmarks(const std::vector<LandmarkId>& ids) const override {
        return filter_->landmarks(ids);
    }
    std::int64_t onLandmarkCount() const override { return filter_->landmarkCount(); }

  private:
    RobotMotionParameters motion_;
    ParticleParameters particles_{10, PoseProposal::refined, GaussianTransform::unscented};
    BernoulliMapParameters landmarks_;
    std::unique_ptr<ParticleFilter<BernoulliMap>> filter_;
};

}  // namespace slamot
