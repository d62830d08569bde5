#include "slamot/core/estimation/RobotTargetView.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "slamot/core/estimation/CommonConditional.h"

namespace slamot {

Eigen::MatrixXd RobotTargetView::jointCovariance(const std::vector<BlockId>& blocks) const {
    Eigen::Index n = 0;
    for (const BlockId block : blocks) n += size(block);
    Eigen::MatrixXd out(n, n);
    Eigen::Index row = 0;
    for (const BlockId a : blocks) {
        Eigen::Index column = 0;
        for (const BlockId b : blocks) {
            out.block(row, column, size(a), size(b)) = covariance(a, b);
            column += size(b);
        }
        row += size(a);
    }
    return out;
}

double RobotTargetView::update(const LinearMeasurement& m, Consistency consistency) {
    Eigen::Matrix<double, 2, 9> H = Eigen::Matrix<double, 2, 9>::Zero();
    for (int k = 0; k < m.term_count; ++k)
        H.middleCols(offset(m.terms[k].block), m.terms[k].H.cols()) += m.terms[k].H;
    const Eigen::LLT<Matrix2> S(H * P_ * H.transpose() + m.R);
    if (S.info() != Eigen::Success)
        throw std::domain_error("innovation covariance S is not positive definite");

    const Eigen::Matrix<double, 9, 2> W = S.matrixL().solve(H * P_).transpose();  // P H^t L^-t
    const Vector2 w = S.matrixL().solve(m.residual);
    const Vector9 dx = W * w;
    x_ += dx;
    x_(2) = wrapAngle(x_(2));
    P_ -= W * W.transpose();
    if (consistency == Consistency::invariant) {
        // P <- D P D^t, D = I + d e_theta^t, d = J dx on every 2-vector
        Vector9 d = Vector9::Zero();
        for (const int at : {0, 3, 5, 7}) d.segment<2>(at) = quarterTurn() * dx.segment<2>(at);
        const Vector9 p = P_.col(2) + 0.5 * P_(2, 2) * d;
        P_ += d * p.transpose() + p * d.transpose();
    }
    const Matrix2 L = S.matrixL();
    return -0.5 * w.squaredNorm() - L.diagonal().array().log().sum() - std::log(2.0 * pi);
}

RobotGivenTarget::RobotGivenTarget(const JointView& joint, BlockId target)
    : target_(target), robot_(joint.mean(robot_block)), mover_(joint.mean(target)) {
    const Matrix6 P_TT = joint.covariance(target, target);
    const Eigen::Matrix<double, 3, 6> P_RT = joint.covariance(robot_block, target);
    B_ = P_RT * pseudoInverse(P_TT);
    E_ = joint.covariance(robot_block, robot_block);
    E_ -= B_ * P_RT.transpose();
    E_ = 0.5 * (E_ + E_.transpose()).eval();
}

RobotTargetView RobotGivenTarget::with(const TargetGaussian& mover) const {
    RobotTargetView::Vector9 x;
    x << robot_ + B_ * (mover.mean - mover_), mover.mean;
    x(2) = wrapAngle(x(2));
    const Eigen::Matrix<double, 3, 6> P_RT = B_ * mover.covariance;
    RobotTargetView::Matrix9 P;
    P << E_ + P_RT * B_.transpose(), P_RT, P_RT.transpose(), mover.covariance;
    return {target_, x, P};
}

}  // namespace slamot
