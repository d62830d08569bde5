#include "slamot/core/estimation/RelativeGaussian.h"

#include "slamot/core/models/RangeBearing.h"

namespace slamot {

RelativeGaussian firstSight(const RangeBearingDetection& detection, const Pose2& sensor,
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
    const RangeBearingInverse inverse = invertRangeBearing(Vector3::Zero(), z, sensor);
    return {inverse.point, inverse.G_z * R * inverse.G_z.transpose()};
}

RelativeGaussian moverAt(const RelativeGaussian& point, double velocity_std, double acceleration_std) {
    Vector6 mean = Vector6::Zero();
    mean.head<2>() = point.position();
    Matrix6 P = Matrix6::Zero();
    P.topLeftCorner<2, 2>() = point.covariance;
    P.diagonal().segment<2>(2).setConstant(velocity_std * velocity_std);
    P.diagonal().segment<2>(4).setConstant(acceleration_std * acceleration_std);
    return {mean, P};
}

NewBlock inWorld(const RelativeGaussian& object, const Vector3& pose) {
    const Matrix2 turn = rotation(pose.z());
    const Eigen::Index n = object.mean.size();
    NewBlock out{object.mean, BlockMatrix::Zero(n, 3), object.covariance};
    for (Eigen::Index k = 0; k < n; k += 2) {
        out.mean.segment<2>(k) = turn * object.mean.segment<2>(k);
        out.G.block<2, 1>(k, 2) = quarterTurn() * out.mean.segment<2>(k);
        for (Eigen::Index j = 0; j < n; j += 2)
            out.own.block<2, 2>(k, j) = turn * object.covariance.block<2, 2>(k, j) * turn.transpose();
    }
    out.mean.head<2>() += pose.head<2>();
    out.G.topLeftCorner<2, 2>().setIdentity();
    return out;
}

}  // namespace slamot
