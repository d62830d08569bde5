#include "slamot/core/particles/PointSight.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

namespace slamot {
namespace {

Matrix2 lowerFactor(const Matrix2& P) {
    const double a = std::sqrt(std::max(P(0, 0), 0.0)), b = a > 0 ? P(1, 0) / a : 0.0;
    return (Matrix2() << a, 0, b, std::sqrt(std::max(P(1, 1) - b * b, 0.0))).finished();
}

/// A sensor in the world: sines and cosines of one pose serve many points.
struct PlacedSensor {
    PlacedSensor(const Vector3& pose, const Pose2& sensor)
        : position(pose.head<2>()), direction(pose.z() + sensor.theta) {
        if (sensor.x != 0 || sensor.y != 0) position += rotation(pose.z()) * sensor.position();
    }
    Vector2 sees(const Vector2& point) const {
        const Vector2 rel = point - position;
        return {rel.norm(), wrapAngle(std::atan2(rel.y(), rel.x()) - direction)};
    }

    Vector2 position;
    double direction;
};

/// Sums over sigma points that lie in pairs +-reach e_i: mean, covariance, and covariance with e_i.
template <int Dimensions>
struct SigmaSums {
    Vector2 mean;
    Matrix2 covariance;
    Eigen::Matrix<double, 2, Dimensions> with;

    /// at(i, side): the function's value at side e_i, as its difference to that at the centre.
    template <class At>
    SigmaSums(const Vector2& centre, const At& at) {
        const SigmaWeights w(Dimensions);
        std::array<Vector2, 2 * Dimensions> d;
        Vector2 shift = Vector2::Zero();
        for (int i = 0; i < Dimensions; ++i) {
            Vector2& plus = d[static_cast<std::size_t>(2 * i)];
            Vector2& minus = d[static_cast<std::size_t>(2 * i + 1)];
            plus = at(i, w.reach);
            minus = at(i, -w.reach);
            shift += w.other * (plus + minus);
            with.col(i) = w.other * w.reach * (plus - minus);
        }
        covariance = w.centre_cov * shift * shift.transpose();
        for (const Vector2& each : d) covariance += w.other * (each - shift) * (each - shift).transpose();
        mean = centre + shift;
        mean.y() = wrapAngle(mean.y());
    }
};

PointSight unscentedSight(const GaussianPoint& point, const PoseBelief& pose, const Pose2& sensor) {
    const Matrix2 L = lowerFactor(point.covariance);
    const PlacedSensor at_mean(pose.mean, sensor);
    const Vector2 centre = at_mean.sees(point.mean);
    const SigmaSums<5> sums(centre, [&](int i, double side) {
        const Vector2 seen = i < 3 ? PlacedSensor(pose.mean + side * pose.factor.col(i), sensor).sees(point.mean)
                                   : at_mean.sees(point.mean + side * L.col(i - 3));
        return rangeBearingResidual(seen, centre);
    });
    return {sums.mean, sums.covariance, sums.with.leftCols<3>(), L * sums.with.rightCols<2>().transpose()};
}

PointSight unscentedSight(const GaussianPoint& point, const Vector3& pose, const Pose2& sensor) {
    const Matrix2 L = lowerFactor(point.covariance);
    const PlacedSensor at(pose, sensor);
    const Vector2 centre = at.sees(point.mean);
    const SigmaSums<2> sums(centre, [&](int i, double side) {
        return rangeBearingResidual(at.sees(point.mean + side * L.col(i)), centre);
    });
    return {sums.mean, sums.covariance, Eigen::Matrix<double, 2, 3>::Zero(), L * sums.with.transpose()};
}

PointSight linearSight(const GaussianPoint& point, const Vector3& pose, const Pose2& sensor) {
    const RangeBearingPrediction h = predictRangeBearing(pose, point.mean, sensor);
    const Matrix2 cross = point.covariance * h.H_point.transpose();
    return {h.z, h.H_point * cross, Eigen::Matrix<double, 2, 3>::Zero(), cross};
}

}  // namespace

PointSight sightOf(const GaussianPoint& point, const PoseBelief& pose, const Pose2& sensor,
                   GaussianTransform transform) {
    if (pose.isPoint()) return sightOf(point, pose.mean, sensor, transform);
    if (transform == GaussianTransform::unscented) return unscentedSight(point, pose, sensor);
    const RangeBearingPrediction h = predictRangeBearing(pose.mean, point.mean, sensor);
    const Eigen::Matrix<double, 2, 3> A = h.H_robot * pose.factor;
    const Matrix2 cross = point.covariance * h.H_point.transpose();
    return {h.z, A * A.transpose() + h.H_point * cross, A, cross};
}

PointSight sightOf(const GaussianPoint& point, const Vector3& pose, const Pose2& sensor,
                   GaussianTransform transform) {
    return transform == GaussianTransform::unscented ? unscentedSight(point, pose, sensor)
                                                     : linearSight(point, pose, sensor);
}

PointInnovation::PointInnovation(const PointSight& sight, const Vector2& z, const Matrix2& R)
    : residual(rangeBearingResidual(z, sight.z)), S(sight.covariance + R) {
    const double det = S(0, 0) * S(1, 1) - S(0, 1) * S(1, 0);
    if (!(det > 0 && S(0, 0) > 0))
        throw std::domain_error("innovation covariance S is not positive definite");
    S_inverse << S(1, 1) / det, -S(0, 1) / det, -S(1, 0) / det, S(0, 0) / det;
    nis = residual.dot(S_inverse * residual);
    log_likelihood = -0.5 * (nis + std::log(det)) - std::log(2.0 * pi);
}

void update(GaussianPoint& point, const PointSight& sight, const PointInnovation& innovation) {
    const Matrix2 K = sight.cross * innovation.S_inverse;
    point.mean += K * innovation.residual;
    point.covariance -= K * innovation.S * K.transpose();
    point.covariance(0, 1) = point.covariance(1, 0) = 0.5 * (point.covariance(0, 1) + point.covariance(1, 0));
}

GaussianPoint firstSight(const Vector3& pose, const Vector2& z, const Matrix2& R, const Pose2& sensor,
                         GaussianTransform transform) {
    if (transform == GaussianTransform::linear) {
        const RangeBearingInverse inverse = invertRangeBearing(pose, z, sensor);
        return {inverse.point, inverse.G_z * R * inverse.G_z.transpose()};
    }
    const Matrix2 L = lowerFactor(R);
    const Vector2 centre = inverseRangeBearing<double>(pose, z, sensor);
    const SigmaWeights w(2);
    std::array<Vector2, 4> d;
    for (int i = 0; i < 4; ++i)
        d[static_cast<std::size_t>(i)] =
            inverseRangeBearing<double>(pose, z + (i % 2 ? -w.reach : w.reach) * L.col(i / 2), sensor) - centre;
    const Vector2 shift = w.other * (d[0] + d[1] + d[2] + d[3]);
    Matrix2 P = w.centre_cov * shift * shift.transpose();
    for (const Vector2& each : d) P += w.other * (each - shift) * (each - shift).transpose();
    return {centre + shift, P};
}

void RefinedPose::take(const PointSight& sight, const PointInnovation& innovation) {
    const Eigen::Matrix<double, 3, 2> AtSinv = sight.A.transpose() * innovation.S_inverse;
    const Matrix3 left = Matrix3::Identity() - AtSinv * sight.A;
    shift_ += spread_ * (AtSinv * innovation.residual);
    spread_ = spread_ * factorOf(0.5 * (left + left.transpose()));
    belief_.mean = prior_.mean + prior_.factor * shift_;
    belief_.mean.z() = wrapAngle(belief_.mean.z());
    belief_.factor = prior_.factor * spread_;
}

RefinedPose::Draw RefinedPose::draw(RandomStream& random) const {
    // p(xi) = N(0, I), q(xi) = N(shift, spread spread^t): the ratio needs no inverse of what may be singular.
    const Vector3 standard(random.normal(), random.normal(), random.normal());
    const Vector3 xi = shift_ + spread_ * standard;
    Draw out;
    out.pose = prior_.mean + prior_.factor * xi;
    out.pose.z() = wrapAngle(out.pose.z());
    out.log_ratio = 0.5 * (standard.squaredNorm() - xi.squaredNorm()) + spread_.diagonal().array().log().sum();
    return out;
}

}  // namespace slamot
