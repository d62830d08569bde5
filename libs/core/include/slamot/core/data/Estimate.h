#pragma once
// What estimators say: plain values that may be kept and shared.
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "slamot/core/data/Detections.h"
#include "slamot/core/data/Identities.h"
#include "slamot/core/data/Pose2.h"
#include "slamot/core/data/Stamp.h"

namespace slamot {

/// A moving thing. State [px py vx vy ax ay] in the world, SI units.
struct TrackEstimate {
    TrackId id;
    SourceId source;
    Vector6 mean = Vector6::Zero();
    Matrix6 covariance = Matrix6::Zero();
    double existence = 1.0;
    /// P(moving): below 1 where the sensor does not tell movers from landmarks.
    double moving = 1.0;
    /// In the order of Estimator::modeNames(); sums to 1; empty for single-mode estimators.
    std::vector<double> mode_probabilities;
};

/// A still thing. Position [x y] in the world [m].
struct LandmarkEstimate {
    LandmarkId id;
    SourceId source;
    Vector2 mean = Vector2::Zero();
    Matrix2 covariance = Matrix2::Zero();
    std::int64_t seen = 0;
    Stamp first_seen, last_seen;
    double existence = 1.0;
    /// P(moving): above 0 where the sensor does not tell landmarks from movers.
    double moving = 0.0;
};

/// One of the samples that a particle filter stands for its belief with.
struct ParticleEstimate {
    double weight = 0;  ///< of all: they sum to 1
    PoseGaussian pose;  ///< without covariance where the particle is a point
};

/// Counters since the start; nothing that was not used goes unmentioned.
struct Health {
    std::int64_t predictions = 0, updates = 0;
    std::int64_t detections_used = 0, detections_inflated = 0, detections_rejected = 0,
                 detections_tentative = 0, detections_ignored = 0;
};

struct Estimate {
    Stamp stamp;
    PoseGaussian robot;
    std::vector<TrackEstimate> tracks;
    std::int64_t landmark_count = 0;
    Health health;
};

/// What became of a detection.
enum class Outcome {
    updated,    ///< used at full weight
    inflated,   ///< used with enlarged noise, since it lay outside the gate
    rejected,   ///< outside the gate, not used
    initiated,  ///< started a landmark or a track
    tentative,  ///< of something that is not known to exist yet: kept beside the estimate
    ignored     ///< nothing the estimator has a use for; counted
};

const char* toText(Outcome outcome);

/// One detection's innovation; rows of innovations.csv. Residual and S are those of the estimator's measurement model
/// at the predicted state (an estimator may correct them to second order), before any inflation; NaN where there was no prediction (initiated, ignored).
struct Innovation {
    int detection = -1;  ///< index in the DetectionSet
    ObjectKind kind = ObjectKind::unknown;
    LandmarkId landmark;
    TrackId track;
    Outcome outcome = Outcome::ignored;
    Vector2 residual = Vector2::Constant(std::numeric_limits<double>::quiet_NaN());
    Matrix2 covariance = Matrix2::Constant(std::numeric_limits<double>::quiet_NaN());
    double nis = std::numeric_limits<double>::quiet_NaN();
};

struct UpdateReport {
    std::vector<Innovation> innovations;
};

/// The whole joint covariance, on request: expensive. Robot first ([x y theta]), then tracks (6 each), then
/// landmarks (2 each), in the order listed.
struct JointCovariance {
    std::vector<TrackId> tracks;
    std::vector<LandmarkId> landmarks;
    Eigen::MatrixXd matrix;
};

}  // namespace slamot
