#include "slamot/core/estimation/DecoupledImm.h"

#include <algorithm>

#include "slamot/core/estimation/RangeBearingUpdate.h"
#include "slamot/core/estimation/RobotTargetView.h"

namespace slamot {
namespace {

/// Movers have no block in the bank: their ids count down from here, where the bank gives none.
constexpr BlockId no_block = -1;
bool isTarget(BlockId block) {
    return block < no_block;
}

}  // namespace

DecoupledImm::DecoupledImm(std::shared_ptr<const ModalSettings> settings, std::unique_ptr<JointBank> bank)
    : ModalState(std::move(settings), std::move(bank)), last_target_(no_block) {}

// --- one step
// ----------------------------------------------------------------------------------------------------

void DecoupledImm::predict(const OdometryIncrement& odometry, const std::vector<TargetModel>& models) {
    JointMode& joint = bank_->mode(0);
    const MotionPrediction robot = predictMotion(settings().motion, joint.mean(robot_block), odometry);
    joint.propagate(robot_block, robot.pose, robot.F, robot.Q);

    const Eigen::MatrixXd p = settings().chain.over(odometry.seconds());
    for (auto& [target, tracker] : targets_)
        tracker.predict(p, models, odometry.seconds(), tracker.merged().mean);
}

void DecoupledImm::update(const RangeBearingSet& seen, const KnownObjects& known,
                          std::vector<Innovation>& innovations) {
    update_by_landmarks_(bank_->mode(0), bank_->consistency(), settings().gate, seen, known.landmarks,
                         innovations);
    for (const auto& sight : known.targets) updateTarget(seen, sight, innovations[sight.detection]);
}

void DecoupledImm::updateTarget(const RangeBearingSet& seen, const KnownObjects::Sight& sight,
                                Innovation& innovation) {
    const RangeBearingDetection& detection = seen.detections[sight.detection];
    TargetBank& tracker = targets_[indexOf(sight.block)].second;
    // Without correlation the robot is at its estimate whatever the mover's mode, and S = H_T P_T H_T^t +
    // (R + H_R P_R H_R^t): the robot's covariance is noise.
    const RobotGivenTarget robot(*this, sight.block);
    tracker.linearise(robot, detection, seen.sensors[detection.sensor].pose, bank_->consistency(), linear_);
    const Matrix2 more_noise = gateOf(sight).judge(tracker.probabilities(), linear_, detection, innovation);
    if (innovation.outcome == Outcome::rejected) return;
    for (Linearisation& mode : linear_) mode.measurement.R += more_noise;
    // The tracker has no heading along which its covariance could be transported.
    tracker.update(robot, linear_, Consistency::classic);
}

// --- objects that come and go
// ------------------------------------------------------------------------------------

BlockId DecoupledImm::addTarget(const RelativeGaussian& target) {
    const NewBlock sight = byMode(target).front();
    const Matrix3 P_RR = covariance(robot_block, robot_block);
    const TargetGaussian first{sight.mean, sight.G * P_RR * sight.G.transpose() + sight.own};
    const Eigen::VectorXd& initial = settings().initial;
    targets_.emplace_back(
        --last_target_,
        TargetBank(initial, std::vector<TargetGaussian>(static_cast<std::size_t>(initial.size()), first)));
    return last_target_;
}

void DecoupledImm::removeTarget(BlockId target) {
    targets_.erase(targets_.begin() + static_cast<std::ptrdiff_t>(indexOf(target)));
}

void DecoupledImm::widenTarget(BlockId target, const Matrix6& Q) {
    targets_[indexOf(target)].second.widen(Q);
}

std::size_t DecoupledImm::indexOf(BlockId target) const {
    std::size_t t = 0;
    while (targets_.at(t).first != target) ++t;
    return t;
}

// --- estimates
// ---------------------------------------------------------------------------------------------------

TargetBelief DecoupledImm::target(BlockId target) const {
    const TargetBank& tracker = trackerOf(target);
    const TargetGaussian merged = tracker.merged();
    return {merged.mean, merged.covariance, tracker.probabilities()};
}

BlockVector DecoupledImm::mean(BlockId block) const {
    if (isTarget(block)) return trackerOf(block).merged().mean;
    return bank_->mode(0).mean(block);
}

BlockMatrix DecoupledImm::covariance(BlockId a, BlockId b) const {
    if (a == b && isTarget(a)) return trackerOf(a).merged().covariance;
    if (isTarget(a) || isTarget(b)) return BlockMatrix::Zero(mean(a).size(), mean(b).size());
    return bank_->mode(0).covariance(a, b);
}

Eigen::MatrixXd DecoupledImm::jointCovariance(const std::vector<BlockId>& blocks) const {
    std::vector<BlockId> joint;
    std::copy_if(blocks.begin(), blocks.end(), std::back_inserter(joint),
                 [](BlockId block) { return !isTarget(block); });
    const Eigen::MatrixXd P = bank_->mode(0).jointCovariance(joint);

    std::vector<Eigen::Index> rows;  // where P's rows go
    Eigen::Index n = 0;
    for (const BlockId block : blocks) {
        const Eigen::Index size = mean(block).size();
        if (!isTarget(block))
            for (Eigen::Index k = 0; k < size; ++k) rows.push_back(n + k);
        n += size;
    }
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index column = 0; column < P.cols(); ++column)
        for (Eigen::Index row = 0; row < P.rows(); ++row) out(rows[row], rows[column]) = P(row, column);
    n = 0;
    for (const BlockId block : blocks) {
        const Eigen::Index size = mean(block).size();
        if (isTarget(block)) out.block(n, n, size, size) = covariance(block, block);
        n += size;
    }
    return out;
}

}  // namespace slamot
