#include "slamot/core/estimation/TargetBank.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "slamot/core/estimation/CommonConditional.h"
#include "slamot/core/estimation/RobotTargetView.h"

namespace slamot {
namespace {

/// Part of a variance that is rounding.
constexpr double rounding = 1e-13;

/// V f(lambda) V^t over the eigenvalues above `floor`; 0 for the rest.
template <class Function>
Matrix2 onSpectrum(const Matrix2& A, double floor, const Function& f) {
    Eigen::SelfAdjointEigenSolver<Matrix2> solver;
    solver.computeDirect(A);
    const Vector2 values = solver.eigenvalues().unaryExpr([&](double l) { return l > floor ? f(l) : 0.0; });
    return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

/// P = U diag(D) U^t in 2 x 2 blocks, U lower triangular with I on the diagonal.
struct BlockFactor {
    Matrix6 U = Matrix6::Identity();
    Matrix2 D[3];
    double floor[3];  ///< eigenvalues of D up to here are rounding
};
BlockFactor factorise(Matrix6 P) {
    BlockFactor out;
    const double whole[] = {P.block<2, 2>(0, 0).trace(), P.block<2, 2>(2, 2).trace(),
                            P.block<2, 2>(4, 4).trace()};
    for (int k = 0; k < 3; ++k) {
        const int at = 2 * k, rest = 4 - at;
        out.D[k] = P.block<2, 2>(at, at);
        out.floor[k] = rounding * whole[k];
        const Matrix2 inverse = onSpectrum(out.D[k], out.floor[k], [](double l) { return 1.0 / l; });
        const Eigen::MatrixXd below = P.block(at + 2, at, rest, 2);
        out.U.block(at + 2, at, rest, 2) = below * inverse;
        P.block(at + 2, at + 2, rest, rest) -= below * inverse * below.transpose();
    }
    return out;
}

/// The symmetric T with T A T = B: the optimal transport from N(0, A) to N(0, B).
Matrix2 symmetricMap(const Matrix2& A, double floor, const Matrix2& B) {
    const Matrix2 root = onSpectrum(A, floor, [](double l) { return std::sqrt(l); });
    const Matrix2 inverse_root = onSpectrum(A, floor, [](double l) { return 1.0 / std::sqrt(l); });
    return inverse_root * onSpectrum(root * B * root, 0.0, [](double l) { return std::sqrt(l); }) *
           inverse_root;
}

Matrix6 symmetric(const Matrix6& P) {
    return 0.5 * (P + P.transpose());
}

/// Without the negative eigenvalues that rounding leaves in a symmetric matrix.
Matrix6 clipped(const Matrix6& Q) {
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(Q);
    return symmetric(solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() *
                     solver.eigenvectors().transpose());
}

}  // namespace

Matrix6 covarianceMap(const Matrix6& from, const Matrix6& to) {
    const BlockFactor a = factorise(from), b = factorise(to);
    Matrix6 T = Matrix6::Zero();
    for (int k = 0; k < 3; ++k) T.block<2, 2>(2 * k, 2 * k) = symmetricMap(a.D[k], a.floor[k], b.D[k]);
    return b.U * T * a.U.triangularView<Eigen::UnitLower>().solve(Matrix6::Identity());
}

TargetBank::TargetBank(const Eigen::VectorXd& mu, std::vector<TargetGaussian> modes)
    : mu_(mu), modes_(std::move(modes)), snapshot_(merged()) {}

void TargetBank::widen(const Matrix6& Q) {
    for (TargetGaussian& mode : modes_) mode.covariance += Q;
}

TargetGaussian TargetBank::merged() const {
    return mixture(mu_, modes_);
}

void TargetBank::move(const Vector6& from, const Matrix6& L, const Vector6& to) {
    for (auto& [m, P] : modes_) {
        m = to + L * (m - from);
        P = symmetric(L * P * L.transpose());
    }
}

void TargetBank::synchronise(const TargetGaussian& joint) {
    const Matrix6 L = covarianceMap(snapshot_.covariance, joint.covariance);
    move(snapshot_.mean, L, joint.mean);
    snapshot_ = joint;
}

BlockPrediction TargetBank::predict(const Eigen::MatrixXd& p, const std::vector<TargetModel>& models,
                                    double dt, const Vector6& joint_mean) {
    const MixedModes start = mixedModes(p, mu_, modes_);
    const Eigen::VectorXd& c = start.probabilities;
    const std::vector<TargetGaussian>& mixed = start.modes;
    std::vector<TargetGaussian> predicted(modes_.size());
    std::vector<Matrix6> A(modes_.size());
    for (std::size_t j = 0; j < modes_.size(); ++j) {
        const TargetPrediction f = predictTarget(models[j], mixed[j].mean, dt);
        A[j] = f.F;
        predicted[j] = {f.mean, symmetric(f.F * mixed[j].covariance * f.F.transpose()) + f.Q};
    }

    // The joint state's block follows the merged motion: X is its covariance after with before.
    const TargetGaussian before = mixture(c, mixed), after = mixture(c, predicted);
    Matrix6 X = Matrix6::Zero();
    for (std::size_t j = 0; j < modes_.size(); ++j)
        X += c(static_cast<Eigen::Index>(j)) *
             (A[j] * mixed[j].covariance +
              (predicted[j].mean - after.mean) * (mixed[j].mean - before.mean).transpose());
    const Matrix6 Phi = X * pseudoInverse(before.covariance);
    modes_ = std::move(predicted);
    mu_ = c;
    return {after.mean + Phi * (joint_mean - before.mean), Phi,
            clipped(symmetric(after.covariance - Phi * before.covariance * Phi.transpose()))};
}

void TargetBank::linearise(const RobotGivenTarget& robot, const RangeBearingDetection& detection,
                           const Pose2& sensor, Consistency consistency,
                           std::vector<Linearisation>& by_mode) const {
    by_mode.clear();
    for (const TargetGaussian& mode : modes_)
        by_mode.push_back(
            slamot::linearise(robot.with(mode), robot.target(), detection, sensor, consistency));
}

void TargetBank::update(const RobotGivenTarget& robot, const std::vector<Linearisation>& by_mode,
                        Consistency consistency) {
    Eigen::VectorXd log_mu(mu_.size());
    for (std::size_t j = 0; j < modes_.size(); ++j) {
        RobotTargetView view = robot.with(modes_[j]);
        const double log_Lambda = view.update(by_mode[j].measurement, consistency);
        modes_[j] = view.target();
        log_mu(static_cast<Eigen::Index>(j)) = std::log(mu_(static_cast<Eigen::Index>(j))) + log_Lambda;
    }
    mu_ = (log_mu.array() - log_mu.maxCoeff()).exp();
    mu_ /= mu_.sum();
}

void TargetBank::guard(const TargetGaussian& joint) {
    constexpr double limit = 4;
    const TargetGaussian merged = this->merged();
    const Vector6 e = merged.mean - joint.mean;
    if (e.dot(pseudoInverse(joint.covariance) * e) <= limit) return;
    move(merged.mean, covarianceMap(merged.covariance, joint.covariance), joint.mean);
}

}  // namespace slamot
