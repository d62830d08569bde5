#pragma once
// Individual compatibility nearest neighbour: every pair is judged alone.
#include "slamot/core/association/AssociationProblem.h"

namespace slamot {

/// The likeliest candidate of all becomes a pair; then the likeliest of those whose detection and object are
/// both free, until none is left. So an object wanted by two detections goes to the one it explains better,
/// and the other takes its next best or stays alone. Ties go to the smaller NIS, then to the earlier
/// candidate.
Pairing nearestNeighbour(const AssociationProblem& problem);

}  // namespace slamot
