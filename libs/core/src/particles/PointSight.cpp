#include "slamot/core/particles/PointSight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace slamot {
namespace {

Matrix2 lowerFactor(const Matrix2& P) {
    const double a = std::sqrt(std::max(P(0, 0), 0.0)), b = a > 0 ? P(1, 0) / a : 0.0;
    return (Matrix2() << a, 0, b, std::sqrt(std::max(P(1, 1) - b * b, 0.0))).finished();
}

/// What is seen when sensor and point are moved a little, beside what is seen when they are not. Bearings are compared
/// as angles between lines of sight: a turn needs no sine unless it moves the sensor, and there is nothing to wrap twice.
class MovedSight {
  public:
    /// `lever`: from the point that the robot turns about to the sensor, in the world [m].
    MovedSight(const SensorPlace& sensor, const Vector2& lever, const Vector2& point)
        : lever_(lever),
          has_lever_(!lever.isZero(0)),
          rel_(point - sensor.position),
          range_(rel_.norm()),
          line_(range_ > 0 ? rel_ : Vector2::UnitX()),
          unmoved_(range_, wrapAngle(std::atan2(rel_.y(), rel_.x()) - sensor.heading)) {}

    const Vector2& unmoved() const { return unmoved_; }
    Vector2 withPoint(const Vector2& shift) const { return to(rel_ + shift, 0); }
    Vector2 withPose(const Vector3& shift) const {
        const Vector2 rel = rel_ - shift.head<2>();
        return to(has_lever_ ? Vector2(rel + lever_ - rotation(shift.z()) * lever_) : rel, shift.z());
    }

  private:
    Vector2 to(const Vector2& rel, double turn) const {
        const double across = line_.x() * rel.y() - line_.y() * rel.x();
        return {rel.norm() - range_, wrapAngle(std::atan2(across, line_.dot(rel)) - turn)};
    }

    Vector2 lever_;
    bool has_lever_;
    Vector2 rel_;
    double range_;
    Vector2 line_, unmoved_;
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
    const SensorPlace place = placeOf(pose.mean, sensor);
    const MovedSight sight(place, place.position - pose.mean.head<2>(), point.mean);
    const SigmaSums<5> sums(sight.unmoved(), [&](int i, double side) {
        return i < 3 ? sight.withPose(side * pose.factor.col(i)) : sight.withPoint(side * L.col(i - 3));
    });
    return {sums.mean, sums.covariance, sums.with.leftCols<3>(), L * sums.with.rightCols<2>().transpose()};
}

Vector2 pointedAt(const SensorPlace& sensor, const Vector2& z) {
    return sensor.position + z.x() * Vector2(std::cos(sensor.heading + z.y()), std::sin(sensor.heading + z.y()));
}

PointSight unscentedSight(const GaussianPoint& point, const SensorPlace& sensor) {
    const Matrix2 L = lowerFactor(point.covariance);
    const MovedSight sight(sensor, Vector2::Zero(), point.mean);
    const SigmaSums<2> sums(sight.unmoved(), [&](int i, double side) { return sight.withPoint(side * L.col(i)); });
    return {sums.mean, sums.covariance, Eigen::Matrix<double, 2, 3>::Zero(), L * sums.with.transpose()};
}

PointSight linearSight(const GaussianPoint& point, const SensorPlace& sensor) {
    const Vector2 rel = point.mean - sensor.position;
    const double range = rel.norm(), r = std::max(range, range_floor);
    const Vector2 along = range > 0 ? Vector2(rel / range) : Vector2::UnitX();
    Matrix2 H;
    H << along.x(), along.y(), -along.y() / r, along.x() / r;
    const Matrix2 cross = point.covariance * H.transpose();
    return {{range, wrapAngle(std::atan2(rel.y(), rel.x()) - sensor.heading)},
            H * cross,
            Eigen::Matrix<double, 2, 3>::Zero(),
            cross};
}

}  // namespace

SensorPlace placeOf(const Vector3& pose, const Pose2& sensor) {
    return {pose.head<2>() + rotation(pose.z()) * sensor.position(), pose.z() + sensor.theta};
}

PointSight sightOf(const GaussianPoint& point, const PoseBelief& pose, const Pose2& sensor,
                   GaussianTransform transform) {
    if (pose.isPoint()) return sightOf(point, placeOf(pose.mean, sensor), transform);
    if (transform == GaussianTransform::unscented) return unscentedSight(point, pose, sensor);
    const RangeBearingPrediction h = predictRangeBearing(pose.mean, point.mean, sensor);
    const Eigen::Matrix<double, 2, 3> A = h.H_robot * pose.factor;
    const Matrix2 cross = point.covariance * h.H_point.transpose();
    return {h.z, A * A.transpose() + h.H_point * cross, A, cross};
}

PointSight sightOf(const GaussianPoint& point, const SensorPlace& sensor, GaussianTransform transform) {
    return transform == GaussianTransform::unscented ? unscentedSight(point, sensor) : linearSight(point, sensor);
}

PointInnovation::PointInnovation(const PointSight& sight, const Vector2& z, const Matrix2& R)
    : residual(rangeBearingResidual(z, sight.z)), S(sight.covariance + R) {
    const double det = S(0, 0) * S(1, 1) - S(0, 1) * S(1, 0);
    if (!(det > 0 && S(0, 0) > 0))
        throw std::domain_error("innovation covariance S is not positive definite");
    S_inverse << S(1, 1) / det, -S(0, 1) / det, -S(1, 0) / det, S(0, 0) / det;
    nis = residual.dot(S_inverse * residual);
}

double PointInnovation::logLikelihood() const {
    static const double log_2_pi = std::log(2.0 * pi);
    return -0.5 * (nis + std::log(S(0, 0) * S(1, 1) - S(0, 1) * S(1, 0))) - log_2_pi;
}

void update(GaussianPoint& point, const PointSight& sight, const PointInnovation& innovation) {
    const Matrix2 K = sight.cross * innovation.S_inverse;
    point.mean += K * innovation.residual;
    point.covariance -= K * innovation.S * K.transpose();
    point.covariance(0, 1) = point.covariance(1, 0) = 0.5 * (point.covariance(0, 1) + point.covariance(1, 0));
}

GaussianPoint firstSight(const SensorPlace& sensor, const Vector2& z, const Matrix2& R,
                         GaussianTransform transform) {
    const Vector2 centre = pointedAt(sensor, z);
    if (transform == GaussianTransform::linear) {
        const Vector2 along = (centre - sensor.position) / z.x();
        Matrix2 G;  // d point / d z
        G << along.x(), -z.x() * along.y(), along.y(), z.x() * along.x();
        return {centre, G * R * G.transpose()};
    }
    const Matrix2 L = lowerFactor(R);
    const SigmaWeights w(2);
    std::array<Vector2, 4> d;
    for (int i = 0; i < 4; ++i)
        d[static_cast<std::size_t>(i)] =
            pointedAt(sensor, z + (i % 2 ? -w.reach : w.reach) * L.col(i / 2)) - centre;
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
