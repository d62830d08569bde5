#pragma once
// The interface every estimator plugin implements.
#include <mrpt/rtti/CObject.h>
#include <mrpt/system/COutputLogger.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "slamot/core/config/Config.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Detections.h"
#include "slamot/core/data/Estimate.h"
#include "slamot/core/data/Odometry.h"

namespace slamot {

/// An estimator was asked for something impossible, or has come to an impossible state. One sentence with
/// estimator, time and matrix or value.
class EstimatorError : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
};

/// predict or update was called with a time before the estimator's own.
class TimeOrderError : public EstimatorError {
   public:
    using EstimatorError::EstimatorError;
};

/// All an estimator knows before its first step.
struct Start {
    Stamp stamp;
    PoseGaussian pose;
    /// Key of all its random draws.
    std::uint64_t seed = 1;
    /// Threads it may use, between calls as well. Results must not depend on it.
    int threads = 1;
};

/// Estimates robot, still landmarks and movers from odometry and detections, forward in time.
///
/// The public calls are not virtual: they check once for all plugins what none may forget (order in time, finite
/// numbers, definite covariances) and then call the protected `on...` functions, which is what a plugin writes.
/// One thread calls an estimator at a time.
class Estimator : public mrpt::rtti::CObject, public mrpt::system::COutputLogger {
    DEFINE_VIRTUAL_MRPT_OBJECT(Estimator)

   public:
    ~Estimator() override;
    /// Not copyable: MRPT's clone() says so too.
    Estimator(const Estimator&) = delete;
    Estimator& operator=(const Estimator&) = delete;

    /// The plugin's name: its section in configs, its folder, its config file.
    virtual std::string name() const = 0;

    /// Every parameter with its present value, tied to this object's fields.
    std::vector<ParameterTable> parameterTables();
    /// Reads the plugin's sections and `[motion]`-like shared ones it uses. Throws ConfigError.
    void initialize(const Config& config);
    /// Forgets everything and begins at `start`. Must follow initialize.
    void start(const Start& start);
    /// Begins again at the last `start`: equal to a fresh object.
    void reset() {
        requireStarted("reset");
        start(start_);
    }

    /// Moves time from t0 (the present time) to t1.
    void predict(const OdometryIncrement& odometry);
    /// Takes in the detections made at the present time. An empty set is legal.
    UpdateReport update(const DetectionSet& detections);

    Stamp time() const { return now_; }
    /// Cheap: robot, tracks, health.
    Estimate estimate() const;
    PoseGaussian robot() const { return onRobot(); }
    std::vector<TrackEstimate> tracks() const { return onTracks(); }
    /// Expensive with a large map.
    std::vector<LandmarkEstimate> landmarks() const { return onLandmarks(); }
    /// Some landmarks only, in the order asked for; unknown ids are left out.
    std::vector<LandmarkEstimate> landmarks(const std::vector<LandmarkId>& ids) const { return onLandmarks(ids); }
    /// What may turn out to be a landmark, with its existence; not among landmarks(). An id that is valid stays when it
    /// does. None from estimators that decide at once or keep no list.
    std::vector<LandmarkEstimate> tentative() const { return onTentative(); }
    /// None from estimators that have none. Weights sum to 1 (EstimatorError where they do not), and the first two
    /// moments of all particles together are robot().
    std::vector<ParticleEstimate> particles() const;
    /// Most expensive; an empty matrix from estimators that keep none.
    JointCovariance jointCovariance() const { return onJointCovariance(); }
    /// Names behind TrackEstimate::mode_probabilities.
    virtual std::vector<std::string> modeNames() const { return {}; }
    /// Whether a log without detections makes sense to it.
    virtual bool usesDetections() const { return true; }
    /// Names the field of the odometry that this estimator's motion model reads and `odometry` lacks, else empty.
    virtual std::string missingInOdometry(const OdometryIncrement& odometry) const;

    /// Smallest eigenvalue of a covariance, relative to the largest, that still counts as rounding.
    static constexpr double definiteness_tolerance = 1e-9;

   protected:
    Estimator();

    virtual std::vector<ParameterTable> onParameters() = 0;
    /// Parameters have been read: check what they say together, open what they name (relative paths refer to
    /// config.folder()). May throw ConfigError.
    virtual void onInitialize(const Config& /*config*/) {}
    virtual void onStart(const Start& start) = 0;
    virtual void onPredict(const OdometryIncrement& odometry) = 0;
    virtual UpdateReport onUpdate(const DetectionSet& detections) = 0;
    virtual PoseGaussian onRobot() const = 0;
    virtual std::vector<TrackEstimate> onTracks() const { return {}; }
    virtual std::vector<LandmarkEstimate> onLandmarks() const { return {}; }
    virtual std::vector<LandmarkEstimate> onLandmarks(const std::vector<LandmarkId>& ids) const;
    virtual std::int64_t onLandmarkCount() const { return static_cast<std::int64_t>(onLandmarks().size()); }
    virtual std::vector<LandmarkEstimate> onTentative() const { return {}; }
    virtual std::vector<ParticleEstimate> onParticles() const { return {}; }
    virtual JointCovariance onJointCovariance() const { return {}; }

   private:
    void requireStarted(const char* what) const;
    void checkReport(const UpdateReport& report, std::size_t detections) const;
    void checkRobot(const char* after) const;
    void checkParticles(const std::vector<ParticleEstimate>& particles) const;
    /// Tracks named in the report, and in debug and sanitizer builds the whole joint covariance.
    void checkTouched(const UpdateReport& report) const;

    Start start_;
    Stamp now_;
    bool initialized_ = false, started_ = false;
    Health health_;
};

}  // namespace slamot
