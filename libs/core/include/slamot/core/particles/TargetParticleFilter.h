#pragma once
// SLAM with movers by particles (paper 2): a step is put together here, as JointFilter does it for the joint filters.
// doc/plugins/pf_slamot.md.
#include <string>
#include <vector>

#include "slamot/core/association/BatchAssociation.h"
#include "slamot/core/data/Estimate.h"
#include "slamot/core/filter/ObjectCatalogue.h"
#include "slamot/core/filter/SensorLimits.h"
#include "slamot/core/particles/MoverLife.h"
#include "slamot/core/particles/TargetParameters.h"
#include "slamot/core/particles/TargetParticles.h"

namespace slamot {

class TargetParticleFilter {
  public:
    /// Throws std::invalid_argument with one sentence when the modes do not fit together.
    TargetParticleFilter(const TargetParticleParameters& parameters, const RobotMotionParameters& motion, int threads);

    void start(const PoseGaussian& pose, std::uint64_t seed);
    void predict(const OdometryIncrement& odometry);
    /// One batch: landmarks, then movers given the landmarks, then what is new.
    UpdateReport update(const DetectionSet& detections);

    PoseGaussian robot() const { return particles_.particles().robot(); }
    std::vector<ParticleEstimate> particles() const { return particles_.particles().particles(); }
    std::vector<TrackEstimate> tracks() const;
    std::vector<LandmarkEstimate> landmarks() const;
    std::vector<LandmarkEstimate> landmarks(const std::vector<LandmarkId>& ids) const;
    /// Of landmarks alone: what may be a mover is MoverLife's.
    std::vector<LandmarkEstimate> tentative() const;
    std::int64_t landmarkCount() const { return particles_.particles().landmarkCount(); }
    /// Empty for movers of one motion.
    std::vector<std::string> modeNames() const { return slamot::modeNames(parameters_); }

  private:
    /// P(moving) filled in.
    std::vector<LandmarkEstimate> withMotion(std::vector<LandmarkEstimate> landmarks) const;
    bool isAssociated(const RangeBearingDetection& detection) const;
    void endUnseenTracks(Stamp now);
    /// What movers there are make of a batch.
    void updateByMovers(MoverBatch& batch, std::vector<Innovation>& innovations);
    /// By identity; the outcome of those whose identity is new is `initiated`.
    void pairNamed(MoverBatch& batch, std::vector<Innovation>& innovations);
    /// As far as time alone changes it since the last look.
    std::optional<ObjectLifeRecord> lifeNow(const TrackRecord& track, Stamp now) const;
    BatchAssociation pairNameless(const MergedTargets& view, MoverBatch& batch);
    void startNamed(const MoverBatch& batch, std::vector<Innovation>& innovations);

    TargetParticleParameters parameters_;
    RobotMotionParameters motion_;
    Consistency consistency_;
    std::vector<TargetModel> models_;
    TargetParticles particles_;
    ObjectCatalogue tracks_;  ///< has no landmarks
    SensorLimits limits_;
    BatchAssociator associator_;
    MoverLife life_;
};

}  // namespace slamot
