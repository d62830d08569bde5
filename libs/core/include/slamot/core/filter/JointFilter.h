#pragma once
// The joint filter over robot, movers and landmarks (paper 1, section 2): the EKF of ekf_slamot, the IMM of
// imm_slamot, and what the other joint estimators are composed of. A step is put together here: which
// detection is of which object is ObjectAssociation's, what becomes of objects without identity is
// ObjectLife's, how movers' modes are kept is ModalState's, how means and covariances are kept is
// JointBank's.
#include <memory>
#include <vector>

#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Detections.h"
#include "slamot/core/data/Estimate.h"
#include "slamot/core/data/Odometry.h"
#include "slamot/core/estimation/JointEngine.h"
#include "slamot/core/filter/ModalBelief.h"
#include "slamot/core/filter/ObjectAssociation.h"
#include "slamot/core/filter/ObjectCatalogue.h"
#include "slamot/core/filter/ObjectLife.h"
#include "slamot/core/filter/SensorLimits.h"

namespace slamot {

/// A change of the movers' motion at a known time: a filter that is told the mode. What is not named here
/// stays as the target model has it.
struct ModelChange {
    double after = 0;  ///< [s] since the start; holds for predictions that begin at or after it
    TargetModelKind kind = TargetModelKind::cv;
    double noise_std = 0.5;  ///< as TargetModel's
};

struct JointFilterParameters {
    Consistency consistency = Consistency::invariant;
    JointEngine engine;

    OutlierTreatment outliers = OutlierTreatment::inflate;
    double gate_probability = 0.999;

    AssociationParameters association;
    ObjectLifeParameters life;

    /// Noise that does not depend on the odometry's rate, unless asked for.
    TargetModel target{TargetModelKind::cv, 0.5, 0.1};
    /// "15:ca:1.8" = from 15 s on model ca with noise_std 1.8; several separated by commas.
    std::vector<ModelChange> target_schedule;
    double target_velocity_std = 3.0;      ///< [m/s] at first sight, when nothing is known
    double target_acceleration_std = 2.0;  ///< [m/s^2]
    double target_max_unseen = 5.0;        ///< [s]; a track unseen for longer ends
    /// [m]; a mover that is seen is never surer of its position than this: its motion is never so well known,
    /// and an over-confident track is lost.
    double target_position_floor = 0.01;

    /// Where it names modes, movers have these; `target` and its schedule mean nothing then.
    ImmParameters imm;
};

/// Tables of the section `[name]` and its parts.
std::vector<ParameterTable> describe(JointFilterParameters& parameters, const std::string& name,
                                     const std::string& about);
/// The same for a filter of several modes, with `[name.modes]`.
std::vector<ParameterTable> describeImm(JointFilterParameters& parameters, const std::string& name,
                                        const std::string& about);

/// What of it does not change during a run.
std::shared_ptr<const ModalSettings> settingsFrom(const JointFilterParameters& parameters,
                                                  const RobotMotionParameters& motion);

class JointFilter {
  public:
    /// Throws std::invalid_argument with one sentence when `parameters.imm` does not fit together.
    JointFilter(const JointFilterParameters& parameters, const RobotMotionParameters& motion);

    void start(Stamp stamp, const PoseGaussian& pose);
    void predict(const OdometryIncrement& odometry);
    /// One batch: all known objects at once, linearised at the predicted state; then new movers, then new
    /// landmarks are added. Objects are known by the identity the log gives, else by association; what has no
    /// identity joins the state when its existence is confirmed.
    UpdateReport update(const DetectionSet& detections);

    PoseGaussian robot() const;
    std::vector<TrackEstimate> tracks() const;
    std::vector<LandmarkEstimate> landmarks() const;
    std::vector<LandmarkEstimate> landmarks(const std::vector<LandmarkId>& ids) const;
    std::int64_t landmarkCount() const { return static_cast<std::int64_t>(objects_.landmarks().size()); }
    /// Landmarks that are not in the state yet, and what may be one; without ids.
    std::vector<LandmarkEstimate> tentative() const;
    JointCovariance jointCovariance() const;
    /// Empty for a filter of one target model.
    std::vector<std::string> modeNames() const;

    const JointBank& state() const { return belief_->bank(); }

  private:
    void setModels(Stamp stamp);
    void endUnseenTracks(Stamp now);
    UpdateReport updateByIdentity(const RangeBearingSet& seen, Stamp now);
    UpdateReport updateByAssociation(const RangeBearingSet& seen, Stamp now);
    void update(const RangeBearingSet& used, const KnownObjects& known, std::vector<Innovation>& innovations,
                Stamp now);
    void markSeen(const Innovation& innovation, Stamp now);
    void holdFloor(BlockId target);
    /// P: what is believed of its position.
    void holdFloor(BlockId target, const Matrix2& P);
    /// Objects whose identity is new: movers, then landmarks.
    void startNamed(const RangeBearingSet& seen, Stamp now, std::vector<Innovation>& innovations);
    void start(const RangeBearingSet& seen, Stamp now, Innovation& innovation);
    LandmarkEstimate estimateOf(const LandmarkRecord& landmark) const;

    JointFilterParameters parameters_;
    RobotMotionParameters motion_;
    ModalBelief belief_;
    ObjectCatalogue objects_;
    SensorLimits limits_;
    ObjectAssociation association_;
    ObjectLife life_;
    Stamp start_;
    std::vector<TargetModel> models_;  ///< of the modes, now
    KnownObjects known_;               ///< kept for its capacity
    std::vector<BlockId> measured_;
};

}  // namespace slamot
