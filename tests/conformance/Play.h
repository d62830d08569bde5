#pragma once
// A run as a list of calls, so that every law can play the same one to several estimators.
#include <slamot/core/models/RobotMotion.h>
#include <slamot/rawlog/Truth.h>
#include <slamot/sim/Scenario.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "conformance/Subject.h"

namespace slamot::conformance {

struct PlayStep {
    std::optional<OdometryIncrement> odometry;
    std::optional<DetectionSet> detections;
};

struct Play {
    Start start;
    RobotMotionParameters motion;
    std::vector<PlayStep> steps;
    Truth truth;
};

/// Simulates the scenario's only robot. The start is the true one, with no uncertainty.
Play playOf(const sim::Scenario& scenario, std::uint64_t seed);

/// The same run in a world moved by T_new_old. Odometry and detections are the robot's own, so only the start
/// moves.
Play movedBy(const Pose2& T, Play play);

/// Covariance of [x y theta] seen from axes turned by `angle`.
Matrix3 turned(const Matrix3& covariance, double angle);

/// The plugin's own settings with the `[motion]` of the play.
Config configFor(const Options& options, const Play& play);

/// A new estimator, initialized for the play and not yet started.
std::shared_ptr<Estimator> subjectFor(const Options& options, const Play& play);

/// Called after every predict (report null) and every update.
using Watch = std::function<void(const Estimator&, const UpdateReport*)>;

/// Steps [first, last) to an estimator that stands where they begin.
void playSteps(Estimator& estimator, const Play& play, std::size_t first, std::size_t last,
               const Watch& watch = {});
/// Starts and plays all.
void playAll(Estimator& estimator, const Play& play, const Watch& watch = {});

/// The bits of everything the estimator says now, cheap queries only.
std::string bits(const Estimate& estimate);
/// Those of all steps, and of map and joint covariance at the end.
std::string bitsOfRun(Estimator& estimator, const Play& play);

}  // namespace slamot::conformance
