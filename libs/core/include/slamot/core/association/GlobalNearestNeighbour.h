#pragma once
// Global nearest neighbour: the single most likely way in which a batch came about.
#include "slamot/core/association/AssociationProblem.h"
#include "slamot/core/association/DetectionModel.h"

namespace slamot {

/// The pairing of the greatest total logPairRatios: a pair is made only if it is likelier than clutter and a
/// miss. By optimal assignment within each cluster. Pairs are independent here: their common robot is not
/// accounted for.
Pairing globalNearestNeighbour(const AssociationProblem& problem, const DetectionModel& model);

}  // namespace slamot
