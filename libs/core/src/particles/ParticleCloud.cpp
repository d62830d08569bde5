#include "slamot/core/particles/ParticleCloud.h"

#include <algorithm>
#include <cmath>

namespace slamot {

void describe(ParticleParameters& p, ParameterTable& table) {
    table.integer("particles", p.count, Interval::between(1, 100000), "Number of particles.")
        .choice("resampling", p.resampling,
                {{"systematic", Resampling::systematic}, {"residual", Resampling::residual}},
                "systematic: one random number for all; residual: whole copies first, the rest by chance.")
        .real("resample_below", p.resample_below, "-", Interval::between(0, 1),
              "Resample when the effective number of particles falls below this part of them.");
}

ParticleCloud::ParticleCloud(const ParticleParameters& parameters, const RobotMotionParameters& motion)
    : parameters_(parameters), motion_(motion) {}

void ParticleCloud::start(const PoseGaussian& pose, std::uint64_t seed) {
    seed_ = seed;
    step_ = 0;
    weights_ = ParticleWeights(parameters_.count);
    poses_.assign(static_cast<std::size_t>(parameters_.count), {pose.mean.vector(), factorOf(pose.covariance)});
    if (refines()) return;
    for (int i = 0; i < count(); ++i) {
        RandomStream random = proposalStream(i);
        place(i, RefinedPose(this->pose(i)).draw(random).pose);
    }
}

RandomStream ParticleCloud::proposalStream(int i) const {
    return RandomStream(seed_, RandomPurpose::proposal, 0, step_, static_cast<std::uint32_t>(i));
}

void ParticleCloud::predict(const OdometryIncrement& odometry, Workers& workers) {
    ++step_;
    const MotionControl control = controlOf(motion_, odometry);
    const Matrix3 control_factor = factorOf(control.covariance);
    const double dt = odometry.seconds();
    workers.forRanges(count(), [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            PoseBelief& pose = poses_[static_cast<std::size_t>(i)];
            if (refines()) {
                pose = predicted(pose, motion_, control, dt, parameters_.transform);
            } else {
                RandomStream random = proposalStream(i);
                pose.mean = drawnMove(pose.mean, motion_, control, control_factor, dt, random);
            }
        }
    });
}

bool ParticleCloud::weigh(const std::vector<double>& log_likelihoods) {
    ++step_;
    return weights_.multiply(log_likelihoods);
}

std::vector<int> ParticleCloud::resample() {
    if (weights_.effectiveCount() >= parameters_.resample_below * count()) return {};
    RandomStream random(seed_, RandomPurpose::resampling, 0, step_);
    std::vector<int> parents = weights_.resampled(parameters_.resampling, random);
    std::vector<PoseBelief> children;
    children.reserve(poses_.size());
    for (const int parent : parents) children.push_back(pose(parent));
    poses_ = std::move(children);
    // Its map goes on to be what is told.
    const auto heir = std::lower_bound(parents.begin(), parents.end() - 1, weights_.best());
    weights_.setEqual(static_cast<int>(heir - parents.begin()));
    return parents;
}

PoseGaussian ParticleCloud::robot() const {
    // Differences to one particle are small unless the cloud is all around: means of angles need no more.
    const Vector3 centre = poses_.front().mean;
    const auto apart = [&](const PoseBelief& pose) {
        Vector3 d = pose.mean - centre;
        d.z() = wrapAngle(d.z());
        return d;
    };
    Vector3 shift = Vector3::Zero();
    for (int i = 0; i < count(); ++i) shift += weights_[i] * apart(pose(i));
    Matrix3 P = Matrix3::Zero();
    for (int i = 0; i < count(); ++i) {
        const Vector3 d = apart(pose(i)) - shift;
        P += weights_[i] * (d * d.transpose() + pose(i).covariance());
    }
    return {Pose2::fromVector(centre + shift), P};
}

std::vector<ParticleEstimate> ParticleCloud::particles() const {
    std::vector<ParticleEstimate> out;
    out.reserve(poses_.size());
    for (int i = 0; i < count(); ++i)
        out.push_back({weights_[i], {Pose2::fromVector(pose(i).mean), pose(i).covariance()}});
    return out;
}

}  // namespace slamot
