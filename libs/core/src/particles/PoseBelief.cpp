#include "slamot/core/particles/PoseBelief.h"

#include <cmath>

namespace slamot {
namespace {

constexpr double sigma_alpha = 0.9, sigma_beta = 2;  // kappa = 0

/// Variances below this part of the largest are rounding.
constexpr double least_variance = 1e-15;

PoseBelief predictedBySigmaPoints(const PoseBelief& belief, const RobotMotionParameters& motion,
                                  const MotionControl& control, double dt) {
    const Matrix3 control_factor = factorOf(control.covariance);
    const SigmaWeights weights(3 + control.size);
    const Vector3 centre = moved(motion, belief.mean, control.mean, dt);

    // Differences to the centre: small, so that headings need no wrapping but in the difference itself.
    Vector3 shift = Vector3::Zero();
    std::array<Vector3, 12> points;
    std::size_t count = 0;
    const auto add = [&](const Vector3& pose, const Vector3& u) {
        Vector3 d = moved(motion, pose, u, dt) - centre;
        d.z() = wrapAngle(d.z());
        shift += weights.other * d;
        points[count++] = d;
    };
    for (const double side : {weights.reach, -weights.reach}) {
        for (int i = 0; i < 3; ++i) add(belief.mean + side * belief.factor.col(i), control.mean);
        for (int i = 0; i < control.size; ++i) add(belief.mean, control.mean + side * control_factor.col(i));
    }
    Matrix3 P = weights.centre_cov * shift * shift.transpose();
    for (std::size_t i = 0; i < count; ++i)
        P += weights.other * (points[i] - shift) * (points[i] - shift).transpose();
    Vector3 mean = centre + shift;
    mean.z() = wrapAngle(mean.z());
    return {mean, factorOf(P)};
}

}  // namespace

Matrix3 factorOf(const Matrix3& P) {
    Matrix3 L = Matrix3::Zero();
    const double least = least_variance * P.diagonal().maxCoeff();
    for (int j = 0; j < 3; ++j) {
        const double pivot = P(j, j) - L.row(j).head(j).squaredNorm();
        if (!(pivot > least)) continue;
        L(j, j) = std::sqrt(pivot);
        for (int i = j + 1; i < 3; ++i)
            L(i, j) = (P(i, j) - L.row(i).head(j).dot(L.row(j).head(j))) / L(j, j);
    }
    return L;
}

SigmaWeights::SigmaWeights(int n)
    : reach(sigma_alpha * std::sqrt(static_cast<double>(n))),
      centre_cov(2 - 1 / (sigma_alpha * sigma_alpha) - sigma_alpha * sigma_alpha + sigma_beta),
      other(0.5 / (reach * reach)) {}

PoseBelief predicted(const PoseBelief& belief, const RobotMotionParameters& motion, const MotionControl& control,
                     double dt, GaussianTransform transform) {
    if (transform == GaussianTransform::unscented)
        return predictedBySigmaPoints(belief, motion, control, dt);
    const MotionPrediction step = predictMotion(motion, belief.mean, control, dt);
    const Matrix3 FL = step.F * belief.factor;
    return {step.pose, factorOf(FL * FL.transpose() + step.Q)};
}

Vector3 drawnMove(const Vector3& pose, const RobotMotionParameters& motion, const MotionControl& control,
                  const Matrix3& control_factor, double dt, RandomStream& random) {
    Vector3 xi = Vector3::Zero();
    for (int i = 0; i < control.size; ++i) xi(i) = random.normal();
    return moved(motion, pose, control.mean + control_factor * xi, dt);
}

}  // namespace slamot
