#pragma once
// From detections and a Gaussian state to an association problem. This header and LinearInnovations.h are
// where association knows estimation; the methods themselves know neither states nor sensors.
#include <functional>
#include <vector>

#include "slamot/core/association/AssociationProblem.h"
#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/estimation/RangeBearingUpdate.h"

namespace slamot {

struct GatedPairs {
    /// Detections numbered as in the batch, objects as in the list they were given in.
    AssociationProblem problem;
    /// By candidate: what LinearInnovations and an update with it take.
    std::vector<LinearMeasurement> measurements;
};

/// Whether a detection (number within the batch) may come from an object (number within the list).
using MayPair = std::function<bool(int detection, int object)>;

/// All pairs of `detections` (numbers within `seen`, ascending) and `objects` (blocks whose position leads
/// them) whose NIS lies within the gate of one pair. Costs a linearisation for each object and sensor, one
/// for each candidate, and a comparison for each pair: hand in the objects that can be seen from here
/// (LandmarkIndex), not the map. `may_pair`: pairs it denies are none; empty: all may be.
GatedPairs gatedPairs(const JointView& state, const std::vector<BlockId>& objects,
                      const RangeBearingSet& seen, const std::vector<int>& detections,
                      Consistency consistency, PairGates& gates, const MayPair& may_pair = {});

}  // namespace slamot
