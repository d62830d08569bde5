#include "slamot/core/particles/TargetParticles.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace slamot {

// --- moments
// ---------------------------------------------------------------------------------------------------

MergedTargets::Rows MergedTargets::rowsOf(BlockId block) const {
    if (block == robot_block) return {0, 3};
    const auto found = std::find(targets_.begin(), targets_.end(), block);
    if (found == targets_.end()) throw std::out_of_range("MergedTargets: no such mover");
    return {3 + 6 * (found - targets_.begin()), 6};
}

BlockVector MergedTargets::mean(BlockId block) const {
    const Rows rows = rowsOf(block);
    return mean_.segment(rows.first, rows.count);
}

BlockMatrix MergedTargets::covariance(BlockId a, BlockId b) const {
    const Rows rows = rowsOf(a), columns = rowsOf(b);
    return P_.block(rows.first, columns.first, rows.count, columns.count);
}

Eigen::MatrixXd MergedTargets::jointCovariance(const std::vector<BlockId>& blocks) const {
    std::vector<Eigen::Index> all;
    for (const BlockId block : blocks) {
        const Rows rows = rowsOf(block);
        for (Eigen::Index k = 0; k < rows.count; ++k) all.push_back(rows.first + k);
    }
    return P_(all, all);
}

MergedTargets TargetParticles::merged() const {
    const ParticleCloud& cloud = particles_.cloud();
    const auto dimension = static_cast<Eigen::Index>(3 + 6 * targets_.size());
    // Differences to the first particle: headings are numbers then.
    Eigen::MatrixXd apart(dimension, cloud.count());
    Eigen::VectorXd weights(cloud.count()), first(dimension);
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(dimension, dimension);
    for (int i = 0; i < cloud.count(); ++i) {
        const double w = weights(i) = cloud.weights()[i];
        const std::vector<TargetFilter>& targets = particles_.map(i).targets();
        apart.col(i).head<3>() = cloud.pose(i).mean;
        P.topLeftCorner<3, 3>() += w * cloud.pose(i).covariance();
        for (std::size_t t = 0; t < targets.size(); ++t) {
            const auto at = static_cast<Eigen::Index>(3 + 6 * t);
            const TargetGaussian mover = targets[t].merged(settings_.targets);
            apart.col(i).segment<6>(at) = mover.mean;
            P.block<6, 6>(at, at) += w * mover.covariance;
        }
        if (i == 0) first = apart.col(0);
        apart.col(i) -= first;
        apart(2, i) = wrapAngle(apart(2, i));
    }
    const Eigen::VectorXd shift = apart * weights;
    apart.colwise() -= shift;
    P += apart * weights.asDiagonal() * apart.transpose();
    Eigen::VectorXd mean = first + shift;
    mean(2) = wrapAngle(mean(2));
    return {targets_, mean, 0.5 * (P + P.transpose())};
}

TargetBelief TargetParticles::target(BlockId target) const {
    const std::size_t t = indexOf(target);
    const ParticleCloud& cloud = particles_.cloud();
    Eigen::VectorXd weights(cloud.count());
    std::vector<TargetGaussian> by_particle;
    by_particle.reserve(static_cast<std::size_t>(cloud.count()));
    Eigen::VectorXd mu = Eigen::VectorXd::Zero(settings_.targets.initial.size());
    for (int i = 0; i < cloud.count(); ++i) {
        const TargetFilter& filter = particles_.map(i).targets()[t];
        weights(i) = cloud.weights()[i];
        by_particle.push_back(filter.merged(settings_.targets));
        if (settings_.targets.drive == TargetDrive::modes) mu += weights(i) * filter.probabilities();
    }
    const TargetGaussian all = mixture(weights, by_particle);
    return {all.mean, all.covariance, mu};
}

// --- one step
// ---------------------------------------------------------------------------------------------------

TargetParticles::TargetParticles(const ParticleParameters& parameters, const RobotMotionParameters& motion,
                                 const LandmarksAndTargets::Settings& settings, const ScanMaker& scans,
                                 bool weigh_targets, int threads)
    : settings_(settings),
      weigh_targets_(weigh_targets),
      particles_(parameters, motion, settings, scans, threads) {}

void TargetParticles::start(const PoseGaussian& pose, std::uint64_t seed) {
    particles_.start(pose, seed);
    scan_ = {};
    targets_.clear();
    last_target_ = robot_block;
}

void TargetParticles::predict(const OdometryIncrement& odometry) {
    particles_.predict(odometry);
    if (targets_.empty()) return;
    const TargetStep step(settings_.targets, odometry.seconds());
    particles_.forEachParticle([&](int, LandmarksAndTargets& map, const PoseBelief&) {
        for (TargetFilter& target : map.targets()) target.predict(settings_.targets, step);
    });
}

UpdateReport TargetParticles::updateByLandmarks(const DetectionSet& set, bool fixes_poses,
                                                const std::map<BlockId, double>& visible) {
    scan_ = particles_.scans().scan(set);
    scan_.fixes_poses = fixes_poses;
    for (const BlockId target : targets_) {
        const auto known = visible.find(target);
        scan_.visible_movers.push_back(known == visible.end() ? 1 : known->second);
    }
    return particles_.look(scan_, set.rangeBearing());
}

std::vector<LandmarkVerdict> TargetParticles::landmarkVerdicts() const {
    std::vector<LandmarkVerdict> out;
    const ParticleCloud& cloud = particles_.cloud();
    for (std::size_t s = 0; s < scan_.sights.size(); ++s) {
        if (!scan_.sights[s].may_be_mover) continue;
        double new_weight = 0, explained = 0;
        std::map<LandmarkId, double> votes;
        for (int i = 0; i < cloud.count(); ++i) {
            const SightRecord& record = particles_.records(i)[s];
            // A mover's part is not in their weights yet: those before the scan are fair to both.
            const double w = particles_.weightsBefore()[i];
            if (record.may_be_new) new_weight += w;
            if (!record.landmark.valid()) continue;
            explained += w;
            votes[record.landmark] += w;
        }
        LandmarkVerdict verdict{scan_.sights[s].detection, {}, explained > 0.5, new_weight > 0.5};
        for (const auto& [landmark, weight] : votes)
            if (weight > 0.5) verdict.landmark = landmark;
        out.push_back(verdict);
    }
    return out;
}

bool TargetParticles::landmarkTook(int particle, int detection) const {
    for (std::size_t s = 0; s < scan_.sights.size(); ++s)
        if (scan_.sights[s].detection == detection) return particles_.records(particle)[s].landmark.valid();
    return false;
}

void TargetParticles::updateByTargets(const std::vector<TargetDetection>& detections) {
    if (detections.empty()) return;
    std::vector<std::size_t> targets;
    for (const TargetDetection& detection : detections) targets.push_back(indexOf(detection.target));
    std::vector<double> log_likelihoods(static_cast<std::size_t>(particles_.cloud().count()), 0);
    particles_.forEachParticle([&](int i, LandmarksAndTargets& map, const PoseBelief& pose) {
        for (std::size_t k = 0; k < detections.size(); ++k) {
            const TargetDetection& d = detections[k];
            if (landmarkTook(i, d.detection)) {  // a detection has one source: the mover was missed
                log_likelihoods[static_cast<std::size_t>(i)] +=
                    std::log1p(-d.detection_probability * d.visible);
                continue;
            }
            const double log_N = map.targets()[targets[k]].update(settings_.targets, pose.mean, d.sight);
            // The mover is detected, or it is not and this is something else (eq. 11: a mover's own factor
            // alone).
            log_likelihoods[static_cast<std::size_t>(i)] +=
                d.named
                    ? log_N
                    : std::log(d.detection_probability * d.visible * (std::exp(log_N) / d.unexplained - 1) +
                               1);
        }
    });
    if (weigh_targets_) particles_.weigh(log_likelihoods);
}

// --- what comes and goes
// ---------------------------------------------------------------------------------------------------

BlockId TargetParticles::addTarget(const RelativeGaussian& target) {
    particles_.forEachParticle([&](int, LandmarksAndTargets& map, const PoseBelief& pose) {
        map.targets().emplace_back(settings_.targets, target, pose.mean);
    });
    targets_.push_back(++last_target_);
    return last_target_;
}

LandmarkId TargetParticles::addLandmark(const std::vector<TentativeSight>& sights, double gate,
                                        LandmarkFilter landmark) {
    landmark.id = particles_.scans().freshNumber();
    std::vector<double> log_likelihoods(static_cast<std::size_t>(particles_.cloud().count()), 0);
    particles_.forEachParticle([&](int i, LandmarksAndTargets& map, const PoseBelief&) {
        LandmarkFilter mine = landmark;
        mine.point = map.pointOf(settings_, sights, gate, log_likelihoods[static_cast<std::size_t>(i)]);
        map.landmarks().add(mine);
    });
    if (sights.size() > 1) particles_.weigh(log_likelihoods);
    return landmark.id;
}

void TargetParticles::removeTarget(BlockId target) {
    const auto t = static_cast<std::ptrdiff_t>(indexOf(target));
    particles_.forEachParticle([&](int, LandmarksAndTargets& map, const PoseBelief&) {
        map.targets().erase(map.targets().begin() + t);
    });
    targets_.erase(targets_.begin() + t);
}

void TargetParticles::removeLandmark(LandmarkId landmark) {
    particles_.forEachParticle(
        [&](int, LandmarksAndTargets& map, const PoseBelief&) { map.landmarks().remove(landmark); });
}

TargetParticles::FoundLandmark TargetParticles::findMostly(LandmarkId landmark) const {
    const ParticleCloud& cloud = particles_.cloud();
    FoundLandmark found{nullptr, Vector3::Zero()};
    double weight = 0, heaviest = -1;
    for (int i = 0; i < cloud.count(); ++i) {
        const LandmarkFilter* here = particles_.map(i).find(landmark);
        if (!here) continue;
        weight += cloud.weights()[i];
        if (cloud.weights()[i] <= heaviest) continue;
        heaviest = cloud.weights()[i];
        found = {here, cloud.pose(i).mean};
    }
    return weight > 0.5 ? found : FoundLandmark{nullptr, Vector3::Zero()};
}

std::size_t TargetParticles::indexOf(BlockId target) const {
    const auto found = std::find(targets_.begin(), targets_.end(), target);
    if (found == targets_.end()) throw std::out_of_range("TargetParticles: no such mover");
    return static_cast<std::size_t>(found - targets_.begin());
}

}  // namespace slamot
