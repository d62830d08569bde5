#pragma once
// Detections of one batch and the objects of a joint state that may have been seen: which comes from which.
// Landmarks first, then movers given the landmarks found (doc/maths/association.md).
#include <vector>

#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/core/estimation/JointBank.h"

namespace slamot {

enum class LandmarkAssociation { known, nearest, sequential, jcbb, gnn };
enum class MoverAssociation { known, nearest, gnn, jpda };

struct AssociationParameters {
    LandmarkAssociation landmarks = LandmarkAssociation::jcbb;
    MoverAssociation movers = MoverAssociation::gnn;
    double gate_probability = 0.999;
    /// A detection within this gate of an object that is not seen otherwise starts no new one.
    double separation_probability = 1 - 1e-6;
    /// Of a pair with a landmark, against all else that its detection may come from; below it the pair is
    /// left undecided.
    double decide_probability = 0.5;
    int node_budget = 1000;   ///< of joint compatibility branch and bound
    int state_budget = 2000;  ///< of the exact sums of JPDA
};

/// The table `[name]`.
ParameterTable describe(AssociationParameters& parameters, const std::string& name);

/// An object of the joint state that may be seen now.
struct VisibleObject {
    BlockId block;
    ObjectKind kind;               ///< landmark or mover; detections of unknown kind may come from either
    double detection_probability;  ///< while nothing hides it
    double visibility = 1;         ///< part of the time that nothing does
};

struct BatchAssociation {
    struct Pair {
        int object = -1;  ///< number among the visible objects; -1: none
        double nis = 0;
        /// P_D N(nu; 0, S) / c: how much likelier the detection is to come from it than from clutter.
        double likelihood_ratio = 0;
    };
    std::vector<Pair> of_detection;  ///< by number of detection
    /// By number of detection: it was to be associated, no object explains it, and all objects within whose
    /// separation gate it lies are spoken for by pairs of its sensor, decided or not: it may be of something
    /// new. Never where the method of a kind that it may be of is `known`.
    std::vector<bool> may_be_new;
    /// By number of object: one whose pair is undecided; it was neither seen nor missed.
    std::vector<bool> in_doubt;

    /// JPDA: what a mover is to be updated with in place of its detection, weighed over all that its gate
    /// holds, and not to be gated again (KnownObjects::Sight::weighed); by number of detection, as far as
    /// paired.
    std::vector<RangeBearingDetection> merged;
    bool soft = false;  ///< whether `merged` holds them
};

class BatchAssociator {
  public:
    BatchAssociator(const AssociationParameters& parameters, Consistency consistency);

    /// detections: those to associate, ascending; clutter_density: by number of detection, 1/(m rad), new
    /// objects included. The objects' blocks are within reach of `state`, and differ from one another.
    BatchAssociation associate(const JointView& state, const std::vector<VisibleObject>& objects,
                               const RangeBearingSet& seen, const std::vector<int>& detections,
                               const std::vector<double>& clutter_density);

  private:
    AssociationParameters parameters_;
    Consistency consistency_;
    PairGates gates_, separation_;
};

}  // namespace slamot
