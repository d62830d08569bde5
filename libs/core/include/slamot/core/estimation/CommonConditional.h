#pragma once
// The commit of a bank of several modes (doc/maths/compressed_engine.md): what is put away, b, keeps one
// conditional distribution given the rest, a, for all modes.
#include <vector>

#include "slamot/core/estimation/BlockGaussian.h"

namespace slamot {

/// Pseudo-inverse of a positive semi-definite matrix; exactly known components count as known.
Eigen::MatrixXd pseudoInverse(const Eigen::Ref<const Eigen::MatrixXd>& P);

/// P_aa^+ P_ab, how b follows a, for a positive semi-definite P_aa.
Eigen::MatrixXd regression(const Eigen::Ref<const Eigen::MatrixXd>& P_aa,
                           const Eigen::Ref<const Eigen::MatrixXd>& P_ab);

/// Several modes seen as one.
struct MatchedModes {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
    Eigen::MatrixXd deviation;  ///< of the modes' means from the common one, by column
};

/// Moment-matches all modes at their merged mean. In the invariant core each mode's covariance is transported
/// there, and stays so.
MatchedModes matchModes(const BlockLayout& layout, const std::vector<BlockGaussian*>& modes,
                        const Eigen::Ref<const Eigen::VectorXd>& weights, Consistency consistency);

/// Moment-matches all modes at their merged mean; then b given a is the merged distribution's in every mode,
/// while a keeps each mode's own mean and covariance. b are the blocks the layout says are put away.
void shareConditional(const BlockLayout& layout, const std::vector<BlockGaussian*>& modes,
                      const Eigen::Ref<const Eigen::VectorXd>& weights, Consistency consistency);

}  // namespace slamot
