#include "slamot/core/objects/RelativeTrack.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "TwoStateChain.h"
#include "slamot/core/models/RangeBearing.h"

namespace slamot {
namespace {

/// A motion of an object whose motion is not known never becomes impossible by rounding.
constexpr double least_probability = 1e-9;

/// The object as the sensor is about to see it, if it moves in one of the ways.
struct Sight {
    ExpectedDetection expected;
    Matrix2 H;  ///< d z / d position
};

Sight sightOf(const RelativeGaussian& object, const Pose2& sensor) {
    // The robot is where its frame is, without doubt: what it does not know of its move is in the object's
    // covariance already.
    const auto h = predictRangeBearing(Vector3::Zero(), object.position(), sensor);
    return {{h.z, h.H_point * object.covariance.topLeftCorner<2, 2>() * h.H_point.transpose()}, h.H_point};
}

RelativeTrack::Match matchWith(const ExpectedDetection& expected, const RangeBearingDetection& detection) {
    const Vector2 nu = rangeBearingResidual(detection.z(), expected.z);
    const Eigen::LLT<Matrix2> S(expected.covariance + detection.covariance);
    if (S.info() != Eigen::Success)
        throw std::domain_error("innovation covariance S is not positive definite");
    const double nis = nu.dot(S.solve(nu)), root_det = S.matrixL().determinant();
    return {nis, -0.5 * nis - std::log(root_det) - std::log(2.0 * pi)};
}

/// w a + (1 - w) b: first two moments of the mixture.
RelativeGaussian merged(double w, const RelativeGaussian& a, const RelativeGaussian& b) {
    const BlockVector apart = a.mean - b.mean;
    return {b.mean + w * apart,
            w * a.covariance + (1 - w) * b.covariance + w * (1 - w) * apart * apart.transpose()};
}

/// Joseph form: definite whatever the rounding of the gain.
void correct(RelativeGaussian& object, const RangeBearingDetection& detection, const Pose2& sensor) {
    const Sight sight = sightOf(object, sensor);
    const Eigen::Index n = object.mean.size();
    MeasurementJacobian H = MeasurementJacobian::Zero(2, n);
    H.leftCols<2>() = sight.H;
    const BlockMatrix HP = H * object.covariance;
    const Matrix2 S = sight.expected.covariance + detection.covariance;
    const BlockMatrix K = S.llt().solve(HP).transpose();
    const BlockMatrix A = BlockMatrix::Identity(n, n) - K * H;
    object.mean += K * rangeBearingResidual(detection.z(), sight.expected.z);
    object.covariance = A * object.covariance * A.transpose() + K * detection.covariance * K.transpose();
}

}  // namespace

RelativeStep relativeStep(const RobotMotionParameters& motion, const OdometryIncrement& odometry) {
    const MotionPrediction move = predictMotion(motion, Vector3::Zero(), odometry);
    return {{Pose2::fromVector(move.pose), move.Q}, odometry.seconds()};
}

RelativeGaussian afterMove(const RelativeGaussian& object, const PoseGaussian& move) {
    const Matrix2 back = rotation(-move.mean.theta);
    const Eigen::Index n = object.mean.size();
    RelativeGaussian out{object.mean, BlockMatrix(n, n)};
    out.mean.head<2>() -= move.mean.position();
    BlockMatrix G = BlockMatrix::Zero(n, 3);  // d object / d move
    G.topLeftCorner<2, 2>() = -back;
    for (Eigen::Index k = 0; k < n; k += 2) {
        out.mean.segment<2>(k) = back * out.mean.segment<2>(k);
        G.block<2, 1>(k, 2) = -(quarterTurn() * out.mean.segment<2>(k));
        for (Eigen::Index j = 0; j < n; j += 2)
            out.covariance.block<2, 2>(k, j) = back * object.covariance.block<2, 2>(k, j) * back.transpose();
    }
    out.covariance += G * move.covariance * G.transpose();
    return out;
}

RelativeTrack RelativeTrack::still(const RelativeGaussian& point) {
    return {0, point, moverAt(point, 0, 0)};
}

RelativeTrack RelativeTrack::moving(const RelativeGaussian& point, double velocity_std,
                                    double acceleration_std) {
    return {1, point, moverAt(point, velocity_std, acceleration_std)};
}

RelativeTrack RelativeTrack::unknown(const RelativeGaussian& point, const MotionChange& change) {
    return {change.moving_probability, point, moverAt(point, change.velocity_std, 0)};
}

void RelativeTrack::predict(const RelativeStep& step, const TargetModel& model, const MotionChange& change) {
    if (mayBeStill() && mayMove()) mix(step.dt, change);
    if (mayMove()) {
        const TargetPrediction motion = predictTarget(model, moving_.mean, step.dt);
        moving_.mean = motion.mean;
        moving_.covariance = motion.F * moving_.covariance * motion.F.transpose() + motion.Q;
        moving_ = afterMove(moving_, step.move);
    }
    if (mayBeStill()) still_ = afterMove(still_, step.move);
}

void RelativeTrack::mix(double dt, const MotionChange& change) {
    const TwoStateChain chain(change.start_every, change.stop_every, dt);
    const double p = moving_probability_;
    const double starts = (1 - p) * chain.a_to_b, stops = p * chain.b_to_a;
    const double still = 1 - p - starts + stops, moving = p - stops + starts;
    const RelativeGaussian stopped{moving_.mean.head<2>(), moving_.covariance.topLeftCorner<2, 2>()};
    const RelativeGaussian started = moverAt(still_, change.velocity_std, 0);
    still_ = merged(stops / still, stopped, still_);
    moving_ = merged(starts / moving, started, moving_);
    moving_probability_ = moving;
}

ExpectedDetection RelativeTrack::expected(const Pose2& sensor) const {
    if (!mayMove()) return sightOf(still_, sensor).expected;
    if (!mayBeStill()) return sightOf(moving_, sensor).expected;
    const ExpectedDetection still = sightOf(still_, sensor).expected,
                            moving = sightOf(moving_, sensor).expected;
    const double p = moving_probability_;
    const Vector2 apart = rangeBearingResidual(moving.z, still.z);
    const Vector2 z = still.z + p * apart;
    return {{z.x(), wrapAngle(z.y())},
            (1 - p) * still.covariance + p * moving.covariance + p * (1 - p) * apart * apart.transpose()};
}

RelativeTrack::Match RelativeTrack::match(const RangeBearingDetection& detection, const Pose2& sensor) const {
    Match out = matchWith(expected(sensor), detection);
    if (!mayMove() || !mayBeStill()) return out;
    const double p = moving_probability_;
    const double still =
        std::log1p(-p) + matchWith(sightOf(still_, sensor).expected, detection).log_likelihood;
    const double moving =
        std::log(p) + matchWith(sightOf(moving_, sensor).expected, detection).log_likelihood;
    const double larger = std::max(still, moving);
    out.log_likelihood = larger + std::log1p(std::exp(-std::abs(moving - still)));
    return out;
}

double RelativeTrack::nisAsMover(const RangeBearingDetection& detection, const Pose2& sensor) const {
    return matchWith(sightOf(moving_, sensor).expected, detection).nis;
}

void RelativeTrack::updateAsMover(const RangeBearingDetection& detection, const Pose2& sensor,
                                  double detection_probability, double density) {
    const double its_own =
        std::exp(matchWith(sightOf(moving_, sensor).expected, detection).log_likelihood) / density;
    const double p = moving_probability_,
                 moving = p * (detection_probability * its_own + 1 - detection_probability),
                 still = (1 - p) * (1 - detection_probability);
    moving_probability_ = std::clamp(moving / (moving + still), least_probability, 1 - least_probability);
    correct(moving_, detection, sensor);
}

void RelativeTrack::update(const RangeBearingDetection& detection, const Pose2& sensor) {
    if (mayBeStill() && mayMove()) {
        const double still = matchWith(sightOf(still_, sensor).expected, detection).log_likelihood,
                     moving = matchWith(sightOf(moving_, sensor).expected, detection).log_likelihood;
        const double p = moving_probability_, odds_still = (1 - p) / p * std::exp(still - moving);
        moving_probability_ = std::clamp(1 / (1 + odds_still), least_probability, 1 - least_probability);
    }
    if (mayBeStill()) correct(still_, detection, sensor);
    if (mayMove()) correct(moving_, detection, sensor);
}

}  // namespace slamot
