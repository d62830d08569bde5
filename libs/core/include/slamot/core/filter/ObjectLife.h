#pragma once
// The life of objects to which the log gives no identity: they are confirmed, doubted, merged, found to move
// or to stand still, let go, and known again.
#include "slamot/core/data/Estimate.h"
#include "slamot/core/estimation/GatheredView.h"
#include "slamot/core/filter/ModalBelief.h"
#include "slamot/core/filter/ObjectAssociation.h"
#include "slamot/core/filter/ObjectWatch.h"
#include "slamot/core/filter/PoseMemory.h"
#include "slamot/core/objects/DuplicateWatch.h"

namespace slamot {

class ObjectLife {
  public:
    /// velocity_std, acceleration_std: of a mover at first sight; gate_probability: of detections.
    ObjectLife(const ObjectLifeParameters& parameters, Consistency consistency, double velocity_std,
               double acceleration_std, double gate_probability);

    void clear();
    /// Whether there is anything beside the joint state.
    bool busy() const { return watch_.busy(); }
    /// The robot has moved by `step`.
    void predict(const RelativeStep& step, const TargetModel& model) { watch_.predict(step, model); }

    /// After the update with `batch`: what its detections, and those that were missing, say of all objects.
    void follow(ModalBelief& belief, ObjectCatalogue& objects, const AssociatedBatch& batch, Stamp now,
                std::vector<Innovation>& innovations);

    /// Beside the joint state, in the robot's frame.
    const std::vector<TentativeObject>& tentative() const { return watch_.tentative(); }

    /// A track without identity has ended: it may come back.
    void lost(const ModalState& belief, const TrackRecord& track, Stamp now);

  private:
    /// By block of an object of the joint state: the detection it was updated with.
    using Sights = std::map<BlockId, int>;

    /// What a scan says of existence; gives the landmarks that should have been seen and were not.
    std::vector<BlockId> judge(ModalBelief& belief, ObjectCatalogue& objects, const AssociatedBatch& batch,
                               const Sights& sights, Stamp now);
    /// False where it should have been seen and was not.
    bool look(const GatheredView& view, ObjectLifeRecord& life, BlockId block, ObjectKind kind,
              const AssociatedBatch& batch, const Sights& sights, Stamp now) const;
    /// Landmarks that may be one.
    void compare(const GatheredView& view, ObjectCatalogue& objects, const AssociatedBatch& batch,
                 const Sights& sights);
    void merge(ModalBelief& belief, ObjectCatalogue& objects);
    /// Landmarks that move, and movers that stand still.
    void changeKinds(ModalBelief& belief, ObjectCatalogue& objects, const AssociatedBatch& batch,
                     const Sights& sights, Stamp now);
    TrackId becomeMover(ModalBelief& belief, ObjectCatalogue& objects, const LandmarkRecord& landmark,
                        const AssociatedBatch& batch, int detection, Stamp now);
    void becomeLandmark(ModalBelief& belief, ObjectCatalogue& objects, const TrackRecord& track,
                        const AssociatedBatch& batch, int detection, Stamp now);
    /// A landmark that starts to move leaves its gate: what was detected where it would be then. Gives the
    /// detections that are still unexplained.
    std::vector<int> findMoved(ModalBelief& belief, ObjectCatalogue& objects, const AssociatedBatch& batch,
                               const std::vector<BlockId>& missed, Stamp now,
                               std::vector<Innovation>& innovations);
    void removeLost(ModalBelief& belief, ObjectCatalogue& objects, const AssociatedBatch& batch, Stamp now);
    void removeLandmark(ModalBelief& belief, ObjectCatalogue& objects, const LandmarkRecord& landmark);
    void removeTrack(ModalBelief& belief, ObjectCatalogue& objects, const TrackRecord& track);
    void admit(ModalBelief& belief, ObjectCatalogue& objects, const ConfirmedObject& confirmed, Stamp now,
               Innovation& innovation);

    /// What the joint state can still take in of an object's sights.
    std::vector<PastSight> pastSights(const TentativeObject& object, Stamp now) const;

    ObjectLifeParameters parameters_;
    Consistency consistency_;
    double pair_gate_;
    ObjectWatch watch_;
    PoseMemory poses_;
    DuplicateWatch duplicates_;
    Stamp last_scan_;  ///< anything before the first
};

}  // namespace slamot
