#pragma once
#include <slamot/core/particles/LandmarkFilters.h>
#include <slamot/core/particles/ParticleFilter.h>
#include <slamot/core/plugin/ParticleEstimator.h>

namespace slamot {

/// UFastSLAM (paper 4, section 3): particles whose poses are drawn from an unscented filter of motion and scan, with
/// an unscented filter for each landmark.
class Ufastslam : public ParticleEstimator<ParticleFilter<LandmarkFilters>> {
    DEFINE_MRPT_OBJECT(Ufastslam, slamot)

  public:
    std::string name() const override { return "ufastslam"; }

  protected:
    std::vector<ParameterTable> onParameters() override;
    void onStart(const Start& start) override;

  private:
    ParticleParameters particles_{10, PoseProposal::refined, GaussianTransform::unscented};
    LandmarkFilterParameters landmarks_;
};

}  // namespace slamot
