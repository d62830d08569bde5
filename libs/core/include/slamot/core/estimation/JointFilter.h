#pragma once
// The joint EKF over robot, movers and landmarks (paper 1, section 2.2): what ekf_slamot is, and what the other
// joint estimators are composed of.
#include <memory>
#include <vector>

#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Detections.h"
#include "slamot/core/data/Estimate.h"
#include "slamot/core/data/Odometry.h"
#include "slamot/core/estimation/JointEngine.h"
#include "slamot/core/estimation/ObjectCatalogue.h"
#include "slamot/core/models/RobotMotion.h"
#include "slamot/core/models/TargetMotion.h"

namespace slamot {

/// What happens to a detection whose innovation lies outside its gate.
enum class OutlierTreatment {
    accept,   ///< nothing: the plain filter
    inflate,  ///< its noise covariance is multiplied by (NIS / gate)^2
    reject    ///< it is not used
};

/// A change of the movers' motion at a known time: a filter that is told the mode. What is not named here stays as
/// the target model has it.
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

    /// Noise that does not depend on the odometry's rate, unless asked for.
    TargetModel target{TargetModelKind::cv, 0.5, 0.1};
    /// "15:ca:1.8" = from 15 s on model ca with noise_std 1.8; several separated by commas.
    std::vector<ModelChange> target_schedule;
    double target_velocity_std = 3.0;      ///< [m/s] at first sight, when nothing is known
    double target_acceleration_std = 2.0;  ///< [m/s^2]
    double target_max_unseen = 5.0;        ///< [s]; a track unseen for longer ends
};

/// Tables of the section `[name]` and its parts `[name.engine]`, `[name.outliers]`, `[name.target]`.
std::vector<ParameterTable> describe(JointFilterParameters& parameters, const std::string& name,
                                     const std::string& about);

class JointFilter {
   public:
    JointFilter(const JointFilterParameters& parameters, const RobotMotionParameters& motion);

    void start(Stamp stamp, const PoseGaussian& pose);
    void predict(const OdometryIncrement& odometry);
    /// One batch: all known objects at once, linearised at the predicted state; then new movers, then new
    /// landmarks are added. Objects are known by the identity the log gives; detections without one are ignored
    /// and counted.
    UpdateReport update(const DetectionSet& detections);

    PoseGaussian robot() const;
    std::vector<TrackEstimate> tracks() const;
    std::vector<LandmarkEstimate> landmarks() const;
    std::vector<LandmarkEstimate> landmarks(const std::vector<LandmarkId>& ids) const;
    std::int64_t landmarkCount() const { return static_cast<std::int64_t>(objects_.landmarks().size()); }
    JointCovariance jointCovariance() const;

    const JointBank& state() const { return *bank_; }

   private:
    const JointView& belief() const { return bank_->mode(0); }
    TargetModel targetModelAt(Stamp stamp) const;
    void endUnseenTracks(Stamp now);
    /// Tells the engine what is about to be measured.
    void attend(const DetectionSet& set);
    /// Finds the detection's object and, where there is one, puts the linearised detection into the batch.
    Innovation match(const DetectionSet& set, int index);
    Outcome addToBatch(const DetectionSet& set, int index, BlockId block, Innovation& innovation);
    void initiate(const DetectionSet& set, Innovation& innovation);
    LandmarkEstimate estimateOf(const LandmarkRecord& landmark) const;

    JointFilterParameters parameters_;
    RobotMotionParameters motion_;
    std::unique_ptr<JointBank> bank_;  ///< of one mode
    ObjectCatalogue objects_;
    Stamp start_;
    std::vector<LinearMeasurement> batch_;  ///< kept for its capacity
    std::vector<BlockId> measured_;         ///< the same
};

}  // namespace slamot
