#include "slamot/core/estimation/RangeBearingUpdate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>

#include "slamot/core/models/RangeBearing.h"

namespace slamot {
namespace {

/// Covariance of a pose and of an object's position, 5 x 5.
Eigen::Matrix<double, 5, 5> marginal(const JointView& state, BlockId from, BlockId object) {
    Eigen::Matrix<double, 5, 5> P;
    P.topLeftCorner<3, 3>() = state.covariance(from, from);
    P.bottomLeftCorner<2, 3>() = state.covariance(object, from).topRows<2>();
    P.topRightCorner<3, 2>() = P.bottomLeftCorner<2, 3>().transpose();
    P.bottomRightCorner<2, 2>() = state.covariance(object, object).topLeftCorner<2, 2>();
    return P;
}

}  // namespace

bool rowsLieWithin(double gate, const ExpectedDetection& expected, const RangeBearingDetection& detection) {
    const Vector2 nu = rangeBearingResidual(detection.z(), expected.z);
    const Vector2 variance = expected.covariance.diagonal() + detection.covariance.diagonal();
    return (nu.array().square() <= (1 + 1e-12) * gate * variance.array()).all();
}

ExpectedSight expectedSight(const JointView& state, BlockId block, const Pose2& sensor,
                            Consistency consistency, BlockId from) {
    const Vector3 pose = state.mean(from);
    const RangeBearingPrediction h = predictRangeBearing(pose, state.mean(block).head<2>(), sensor);
    const Eigen::Matrix<double, 5, 5> P = marginal(state, from, block);

    ExpectedSight out;
    out.measurement.add(from, h.H_robot);
    out.measurement.add(block, h.H_point);
    out.measurement.R.setZero();
    out.detection.z = h.z;

    if (consistency == Consistency::invariant) {
        // Uncertainty across the line of sight lengthens the mean range by P_lat / 2d and spreads it by its
        // square.
        Eigen::Matrix<double, 1, 5> lateral;
        lateral << h.across.transpose() * h.D_robot, h.across.transpose();
        const double d = std::max(h.z.x(), range_floor);
        // Beyond P_lat = d^2 the expansion means nothing and would throw the range about; it is held there.
        const double P_lat = std::min((lateral * P * lateral.transpose()).value(), d * d);
        out.detection.z.x() += P_lat / (2.0 * d);
        out.measurement.R(0, 0) = 0.5 * (P_lat / d) * (P_lat / d);
    }

    Eigen::Matrix<double, 2, 5> H;
    H << h.H_robot, h.H_point;
    out.detection.covariance = H * P * H.transpose() + out.measurement.R;
    return out;
}

Linearisation ExpectedSight::with(const RangeBearingDetection& seen) const {
    Linearisation out{measurement, detection.covariance + seen.covariance, 0};
    out.measurement.residual = rangeBearingResidual(seen.z(), detection.z);
    out.measurement.R += seen.covariance;
    const Eigen::LLT<Matrix2> factor(out.S);
    if (factor.info() != Eigen::Success)
        throw std::domain_error("innovation covariance S is not positive definite");
    out.nis = out.measurement.residual.dot(factor.solve(out.measurement.residual));
    return out;
}

}  // namespace slamot
