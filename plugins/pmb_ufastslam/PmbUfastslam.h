#pragma once
#include <slamot/core/particles/BernoulliMap.h>
#include <slamot/core/particles/ParticleFilter.h>
#include <slamot/core/plugin/ParticleEstimator.h>

namespace slamot {

/// UFastSLAM (paper 4, section 3) with another map: each particle has a Poisson multi-Bernoulli density of landmarks
/// instead of landmarks and decisions about them.
class PmbUfastslam : public ParticleEstimator<ParticleFilter<BernoulliMap>> {
    DEFINE_MRPT_OBJECT(PmbUfastslam, slamot)

  public:
    std::string name() const override { return "pmb_ufastslam"; }

  protected:
    std::vector<ParameterTable> onParameters() override;
    void onStart(const Start& start) override;

  private:
    ParticleParameters particles_{10, PoseProposal::refined, GaussianTransform::unscented};
    BernoulliMapParameters landmarks_;
};

}  // namespace slamot
