#pragma once
// Where one particle's robot is: a Gaussian between scans, a point once a scan has been taken in.
#include <array>

#include "slamot/core/data/Odometry.h"
#include "slamot/core/data/Pose2.h"
#include "slamot/core/models/RobotMotion.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot {

/// x = mean + factor xi with xi ~ N(0, I): [x y theta] in [m m rad]. A factor instead of a covariance, since
/// some directions may be known exactly. Heading of the mean wrapped.
struct PoseBelief {
    Vector3 mean = Vector3::Zero();
    Matrix3 factor = Matrix3::Zero();

    Matrix3 covariance() const { return factor * factor.transpose(); }
    bool isPoint() const { return factor.isZero(0); }
};

/// Lower triangular L with L L^t = P, for a P that is positive semi-definite up to rounding: a direction without
/// variance has a zero column.
Matrix3 factorOf(const Matrix3& P);

/// How Gaussians go through what is not linear.
enum class GaussianTransform {
    linear,    ///< by the Jacobian at the mean
    unscented  ///< by sigma points: alpha 0.9, beta 2, kappa 0 (paper 4, section 3)
};

/// Weights of the 2 n + 1 sigma points 0, +-sqrt(n + lambda) e_i of a standard normal variable of n dimensions.
struct SigmaWeights {
    explicit SigmaWeights(int dimensions);
    double reach;         ///< sqrt(n + lambda) = alpha sqrt(n)
    double centre_cov;    ///< of the centre, in covariances
    double other;         ///< of each other point
};

/// The belief after a step. Linear: x' = f(x, u), P' = F P F^t + G Q_u G^t. Unscented: sigma points of pose and
/// control together (paper 4, eq. 5 to 12 with the noise of the control augmented).
PoseBelief predicted(const PoseBelief& belief, const RobotMotionParameters& motion, const MotionControl& control,
                     double dt, GaussianTransform transform);

/// A point after a step with control noise drawn.
Vector3 drawnMove(const Vector3& pose, const RobotMotionParameters& motion, const MotionControl& control,
                  const Matrix3& control_factor, double dt, RandomStream& random);

}  // namespace slamot
