#pragma once
// An object tracked from the robot alone, in the robot's frame and beside the joint state: what has been
// detected but is not known to be an object yet, and what is an object but not known to be still or moving.
// Two motions at most, still and moving, with a Markov chain between them: an IMM of two modes.
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
    double velocity_std = 1.0;        ///< [m/s] of each component, of what begins to move
};

/// A step of the robot, for what is known in its frame: T_before_after and the covariance of its error
/// [x y theta], in the frame before.
struct RelativeStep {
    PoseGaussian move;
    double dt = 0;  ///< [s]
};
RelativeStep relativeStep(const RobotMotionParameters& motion, const OdometryIncrement& odometry);

class RelativeTrack {
  public:
    /// `moving_probability` 0: still, and stays so; 1: moving, and stays so; else what `change` says of it.
    RelativeTrack(const RelativeGaussian& point, double moving_probability, double velocity_std,
                  double acceleration_std);

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

    double movingProbability() const { return moving_probability_; }
    /// As a landmark: the position if it is still. As a mover: position, velocity and acceleration if it
    /// moves. Only what has a probability above 0 may be asked for.
    const RelativeGaussian& asLandmark() const { return still_; }
    const RelativeGaussian& asMover() const { return moving_; }

  private:
    void mix(double dt, const MotionChange& change);

    double moving_probability_;
    RelativeGaussian still_;   ///< 2
    RelativeGaussian moving_;  ///< 6
};

}  // namespace slamot
