#pragma once
// How a Gaussian point is seen from a particle's pose, and what a detection says of it.
#include "slamot/core/models/RangeBearing.h"
#include "slamot/core/particles/PoseBelief.h"

namespace slamot {

/// Where a sensor is and which way it looks, in the world.
struct SensorPlace {
    Vector2 position;  ///< [m]
    double heading;    ///< [rad], not wrapped
};
SensorPlace placeOf(const Vector3& pose, const Pose2& sensor);

/// A point of a map given the path of the particle that the map belongs to [m].
struct GaussianPoint {
    Vector2 mean = Vector2::Zero();
    Matrix2 covariance = Matrix2::Zero();
};

/// z = [range bearing] of a point as a sensor is about to see it, without the detection's own noise.
struct PointSight {
    Vector2 z;
    Matrix2 covariance;             ///< of z, from pose and point
    Eigen::Matrix<double, 2, 3> A;  ///< d z / d xi of the pose, x = mean + factor xi: H_robot factor
    Matrix2 cross;                  ///< covariance of point and z
};

/// Pose and point as uncertain as they are.
PointSight sightOf(const GaussianPoint& point, const PoseBelief& pose, const Pose2& sensor,
                   GaussianTransform transform);
/// From a known place: A is zero.
PointSight sightOf(const GaussianPoint& point, const SensorPlace& sensor, GaussianTransform transform);

/// Cheap, meant to err on the side of yes: whether a NIS up to `gate` is possible between what lies `apart`
/// on the plane, with `variance` [m^2] of both. A gate in range and bearing is bent there, so it looks
/// farther than the covariances alone allow.
inline bool mayPair(const Vector2& apart, double variance, double gate) {
    constexpr double bend = 4.0;
    return apart.squaredNorm() <= bend * gate * variance;
}

/// A detection beside what was expected of it, with its noise R.
struct PointInnovation {
    PointInnovation(const PointSight& sight, const Vector2& z, const Matrix2& R);

    /// log N(residual; 0, S), 1/(m rad).
    double logLikelihood() const;

    Vector2 residual;
    Matrix2 S, S_inverse;
    double nis;
};

/// The point given the detection (paper 4, eq. 24 to 28). Symmetric and positive definite.
void update(GaussianPoint& point, const PointSight& sight, const PointInnovation& innovation);

/// A point at first sight from a known place (paper 4, eq. 29 to 31).
GaussianPoint firstSight(const SensorPlace& sensor, const Vector2& z, const Matrix2& R,
                         GaussianTransform transform);

/// A pose belief that takes in one sight after the other, in the coordinates xi of the belief it began with.
class RefinedPose {
  public:
    explicit RefinedPose(const PoseBelief& prior) : prior_(prior), belief_(prior) {}

    const PoseBelief& belief() const { return belief_; }
    /// `sight` as seen from belief(). Joint with the point's own uncertainty, which counts as noise.
    void take(const PointSight& sight, const PointInnovation& innovation);

    struct Draw {
        Vector3 pose;
        double log_ratio;  ///< log of prior over proposal density at the pose
    };
    Draw draw(RandomStream& random) const;

  private:
    PoseBelief prior_, belief_;
    Vector3 shift_ = Vector3::Zero();       ///< xi ~ N(shift, spread spread^t) by now
    Matrix3 spread_ = Matrix3::Identity();  ///< lower triangular
};

}  // namespace slamot
