#pragma once
// The life of movers to which the log gives no identity, and of objects that may be landmarks or movers, in a particle
// filter: as ObjectLife in the joint filter, with landmarks the particles' own business. What is decided here is
// decided once for all particles, on moments over them and on what the robot alone knows. doc/plugins/pf_slamot.md.
#include <map>
#include <vector>

#include "slamot/core/data/Estimate.h"
#include "slamot/core/filter/ObjectWatch.h"
#include "slamot/core/particles/TargetParticles.h"

namespace slamot {

/// A batch with what is known of its movers.
struct MoverBatch {
    const RangeBearingSet& seen;
    Stamp now;
    std::multimap<BlockId, int> sights = {};       ///< by mover: its detections, of a nameless one one of each sensor at most
    std::vector<BlockId> in_doubt = {};            ///< movers whose pairs are undecided
    std::vector<double> likelihood_ratio = {};     ///< by number of detection: P_D N(nu; 0, S) / c of its pair
    std::vector<int> unexplained = {};             ///< detections that nothing explains, ascending
    std::vector<bool> may_be_new = {};             ///< by number of detection
    std::vector<LandmarkVerdict> landmarks = {};   ///< of detections of unknown kind
};

class MoverLife {
  public:
    /// velocity_std, acceleration_std: of a mover at first sight; gate_probability: of detections.
    MoverLife(const ObjectLifeParameters& parameters, Consistency consistency, double velocity_std,
              double acceleration_std, double gate_probability);

    void clear();
    /// Whether there is anything beside the particles.
    bool busy() const { return watch_.busy(); }
    void predict(const RelativeStep& step, const TargetModel& model) { watch_.predict(step, model); }

    /// After the update with `batch`: what its detections, and those that were missing, say of all objects.
    void follow(TargetParticles& particles, ObjectCatalogue& tracks, const MoverBatch& batch,
                std::vector<Innovation>& innovations);
    /// A track without identity has ended: it may come back.
    void lost(const TargetParticles& particles, const TrackRecord& track, Stamp now);

    /// P(moving) of a landmark: 0 but for those of unknown kind.
    double movingProbability(LandmarkId landmark) const;

  private:
    /// A landmark that may start to move.
    struct MixedLandmark {
        BlockId watched_as;
        double moving;
        Stamp last_seen;
    };

    void judge(const TargetParticles& particles, ObjectCatalogue& tracks, const MoverBatch& batch);
    void changeKinds(TargetParticles& particles, ObjectCatalogue& tracks, const MoverBatch& batch);
    std::vector<int> findMoved(TargetParticles& particles, ObjectCatalogue& tracks, const MoverBatch& batch,
                               std::vector<Innovation>& innovations);
    TrackId becomeMover(TargetParticles& particles, ObjectCatalogue& tracks, LandmarkId landmark,
                        const MoverBatch& batch, int detection);
    void becomeLandmark(TargetParticles& particles, ObjectCatalogue& tracks, const TrackRecord& track,
                        const MoverBatch& batch, int detection);
    void admit(TargetParticles& particles, ObjectCatalogue& tracks, const ConfirmedObject& confirmed, Stamp now,
               Innovation& innovation);
    /// A landmark of unknown kind, with what `landmark` says of its life; P(moving) is watched from now on.
    LandmarkId addLandmark(TargetParticles& particles, const std::vector<TentativeSight>& sights,
                           LandmarkFilter landmark, double moving, Stamp now);
    void removeTrack(TargetParticles& particles, ObjectCatalogue& tracks, const TrackRecord& track);

    ObjectLifeParameters parameters_;
    Consistency consistency_;
    double pair_gate_;
    ObjectWatch watch_;
    std::map<LandmarkId, MixedLandmark> mixed_;
    BlockId last_watch_ = robot_block;
};

}  // namespace slamot
