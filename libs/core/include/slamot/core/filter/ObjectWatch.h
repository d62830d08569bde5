#pragma once
// What a filter keeps of objects without identity beside its state, from the robot alone: those not yet
// confirmed, whether those of unknown kind move, and tracks that ended and may come back. The same for a
// joint state (ObjectLife) and for particles (MoverLife). doc/maths/objects.md.
#include <optional>
#include <vector>

#include "slamot/core/data/Estimate.h"
#include "slamot/core/estimation/ModalState.h"
#include "slamot/core/filter/KindWatch.h"
#include "slamot/core/filter/ObjectCatalogue.h"
#include "slamot/core/filter/ObjectLifeParameters.h"
#include "slamot/core/objects/LostTracks.h"
#include "slamot/core/objects/TentativeObjects.h"

namespace slamot {

/// Says in a detection's innovation that it has started a landmark or a track.
void tellStarted(Innovation& innovation, LandmarkId landmark);
void tellStarted(Innovation& innovation, TrackId track);

class ObjectWatch {
  public:
    /// velocity_std, acceleration_std: of a mover at first sight; gate_probability: of detections.
    ObjectWatch(const ObjectLifeParameters& parameters, Consistency consistency, double velocity_std,
                double acceleration_std, double gate_probability);

    void clear();
    bool busy() const { return tentative_.size() > 0 || kinds_.watching() || !lost_.empty(); }
    /// The robot has moved by `step`.
    void predict(const RelativeStep& step, const TargetModel& model);

    // Objects of unknown kind, each by a number of the caller's. A detection is told by its number in `seen`.
    bool moves(double moving) const { return moving >= parameters_.decide_probability; }
    bool stands(double moving) const { return moving <= 1 - parameters_.decide_probability; }
    /// As KindWatch::look.
    double look(BlockId object, double moving, const RangeBearingSet& seen, int detection);
    /// A landmark that starts to move leaves its gate: it was missed, and a detection lies where it would be
    /// by now.
    struct Aside {
        std::size_t object;  ///< its place in `missed`
        int detection;
        double moving;  ///< P(moving) now
    };
    /// Takes in what of `unexplained` lies beside the `missed`, one each at most, the nearest first.
    std::vector<Aside> lookAside(const std::vector<BlockId>& missed, const RangeBearingSet& seen,
                                 const std::vector<int>& unexplained);
    /// Its position begins anew with the detection that showed its kind, since what came before was of
    /// another.
    RelativeGaussian anew(const RangeBearingSet& seen, int detection) const;
    /// The same with the velocity and acceleration that were watched.
    RelativeGaussian asMover(BlockId object, const RangeBearingSet& seen, int detection) const;
    void forget(BlockId object) { kinds_.forget(object); }

    /// As TentativeObjects::update; in the robot's frame.
    std::vector<ConfirmedObject> confirmed(const RangeBearingSet& seen, Stamp now,
                                           const std::vector<int>& unexplained,
                                           const std::vector<bool>& may_start);
    const std::vector<TentativeObject>& tentative() const { return tentative_.objects(); }
    /// A confirmed mover as it joins the state.
    RelativeGaussian firstMover(const TentativeObject& object) const;

    /// A track has ended unseen.
    void lost(const TrackRecord& track, const TargetBelief& last, Stamp now);
    /// The ended track that a new mover continues.
    std::optional<TrackId> continuedBy(const TargetBelief& born) {
        return lost_.continuedBy(born.mean, born.covariance);
    }

  private:
    ObjectLifeParameters parameters_;
    Consistency consistency_;
    double velocity_std_, acceleration_std_;
    double pair_gate_;
    TentativeObjects tentative_;
    KindWatch kinds_;
    LostTracks lost_;
};

}  // namespace slamot
