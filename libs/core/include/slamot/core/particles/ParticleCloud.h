#pragma once
// The poses of all particles, with weights: what particle filters have in common whatever their maps are.
#include <vector>

#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Estimate.h"
#include "slamot/core/particles/ParticleWeights.h"
#include "slamot/core/particles/PointSight.h"
#include "slamot/core/threads/Workers.h"

namespace slamot {

/// Where a particle's pose is drawn from.
enum class PoseProposal {
    motion,   ///< the motion model alone: FastSLAM 1.0 (paper 2, line 5)
    refined   ///< the motion model and the scan: FastSLAM 2.0; unscented: UFastSLAM (paper 4, section 3)
};

struct ParticleParameters {
    int count = 100;
    PoseProposal proposal = PoseProposal::refined;
    GaussianTransform transform = GaussianTransform::linear;
    Resampling resampling = Resampling::systematic;
    double resample_below = 0.5;  ///< of count: effective number of particles that starts resampling
};

/// Adds `particles`, `resampling` and `resample_below` to the table of a particle filter.
void describe(ParticleParameters& parameters, ParameterTable& table);

class ParticleCloud {
  public:
    ParticleCloud(const ParticleParameters& parameters, const RobotMotionParameters& motion);

    void start(const PoseGaussian& pose, std::uint64_t seed);
    void predict(const OdometryIncrement& odometry, Workers& workers);

    int count() const { return parameters_.count; }
    bool refines() const { return parameters_.proposal == PoseProposal::refined; }
    const PoseBelief& pose(int i) const { return poses_[static_cast<std::size_t>(i)]; }
    void place(int i, const Vector3& pose) { poses_[static_cast<std::size_t>(i)] = {pose, Matrix3::Zero()}; }
    /// Draws of particle `i` for the step that is on.
    RandomStream proposalStream(int i) const;

    const ParticleWeights& weights() const { return weights_; }
    /// False when no particle explains the scan: weights are as they were.
    bool weigh(const std::vector<double>& log_likelihoods);
    /// Parents of the children when it is time to resample, else none. Poses are copied and weights equal then.
    std::vector<int> resample();

    /// First two moments over all particles; headings on the circle.
    PoseGaussian robot() const;
    std::vector<ParticleEstimate> particles() const;

  private:
    ParticleParameters parameters_;
    RobotMotionParameters motion_;
    std::uint64_t seed_ = 1;
    std::uint32_t step_ = 0;  ///< of predictions and scans, in the keys of draws
    std::vector<PoseBelief> poses_;
    ParticleWeights weights_;
};

}  // namespace slamot
