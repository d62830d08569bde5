#pragma once
// An object tracked from the robot alone, in the robot's frame and beside the joint state: what has been
// detected but is not known to be an object yet, and what is an object but not known to be still or moving.
// Two motions at most, still and moving, with a Markov chain between them: an IMM of two modes.
// doc/maths/objects.md.
#include "slamot/core/data/Odometry.h"
#include "slamot/core/estimation/RangeBearingUpdate.h"
#include "slamot/core/estimation/RelativeGaussian.h"
#include "slamot/core/models/RobotMotion.h"
#include "slamot/core/models/TargetMotion.h"

namespace slamot {

/// What is believed of the motion of objects before they are seen, and how they change it.
struct MotionChange {
    double moving_probability = 0.3;  ///< at first sight
    double start_every = 60;          ///< [s] that a still object stays still, on average
    double stop_every = 10;           ///< [s] that a mover keeps moving, on average
    double velocity_std = 1.0;        ///< [m/s] of each component, of what begins to move or may be moving
};

/// A step of the robot, for what is known in its frame: T_before_after and the covariance of its error
/// [x y theta], in the frame before.
struct RelativeStep {
    PoseGaussian move;
    double dt = 0;  ///< [s]
};
RelativeStep relativeStep(const RobotMotionParameters& motion, const OdometryIncrement& odometry);

/// The same object in the robot's frame after the robot moved.
RelativeGaussian afterMove(const RelativeGaussian& object, const PoseGaussian& move);

class RelativeTrack {
  public:
    /// Known to be still, and stays so.
    static RelativeTrack still(const RelativeGaussian& point);
    /// Known to be moving, and stays so; priors of velocity and acceleration as moverAt's.
    static RelativeTrack moving(const RelativeGaussian& point, double velocity_std, double acceleration_std);
    /// Either, as `change` says of it, which may leave no doubt (moving_probability 0 or 1).
    static RelativeTrack unknown(const RelativeGaussian& point, const MotionChange& change);

    /// `model` is of what moves.
    void predict(const RelativeStep& step, const TargetModel& model, const MotionChange& change);

    /// What a sensor is about to see of it: moments over both motions.
    ExpectedDetection expected(const Pose2& sensor) const;
    /// NIS under these moments, and log of the mixture's density.
    struct Match {
        double nis, log_likelihood;
    };
    Match match(const RangeBearingDetection& detection, const Pose2& sensor) const;
    void update(const RangeBearingDetection& detection, const Pose2& sensor);

    /// Of an object that may be still: how far a detection lies from it (NIS) if it moves.
    double nisAsMover(const RangeBearingDetection& detection, const Pose2& sensor) const;
    /// It was missed where it is if it is still, and `detection` is its own if it moves, else of something
    /// that is detected with `density` [1/(m rad)] there.
    void updateAsMover(const RangeBearingDetection& detection, const Pose2& sensor,
                       double detection_probability, double density);

    double movingProbability() const { return moving_probability_; }
    /// As a landmark: the position if it is still. As a mover: position, velocity and acceleration if it
    /// moves. Only what has a probability above 0 may be asked for.
    const RelativeGaussian& asLandmark() const { return still_; }
    const RelativeGaussian& asMover() const { return moving_; }

  private:
    RelativeTrack(double moving_probability, const RelativeGaussian& still, const RelativeGaussian& moving)
        : moving_probability_(moving_probability), still_(still), moving_(moving) {}

    bool mayBeStill() const { return moving_probability_ < 1; }
    bool mayMove() const { return moving_probability_ > 0; }
    void mix(double dt, const MotionChange& change);

    double moving_probability_;  ///< 0 and 1 last; between them it never gets there
    RelativeGaussian still_;     ///< 2; left alone while it cannot be still
    RelativeGaussian moving_;    ///< 6; left alone while it cannot be moving
};

}  // namespace slamot
