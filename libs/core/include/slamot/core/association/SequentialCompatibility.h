#pragma once
// Sequential compatibility nearest neighbour: pairs are made one after the other, each judged in the light of
// those before it.
#include "slamot/core/association/AssociationProblem.h"
#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/association/JointInnovations.h"

namespace slamot {

/// Takes detections in the order of AssociationProblem::unambiguousFirst; each gets the free object whose
/// innovation is the likeliest given the innovations of all pairs made so far, as if these had updated the
/// filter, among those that leave the set of pairs jointly compatible (its NIS within `gates`). No choice is
/// ever taken back.
Pairing sequentialCompatibility(const AssociationProblem& problem, JointInnovations& innovations,
                                PairGates& gates);

}  // namespace slamot
