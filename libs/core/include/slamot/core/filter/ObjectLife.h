#pragma once
// The life of objects to which the log gives no identity: they are confirmed, doubted, merged, found to move
// or to stand still, let go, and known again.
#include "slamot/core/data/Estimate.h"
#include "slamot/core/estimation/GatheredView.h"
#include "slamot/core/filter/KindWatch.h"
#include "slamot/core/filter/ModalBelief.h"
#include "slamot/core/filter/ObjectAssociation.h"
#include "slamot/core/filter/PoseMemory.h"
#include "slamot/core/objects/DuplicateWatch.h"
#include "slamot/core/objects/LostTracks.h"
#include "slamot/core/objects/TentativeObjects.h"

namespace slamot {

enum class TrackBirth {
    one_point,  ///< nothing is known of a new mover's velocity
    two_point   ///< it has the velocity that its first detections show
};

struct ObjectLifeParameters {
    LifeParameters landmarks, movers;
    double merge_probability = 0.99;  ///< of two landmarks being one, at which they are merged

    TrackBirth birth = TrackBirth::two_point;
    double reidentify_within = 10;         ///< [s] after a track was lost
    double reidentify_probability = 0.99;  ///< gate of the lost track's prediction

    MotionChange change;
    double decide_probability = 0.9;  ///< P(moving) beyond which an object of unknown kind is a mover
};

/// Adds to the tables of landmarks and of movers.
void describeLandmarks(ObjectLifeParameters& parameters, ParameterTable& landmarks);
void describeMovers(ObjectLifeParameters& parameters, ParameterTable& movers);
/// The table `[name.mixed]`.
ParameterTable describeMixed(ObjectLifeParameters& parameters, const std::string& name);

class ObjectLife {
  public:
    /// velocity_std, acceleration_std: of a mover at first sight; gate_probability: of detections.
    ObjectLife(const ObjectLifeParameters& parameters, Consistency consistency, double velocity_std,
               double acceleration_std, double gate_probability);

    void clear();
    /// Whether there is anything beside the joint state.
    bool busy() const { return tentative_.size() > 0 || kinds_.watching() || !lost_.empty(); }
    /// The robot has moved by `step`.
    void predict(const RelativeStep& step, const TargetModel& model);

    /// After the update with `batch`: what its detections, and those that were missing, say of all objects.
    void follow(ModalBelief& belief, ObjectCatalogue& objects, const AssociatedBatch& batch, Stamp now,
                std::vector<Innovation>& innovations);

    /// Beside the joint state, in the robot's frame.
    const std::vector<TentativeObject>& tentative() const { return tentative_.objects(); }

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
                        const RangeBearingDetection& detection, const Pose2& sensor, Stamp now);
    void becomeLandmark(ModalBelief& belief, ObjectCatalogue& objects, const TrackRecord& track,
                        const RangeBearingDetection& detection, const Pose2& sensor, Stamp now);
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
    double velocity_std_, acceleration_std_;
    double pair_gate_;
    TentativeObjects tentative_;
    PoseMemory poses_;
    KindWatch kinds_;
    DuplicateWatch duplicates_;
    LostTracks lost_;
    Stamp last_scan_;  ///< anything before the first
};

}  // namespace slamot
