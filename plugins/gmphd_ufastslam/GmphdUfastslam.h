#pragma once
#include <slamot/core/particles/ParticleFilter.h>
#include <slamot/core/particles/PhdMap.h>
#include <slamot/core/plugin/ParticleEstimator.h>

namespace slamot {

/// GM-PHD-UFastSLAM (paper 4): particles whose poses are drawn from an unscented filter of motion and scan,
/// each with a probability hypothesis density in Gaussians for a map. Identities are not used.
class GmphdUfastslam : public ParticleEstimator<ParticleFilter<PhdMap>> {
    DEFINE_MRPT_OBJECT(GmphdUfastslam, slamot)

  public:
    std::string name() const override { return "gmphd_ufastslam"; }

  protected:
    std::vector<ParameterTable> onParameters() override;
    void onStart(const Start& start) override;
    UpdateReport onUpdate(const DetectionSet& detections) override {
        return ParticleEstimator::onUpdate(withoutIdentities(detections));
    }

  private:
    ParticleParameters particles_{10, PoseProposal::refined, GaussianTransform::unscented};
    PhdMapParameters map_;
};

}  // namespace slamot
