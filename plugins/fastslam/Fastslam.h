#pragma once
#include <slamot/core/particles/LandmarkFilters.h>
#include <slamot/core/particles/ParticleFilter.h>
#include <slamot/core/plugin/ParticleEstimator.h>

namespace slamot {

/// FastSLAM: particles over the robot's path, each with an EKF for every landmark. Version 1.0 draws poses from the
/// motion model, 2.0 from the motion model and the scan.
class Fastslam : public ParticleEstimator<ParticleFilter<LandmarkFilters>> {
    DEFINE_MRPT_OBJECT(Fastslam, slamot)

  public:
    std::string name() const override { return "fastslam"; }

  protected:
    std::vector<ParameterTable> onParameters() override;
    void onStart(const Start& start) override;

  private:
    ParticleParameters particles_;
    LandmarkFilterParameters landmarks_;
};

}  // namespace slamot
