#pragma once
// Which pairs that a method made with landmarks are likely enough to be acted on (doc/maths/association.md,
// "What is left undecided").
#include <vector>

#include "slamot/core/association/DetectionModel.h"
#include "slamot/core/association/JointInnovations.h"
#include "slamot/core/data/Pose2.h"

namespace slamot {

struct DecisionModel {
    const DetectionModel& detection;
    const std::vector<Matrix2>& noise;       ///< by detection: R
    const std::vector<bool>& may_be_rivals;  ///< by object
};

/// Given the pairs that count, a pair counts too when it is likelier than `probability`, against all else
/// that its detection may come from:
///  - something false or never seen before, in a gate as wide as the pair's: with c the clutter density,
///    P_D N(nu; 0, S) / c to sqrt(|S| / |R|), the number of places in the gate that the sensor can tell
///    apart;
///  - a rival that stands elsewhere: an object whose expected detection the sensor can tell apart from the
///    pair's. Which of several at one place it was makes no difference to the robot.
/// Pairs are taken in the order given until none is added; the others are judged together, against clutter
/// and against all that their detections come to once one of them is of a rival, and count together or not at
/// all.
std::vector<int> decidedPairs(const AssociationProblem& problem, JointInnovations& innovations,
                              const std::vector<int>& pairs, const DecisionModel& model, double probability);

}  // namespace slamot
