#include "slamot/core/estimation/JointImm.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/KroneckerProduct>

#include "slamot/core/estimation/RangeBearingUpdate.h"

namespace slamot {

JointImm::JointImm(std::shared_ptr<const ModalSettings> settings, std::unique_ptr<JointBank> bank)
    : ModalState(std::move(settings), std::move(bank)) {}

// --- one step: paper 1, section 2.3
// ------------------------------------------------------------------------------

void JointImm::predict(const OdometryIncrement& odometry, const std::vector<TargetModel>& models) {
    mix(odometry.seconds());
    for (int j = 0; j < bank_->modeCount(); ++j) {  // eq. 50, 51
        JointMode& mode = bank_->mode(j);
        const MotionPrediction robot = predictMotion(settings().motion, mode.mean(robot_block), odometry);
        mode.propagate(robot_block, robot.pose, robot.F, robot.Q);
        for (std::size_t t = 0; t < targets_.size(); ++t) {
            const TargetModel& model = models[static_cast<std::size_t>(modeOf(j, t))];
            const TargetPrediction target = predictTarget(model, mode.mean(targets_[t]), odometry.seconds());
            mode.propagate(targets_[t], target.mean, target.F, target.Q);
        }
    }
}

void JointImm::mix(double dt) {
    if (mu_.size() == 1) return;
    // Movers change their modes each for itself: the transition of combinations is a Kronecker product.
    const Eigen::MatrixXd p_target = settings().chain.over(dt);
    Eigen::MatrixXd p = p_target;
    for (std::size_t t = 1; t < targets_.size(); ++t) p = Eigen::kroneckerProduct(p, p_target).eval();

    regroup(mu_.asDiagonal() * p);  // eq. 48, 49
}

void JointImm::regroup(const Eigen::MatrixXd& weights) {
    // c_j = sum_i p_ij mu_i, mu_i|j = p_ij mu_i / c_j
    const Eigen::VectorXd c = weights.colwise().sum();
    Eigen::MatrixXd mu_given(weights.rows(), weights.cols());
    for (Eigen::Index j = 0; j < c.size(); ++j) {
        mu_given.col(j) = weights.col(j) / c(j);
        if (c(j) == 0) mu_given.col(j) = mu_;  // a mode that nothing leads to: any distribution serves
    }
    bank_->mix(mu_given);
    mu_ = c / c.sum();
}

void JointImm::update(const RangeBearingSet& seen, const KnownObjects& known,
                      std::vector<Innovation>& innovations) {
    // All measurements are linearised at the predicted state; the movers' come last.
    batches_.resize(static_cast<std::size_t>(mu_.size()));
    for (auto& batch : batches_) batch.clear();
    for (const auto& sight : known.landmarks) addToBatches(seen, sight, innovations[sight.detection]);
    const int landmark_rows = LinearMeasurement::rows * static_cast<int>(batches_.front().size());
    for (const auto& sight : known.targets) addToBatches(seen, sight, innovations[sight.detection]);

    log_mu_.resize(mu_.size());
    for (int j = 0; j < bank_->modeCount(); ++j) {
        const BatchLikelihood batch =
            bank_->mode(j).update(batches_[static_cast<std::size_t>(j)]);  // eq. 52, 53
        const int target_rows = batch.rows() - landmark_rows;
        const double log_Lambda = settings().likelihood == ModeLikelihood::conditional
                                      ? batch.logConditional(landmark_rows, target_rows)
                                      : batch.logMarginal(landmark_rows, target_rows);
        log_mu_(j) = std::log(mu_(j)) + log_Lambda;  // eq. 54, where mu_ still is c
    }
    if (!(log_mu_.maxCoeff() > -std::numeric_limits<double>::infinity()))
        return;  // equally impossible in all modes
    mu_ = (log_mu_.array() - log_mu_.maxCoeff()).exp();
    mu_ /= mu_.sum();
}

void JointImm::addToBatches(const RangeBearingSet& seen, const KnownObjects::Sight& sight,
                            Innovation& innovation) {
    const RangeBearingDetection& detection = seen.detections[sight.detection];
    linear_.clear();
    for (int j = 0; j < bank_->modeCount(); ++j)
        linear_.push_back(linearise(bank_->mode(j), sight.block, detection,
                                    seen.sensors[detection.sensor].pose, bank_->consistency()));
    const Matrix2 more_noise = gateOf(sight).judge(mu_, linear_, detection, innovation);
    if (innovation.outcome == Outcome::rejected) return;
    for (std::size_t j = 0; j < linear_.size(); ++j) {
        linear_[j].measurement.R += more_noise;
        batches_[j].push_back(linear_[j].measurement);
    }
}

// --- objects that come and go
// ------------------------------------------------------------------------------------

BlockId JointImm::addTarget(const RelativeGaussian& target) {
    const Eigen::VectorXd& initial = settings().initial;
    if (initial.size() > 1)  // every combination with every mode of the new mover
        regroup(Eigen::kroneckerProduct(Eigen::MatrixXd(mu_.asDiagonal()), initial.transpose()).eval());
    targets_.push_back(bank_->augment(BlockKind::target, byMode(target)));
    return targets_.back();
}

void JointImm::removeTarget(BlockId target) {
    const auto gone = std::find(targets_.begin(), targets_.end(), target);
    const auto t = static_cast<std::size_t>(gone - targets_.begin());
    bank_->remove(target);
    if (settings().chain.modes() > 1) {
        // Combinations that differ in the gone mover's mode only become one.
        const int n = settings().chain.modes(), M = static_cast<int>(mu_.size());
        int faster = 1;
        for (std::size_t later = t + 1; later < targets_.size(); ++later) faster *= n;
        Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(M, M / n);
        for (int i = 0; i < M; ++i) weights(i, i / (faster * n) * faster + i % faster) = mu_(i);
        regroup(weights);
    }
    targets_.erase(gone);
}

void JointImm::widenTarget(BlockId target, const Matrix6& Q) {
    for (int j = 0; j < bank_->modeCount(); ++j)
        bank_->mode(j).propagate(target, bank_->mode(j).mean(target), Matrix6::Identity(), Q);
}

int JointImm::modeOf(int combination, std::size_t target) const {
    const int n = settings().chain.modes();
    for (std::size_t later = target + 1; later < targets_.size(); ++later) combination /= n;
    return combination % n;
}

std::unique_ptr<JointBank> JointImm::releaseMerged() {
    if (mu_.size() > 1) bank_->mix(mu_);
    return std::move(bank_);
}

// --- estimates: eq. 55, 56
// ---------------------------------------------------------------------------------------

BlockVector JointImm::mean(BlockId block) const {
    return mu_.size() == 1 ? bank_->mode(0).mean(block) : CombinedView(*bank_, mu_).mean(block);
}

BlockMatrix JointImm::covariance(BlockId a, BlockId b) const {
    return mu_.size() == 1 ? bank_->mode(0).covariance(a, b) : CombinedView(*bank_, mu_).covariance(a, b);
}

Eigen::MatrixXd JointImm::jointCovariance(const std::vector<BlockId>& blocks) const {
    return mu_.size() == 1 ? bank_->mode(0).jointCovariance(blocks)
                           : CombinedView(*bank_, mu_).jointCovariance(blocks);
}

TargetBelief JointImm::target(BlockId target) const {
    TargetBelief out{mean(target), covariance(target, target),
                     Eigen::VectorXd::Zero(settings().chain.modes())};
    const auto t =
        static_cast<std::size_t>(std::find(targets_.begin(), targets_.end(), target) - targets_.begin());
    for (int i = 0; i < mu_.size(); ++i) out.mode_probabilities(modeOf(i, t)) += mu_(i);
    return out;
}

}  // namespace slamot
