#pragma once
// Robot and one mover as one mode of the mover's bank has them: nine dimensions [x y theta | p v a].
#include "slamot/core/estimation/TargetBank.h"

namespace slamot {

class RobotTargetView : public JointView {
  public:
    using Vector9 = Eigen::Matrix<double, 9, 1>;
    using Matrix9 = Eigen::Matrix<double, 9, 9>;

    RobotTargetView(BlockId target, const Vector9& x, const Matrix9& P) : target_(target), x_(x), P_(P) {}

    BlockVector mean(BlockId block) const override { return x_.segment(offset(block), size(block)); }
    BlockMatrix covariance(BlockId a, BlockId b) const override {
        return P_.block(offset(a), offset(b), size(a), size(b));
    }
    Eigen::MatrixXd jointCovariance(const std::vector<BlockId>& blocks) const override;

    /// The EKF's update; gives the measurement's log density.
    double update(const LinearMeasurement& measurement, Consistency consistency);
    TargetGaussian target() const { return {x_.tail<6>(), P_.bottomRightCorner<6, 6>()}; }

  private:
    static int offset(BlockId block) { return block == robot_block ? 0 : 3; }
    static int size(BlockId block) { return block == robot_block ? 3 : 6; }

    BlockId target_;
    Vector9 x_;
    Matrix9 P_;
};

/// The joint state's robot given a mover: x_R + B (x_T' - x_T) with covariance E.
class RobotGivenTarget {
  public:
    RobotGivenTarget(const JointView& joint, BlockId target);
    BlockId target() const { return target_; }
    /// Robot and mover when the mover's distribution is this one.
    RobotTargetView with(const TargetGaussian& mover) const;

  private:
    BlockId target_;
    Vector3 robot_;
    Vector6 mover_;
    Eigen::Matrix<double, 3, 6> B_;
    Matrix3 E_;
};

}  // namespace slamot
