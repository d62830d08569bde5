#include "slamot/core/estimation/BankedImm.h"

#include <algorithm>

#include "slamot/core/estimation/RangeBearingUpdate.h"
#include "slamot/core/estimation/RobotTargetView.h"

namespace slamot {
namespace {

/// A mover's modes, each merged over the modes of the others.
TargetBank bankFrom(const JointImm& exact, std::size_t t) {
    const BlockId target = exact.targets()[t];
    const Eigen::VectorXd mu = exact.target(target).mode_probabilities;
    std::vector<TargetGaussian> modes;
    for (int j = 0; j < mu.size(); ++j) {
        Eigen::VectorXd weights = exact.probabilities();
        for (int i = 0; i < weights.size(); ++i)
            if (mu(j) > 0 && exact.modeOf(i, t) != j) weights(i) = 0;
        weights /= weights.sum();
        const CombinedView mode(exact.bank(), weights);
        modes.push_back({mode.mean(target), mode.covariance(target, target)});
    }
    TargetBank bank(mu, std::move(modes));
    bank.synchronise({exact.mean(target), exact.covariance(target, target)});
    return bank;
}

}  // namespace

BankedImm::BankedImm(std::shared_ptr<const ModalSettings> settings, JointImm&& exact)
    : ModalState(std::move(settings), nullptr) {
    for (std::size_t t = 0; t < exact.targets().size(); ++t)
        targets_.emplace_back(exact.targets()[t], bankFrom(exact, t));
    bank_ = exact.releaseMerged();
}

TargetGaussian BankedImm::marginal(BlockId target) const {
    return {mean(target), covariance(target, target)};
}

std::size_t BankedImm::indexOf(BlockId target) const {
    std::size_t t = 0;
    while (targets_.at(t).first != target) ++t;
    return t;
}

void BankedImm::predict(const OdometryIncrement& odometry, const std::vector<TargetModel>& models) {
    JointMode& joint = bank_->mode(0);
    const MotionPrediction robot = predictMotion(settings().motion, joint.mean(robot_block), odometry);
    joint.propagate(robot_block, robot.pose, robot.F, robot.Q);

    const Eigen::MatrixXd p = settings().chain.over(odometry.seconds());
    for (auto& [target, bank] : targets_) {
        const BlockPrediction motion = bank.predict(p, models, odometry.seconds(), joint.mean(target));
        joint.propagate(target, motion.mean, motion.Phi, motion.Q);
        bank.takeSnapshot(marginal(target));
    }
}

void BankedImm::update(const RangeBearingSet& seen, const KnownObjects& known,
                       std::vector<Innovation>& innovations) {
    update_by_landmarks_(bank_->mode(0), bank_->consistency(), settings().gate, seen, known.landmarks,
                         innovations);
    updateByTargets(seen, known, innovations);
    synchronise();
}

BlockId BankedImm::addLandmark(const std::vector<PastSight>& sights, double gate) {
    const BlockId landmark = ModalState::addLandmark(sights, gate);
    synchronise();
    return landmark;
}

void BankedImm::mergeLandmarks(BlockId kept, BlockId gone, double deviation) {
    ModalState::mergeLandmarks(kept, gone, deviation);
    synchronise();
}

void BankedImm::synchronise() {
    for (auto& [target, bank] : targets_) bank.synchronise(marginal(target));
}

void BankedImm::updateByTargets(const RangeBearingSet& seen, const KnownObjects& known,
                                std::vector<Innovation>& innovations) {
    batch_.clear();
    for (const auto& sight : known.targets) {
        const bool again = std::any_of(batch_.begin(), batch_.end(), [&](const LinearMeasurement& m) {
            return m.terms[1].block == sight.block;
        });
        if (again) updateJoint();
        measure(seen, sight, innovations[sight.detection]);
    }
    updateJoint();
}

void BankedImm::measure(const RangeBearingSet& seen, const KnownObjects::Sight& sight,
                        Innovation& innovation) {
    const JointMode& joint = bank_->mode(0);
    TargetBank& bank = targets_[indexOf(sight.block)].second;
    const RangeBearingDetection& detection = seen.detections[sight.detection];
    const Pose2& sensor = seen.sensors[detection.sensor].pose;

    bank.synchronise(marginal(sight.block));
    const RobotGivenTarget robot(joint, sight.block);
    bank.linearise(robot, detection, sensor, bank_->consistency(), linear_);
    const Matrix2 more_noise = gateOf(sight).judge(bank.probabilities(), linear_, detection, innovation);
    if (innovation.outcome == Outcome::rejected) return;
    for (Linearisation& mode : linear_) mode.measurement.R += more_noise;
    bank.update(robot, linear_, bank_->consistency());

    batch_.push_back(linearise(joint, sight.block, detection, sensor, bank_->consistency()).measurement);
    batch_.back().R += more_noise;
    // The bank has made this measurement's change of the joint block itself, and no other's.
    RobotTargetView own = robot.with(marginal(sight.block));
    own.update(batch_.back(), bank_->consistency());
    bank.takeSnapshot(own.target());
}

void BankedImm::updateJoint() {
    bank_->mode(0).update(batch_);
    for (const LinearMeasurement& measurement : batch_) {
        const BlockId target = measurement.terms[1].block;
        TargetBank& bank = targets_[indexOf(target)].second;
        bank.synchronise(marginal(target));
        bank.guard(marginal(target));
    }
    batch_.clear();
}

BlockId BankedImm::addTarget(const RelativeGaussian& target) {
    const BlockId block = bank_->augment(BlockKind::target, byMode(target));
    const Eigen::VectorXd& initial = settings().initial;
    targets_.emplace_back(
        block, TargetBank(initial, std::vector<TargetGaussian>(static_cast<std::size_t>(initial.size()),
                                                               marginal(block))));
    return block;
}

void BankedImm::removeTarget(BlockId target) {
    bank_->remove(target);
    targets_.erase(targets_.begin() + static_cast<std::ptrdiff_t>(indexOf(target)));
}

void BankedImm::widenTarget(BlockId target, const Matrix6& Q) {
    bank_->mode(0).propagate(target, mean(target), Matrix6::Identity(), Q);
    TargetBank& bank = targets_[indexOf(target)].second;
    bank.widen(Q);
    bank.takeSnapshot(marginal(target));
}

TargetBelief BankedImm::target(BlockId target) const {
    const TargetBank& bank = targets_[indexOf(target)].second;
    const TargetGaussian merged = bank.merged();
    return {merged.mean, merged.covariance, bank.probabilities()};
}

}  // namespace slamot
