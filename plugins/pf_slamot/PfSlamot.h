#pragma once
#include <slamot/core/particles/TargetParticleFilter.h>
#include <slamot/core/plugin/ParticleEstimator.h>

namespace slamot {

/// Paper 2: particles over the robot's path, each with a filter for every landmark and for every mover.
class PfSlamot : public ParticleEstimator<TargetParticleFilter> {
    DEFINE_MRPT_OBJECT(PfSlamot, slamot)

  public:
    std::string name() const override { return "pf_slamot"; }
    std::vector<std::string> modeNames() const override { return slamot::modeNames(parameters_); }

  protected:
    std::vector<ParameterTable> onParameters() override;
    void onInitialize(const Config& config) override;
    void onStart(const Start& start) override;
    std::vector<TrackEstimate> onTracks() const override { return filter().tracks(); }

  private:
    TargetParticleParameters parameters_;
};

}  // namespace slamot
