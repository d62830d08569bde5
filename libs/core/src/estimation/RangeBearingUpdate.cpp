#include "slamot/core/estimation/RangeBearingUpdate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>

#include "slamot/core/models/RangeBearing.h"

namespace slamot {
namespace {

/// Covariance of robot pose and object position, 5 x 5.
Eigen::Matrix<double, 5, 5> marginal(const JointView& state, BlockId object) {
    Eigen::Matrix<double, 5, 5> P;
    P.topLeftCorner<3, 3>() = state.covariance(robot_block, robot_block);
    P.bottomLeftCorner<2, 3>() = state.covariance(object, robot_block).topRows<2>();
    P.topRightCorner<3, 2>() = P.bottomLeftCorner<2, 3>().transpose();
    P.bottomRightCorner<2, 2>() = state.covariance(object, object).topLeftCorner<2, 2>();
    return P;
}

}  // namespace

Linearisation linearise(const JointView& state, BlockId block, const RangeBearingDetection& detection,
                        const Pose2& sensor, Consistency consistency) {
    const Vector3 robot = state.mean(robot_block);
    const RangeBearingPrediction h = predictRangeBearing(robot, state.mean(block).head<2>(), sensor);
    const Eigen::Matrix<double, 5, 5> P = marginal(state, block);

    Linearisation out;
    LinearMeasurement& m = out.measurement;
    m.add(robot_block, h.H_robot);
    m.add(block, h.H_point);
    m.residual = rangeBearingResidual(detection.z(), h.z);
    m.R = detection.covariance;

    if (consistency == Consistency::invariant) {
        // Uncertainty across the line of sight lengthens the mean range by P_lat / 2d and spreads it by its
        // square.
        Eigen::Matrix<double, 1, 5> lateral;
        lateral << h.across.transpose() * h.D_robot, h.across.transpose();
        const double d = std::max(h.z.x(), range_floor);
        // Beyond P_lat = d^2 the expansion means nothing and would throw the range about; it is held there.
        const double P_lat = std::min((lateral * P * lateral.transpose()).value(), d * d);
        m.residual.x() -= P_lat / (2.0 * d);
        m.R(0, 0) += 0.5 * (P_lat / d) * (P_lat / d);
    }

    Eigen::Matrix<double, 2, 5> H;
    H << h.H_robot, h.H_point;
    out.S = H * P * H.transpose() + m.R;
    const Eigen::LLT<Matrix2> factor(out.S);
    if (factor.info() != Eigen::Success)
        throw std::domain_error("innovation covariance S is not positive definite");
    out.nis = m.residual.dot(factor.solve(m.residual));
    return out;
}

FirstSight firstSight(const JointView& state, const RangeBearingDetection& detection, const Pose2& sensor,
                      Consistency consistency) {
    Vector2 z = detection.z();
    Matrix2 R = detection.covariance;
    if (consistency == Consistency::invariant) {
        // A noisy bearing bends the cloud of possible positions into a banana: its mean lies nearer, and it
        // is thicker.
        const double bearing_variance = R(1, 1);
        R(0, 0) += 0.5 * (z.x() * bearing_variance) * (z.x() * bearing_variance);
        z.x() *= 1.0 - 0.5 * bearing_variance;
    }
    const RangeBearingInverse inverse = invertRangeBearing(state.mean(robot_block), z, sensor);
    return {inverse.point, inverse.G_robot, inverse.G_z * R * inverse.G_z.transpose()};
}

}  // namespace slamot
