#pragma once
// Joint probabilistic data association, JPDA (Fortmann, Bar-Shalom and Scheffe, IEEE Journal of Oceanic
// Engineering 8(3), 1983): the probability of each pair over all ways in which the batch may have come about.
#include <vector>

#include "slamot/core/association/AssociationProblem.h"
#include "slamot/core/association/DetectionModel.h"

namespace slamot {

struct AssociationMarginals {
    std::vector<double> pair;    ///< by candidate: this detection comes from this object
    std::vector<double> none;    ///< by detection: it comes from none of the objects
    std::vector<double> missed;  ///< by object: it was not detected (or its detection fell outside the gate)
    /// Log of the sum over all ways of the product of their pairs' ratios (`logPairRatios`): by how much likelier
    /// the batch is than if nothing had been detected and all of it were clutter. Bethe's approximation in
    /// clusters with loopy belief propagation's marginals.
    double log_sum = 0;
    /// Clusters too entangled for exact sums; these have loopy belief propagation's marginals.
    int approximated = 0;
    /// States of the exact sums, and rounds of belief propagation, over all clusters.
    int states = 0, rounds = 0;
};

/// Exact within clusters whose sums need at most `state_budget` states each; approximate in the others.
AssociationMarginals associationMarginals(const AssociationProblem& problem, const DetectionModel& model,
                                          int state_budget);
/// From the log ratio of each candidate.
AssociationMarginals associationMarginals(const AssociationProblem& problem,
                                          const std::vector<double>& log_ratios, int state_budget);

}  // namespace slamot
