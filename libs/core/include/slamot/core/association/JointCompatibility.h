#pragma once
// Joint compatibility branch and bound, JCBB: Neira and Tardos, IEEE Transactions on Robotics and Automation
// 17(6), 2001.
#include "slamot/core/association/AssociationProblem.h"
#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/association/JointInnovations.h"

namespace slamot {

struct JointCompatibility {
    Pairing pairing;
    double nis = 0;  ///< joint NIS of all pairs, two degrees of freedom each
    /// Extensions of a hypothesis that were tried; each costs the square of its pairs.
    int nodes = 0;
    /// The search was ended by the node budget: the pairing is the best that was met, at least as good as
    /// the sequential one, and there may be a better one.
    bool exhausted = false;
    /// The sequential pairing was not improved on.
    bool is_sequential = true;
};

/// The jointly compatible pairing with the most pairs, and of those the one with the smallest joint NIS.
/// Detections are decided in the order of AssociationProblem::unambiguousFirst, and a pairing counts as
/// compatible when it is so after each decision, as in the paper. The search starts from the sequential
/// pairing and tries at most `node_budget` extensions.
JointCompatibility jointCompatibility(const AssociationProblem& problem, JointInnovations& innovations,
                                      PairGates& gates, int node_budget);

}  // namespace slamot
