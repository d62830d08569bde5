#pragma once
// One mover's Gaussians in several modes, and what an IMM does with them between predictions.
#include <vector>

#include "slamot/core/data/Pose2.h"

namespace slamot {

/// State as TargetMotion.h has it: [px py vx vy ax ay].
struct TargetGaussian {
    Vector6 mean;
    Matrix6 covariance;
};

/// First two moments of the mixture; the weights sum to 1.
TargetGaussian mixture(const Eigen::Ref<const Eigen::VectorXd>& weights, const std::vector<TargetGaussian>& modes);

/// What each mode starts a prediction from, and how likely it is by then.
struct MixedModes {
    Eigen::VectorXd probabilities;      ///< c_j = sum_i p_ij mu_i
    std::vector<TargetGaussian> modes;  ///< j: the mixture with weights mu_{i|j} = p_ij mu_i / c_j
};

/// The mixing step of an IMM; `p` holds transition probabilities, row i those of a mover in mode i.
MixedModes mixedModes(const Eigen::MatrixXd& p, const Eigen::VectorXd& mu,
                      const std::vector<TargetGaussian>& modes);

}  // namespace slamot
