#include "slamot/core/particles/TargetFilter.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace slamot {
namespace {

/// Headings this much less likely than the likeliest are let go.
constexpr double refuted = 1e-4;
/// [rad] Headings of this standard deviation together are one Gaussian: sine and cosine are straight enough there.
constexpr double one_heading = 0.3;

/// Standard deviation of one of n equally spaced headings: half their spacing, which together is even to 1.5 %.
double headingStd(int n) {
    return n > 1 ? pi / n : pi / std::sqrt(3.0);
}

Matrix6 symmetric(const Matrix6& P) {
    return 0.5 * (P + P.transpose());
}

GaussianPoint pointOf(const TargetGaussian& mode) {
    return {mode.mean.head<2>(), mode.covariance.topLeftCorner<2, 2>()};
}

/// The EKF's or unscented filter's update of one mode; log of its likelihood.
double correct(TargetGaussian& mode, const SensorPlace& sensor, const TargetSight& sight, GaussianTransform transform) {
    const GaussianPoint point = pointOf(mode);
    const PointSight expected = sightOf(point, sensor, transform);
    const PointInnovation innovation(expected, sight.z, sight.R);
    // All that is known of the mover meets the detection through its position.
    const Eigen::Matrix<double, 6, 2> with_z =
        mode.covariance.leftCols<2>() * point.covariance.inverse() * expected.cross;
    mode.mean += with_z * (innovation.S_inverse * innovation.residual);
    // P - K S K^t as P - W W^t, which is symmetric to the bit.
    const Eigen::LLT<Matrix2> S(innovation.S);
    const Eigen::Matrix<double, 2, 6> Wt = S.matrixL().solve(with_z.transpose());
    mode.covariance -= Wt.transpose() * Wt;
    return innovation.logLikelihood();
}

}  // namespace

TargetStep::TargetStep(const TargetSettings& settings, double seconds) : dt(seconds) {
    if (settings.drive == TargetDrive::control) return;
    p = settings.chain.over(dt);
    for (const TargetModel& model : settings.models)
        linear.push_back(isLinear(model.kind) ? predictTarget(model, Vector6::Zero(), dt) : TargetPrediction());
}

TargetFilter::TargetFilter(const TargetSettings& settings, const RelativeGaussian& mover, const Vector3& pose) {
    const NewBlock sight = inWorld(mover, pose);
    if (settings.drive == TargetDrive::control) {
        startHeadings(settings.control, sight);
    } else {
        mu_ = settings.initial;
        modes_.assign(static_cast<std::size_t>(mu_.size()), {sight.mean, sight.own});
    }
}

void TargetFilter::predict(const TargetSettings& settings, const TargetStep& step) {
    if (settings.drive == TargetDrive::control) return predictHeadings(settings, step.dt);
    MixedModes start = mixedModes(step.p, mu_, modes_);
    mu_ = std::move(start.probabilities);
    modes_ = std::move(start.modes);
    for (std::size_t j = 0; j < modes_.size(); ++j) {
        TargetGaussian& mode = modes_[j];
        const TargetModel& model = settings.models[j];
        if (isLinear(model.kind)) {
            const TargetPrediction& f = step.linear[j];
            mode = {f.F * mode.mean, symmetric(f.F * mode.covariance * f.F.transpose()) + f.Q};
        } else {
            const TargetPrediction f = predictTarget(model, mode.mean, step.dt);
            mode = {f.mean, symmetric(f.F * mode.covariance * f.F.transpose()) + f.Q};
        }
    }
}

double TargetFilter::update(const TargetSettings& settings, const Vector3& pose, const TargetSight& sight) {
    const SensorPlace sensor = placeOf(pose, sight.sensor);
    Eigen::VectorXd log_mu(mu_.size());
    for (Eigen::Index j = 0; j < mu_.size(); ++j)
        log_mu(j) =
            std::log(mu_(j)) + correct(modes_[static_cast<std::size_t>(j)], sensor, sight, settings.transform);
    const double largest = log_mu.maxCoeff();
    mu_ = (log_mu.array() - largest).exp();
    const double sum = mu_.sum();
    mu_ /= sum;
    if (settings.drive == TargetDrive::control) joinHeadings();
    return largest + std::log(sum);
}

GaussianPoint TargetFilter::position() const {
    if (modes_.size() == 1) return pointOf(modes_.front());
    const TargetGaussian both = mixture(mu_, modes_);
    return pointOf(both);
}

TargetGaussian TargetFilter::merged(const TargetSettings& settings) const {
    if (settings.drive == TargetDrive::modes) return mixture(mu_, modes_);
    std::vector<TargetGaussian> states;
    for (const TargetGaussian& mode : modes_) {
        const ControlledState state = controlledState(settings.control, mode.mean.head<3>());
        states.push_back({state.mean, state.G * mode.covariance.topLeftCorner<3, 3>() * state.G.transpose() + state.Q});
    }
    return mixture(mu_, states);
}

// --- paper 2's mover
// ---------------------------------------------------------------------------------------------------

void TargetFilter::startHeadings(const ControlledTarget& control, const NewBlock& mover) {
    const Vector2 p = mover.mean.head<2>(), v = mover.mean.segment<2>(2);
    const Matrix2 P_pp = mover.own.topLeftCorner<2, 2>(), P_pv = mover.own.block<2, 2>(0, 2),
                  P_vv = mover.own.block<2, 2>(2, 2);
    // The position given the velocity v' is p + B (v' - v); and v' is the speed along the heading.
    const Eigen::LLT<Matrix2> factor(P_vv);
    const Matrix2 B = factor.solve(P_pv.transpose()).transpose(), P_given = P_pp - B * P_pv.transpose();
    const int n = control.headings;
    const double variance = headingStd(n) * headingStd(n);
    Eigen::VectorXd log_mu(n);
    for (int k = 0; k < n; ++k) {
        const double heading = 2 * pi * k / n;
        const Vector2 along(std::cos(heading), std::sin(heading)), H = control.speed * Vector2(-along.y(), along.x());
        const Eigen::LLT<Matrix2> S(Matrix2(P_vv + variance * H * H.transpose()));
        const Vector2 nu = v - control.speed * along;
        log_mu(k) = -0.5 * nu.dot(S.solve(nu)) - std::log(Matrix2(S.matrixL()).diagonal().prod());
        const double turned = variance * H.dot(S.solve(nu)), left = variance - variance * variance * H.dot(S.solve(H));
        const Vector2 answer = B * H;
        TargetGaussian mode{Vector6::Zero(), Matrix6::Zero()};
        mode.mean << p - B * nu + answer * turned, heading + turned, Vector3::Zero();
        mode.covariance.topLeftCorner<2, 2>() = P_given + left * answer * answer.transpose();
        mode.covariance.block<2, 1>(0, 2) = left * answer;
        mode.covariance.block<1, 2>(2, 0) = left * answer.transpose();
        mode.covariance(2, 2) = left;
        modes_.push_back(mode);
    }
    mu_ = (log_mu.array() - log_mu.maxCoeff()).exp();
    mu_ /= mu_.sum();
    joinHeadings();
}

void TargetFilter::predictHeadings(const TargetSettings& settings, double dt) {
    for (TargetGaussian& mode : modes_) {
        const ControlledPrediction g = predictControlled(settings.control, mode.mean.head<3>(), dt);
        mode.mean.head<3>() = g.pose;
        const Matrix3 P = g.F * mode.covariance.topLeftCorner<3, 3>() * g.F.transpose() + g.Q;
        mode.covariance.topLeftCorner<3, 3>() = 0.5 * (P + P.transpose());
    }
}

void TargetFilter::joinHeadings() {
    if (modes_.size() == 1) return;
    const double least = refuted * mu_.maxCoeff();
    std::size_t kept = 0;
    for (std::size_t k = 0; k < modes_.size(); ++k) {
        const double weight = mu_(static_cast<Eigen::Index>(k));
        if (weight < least) continue;
        mu_(static_cast<Eigen::Index>(kept)) = weight;
        modes_[kept++] = modes_[k];
    }
    modes_.erase(modes_.begin() + static_cast<std::ptrdiff_t>(kept), modes_.end());
    mu_.conservativeResize(static_cast<Eigen::Index>(kept));
    mu_ /= mu_.sum();

    // Headings on the same turn as the likeliest one: then they are numbers like others.
    Eigen::Index likeliest = 0;
    mu_.maxCoeff(&likeliest);
    const double reference = modes_[static_cast<std::size_t>(likeliest)].mean(2);
    for (TargetGaussian& mode : modes_) mode.mean(2) = reference + angleDifference(mode.mean(2), reference);
    const TargetGaussian one = mixture(mu_, modes_);
    if (one.covariance(2, 2) > one_heading * one_heading) return;
    modes_.assign(1, one);
    mu_ = Eigen::VectorXd::Ones(1);
}

}  // namespace slamot
