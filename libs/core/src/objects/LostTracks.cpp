#include "slamot/core/objects/LostTracks.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>

namespace slamot {
namespace {

using Vector4 = Eigen::Vector4d;
using Matrix4 = Eigen::Matrix4d;

/// Squared distance of [p v] of two independent estimates.
double distance(const Vector6& a, const Matrix6& P_a, const Vector6& b, const Matrix6& P_b) {
    const Vector4 difference = a.head<4>() - b.head<4>();
    const Matrix4 S = P_a.topLeftCorner<4, 4>() + P_b.topLeftCorner<4, 4>();
    const Eigen::LLT<Matrix4> factor(S);
    if (factor.info() != Eigen::Success)
        throw std::domain_error("LostTracks: covariance of position and velocity is not positive definite");
    return difference.dot(factor.solve(difference));
}

}  // namespace

LostTracks::LostTracks(double gate_probability, double keep_for)
    : gate_(chiSquareQuantile(gate_probability, 4)), keep_for_(keep_for) {}

void LostTracks::forgetOld(Stamp now) {
    tracks_.erase(
        std::remove_if(tracks_.begin(), tracks_.end(),
                       [&](const LostTrack& lost) { return secondsBetween(lost.at, now) > keep_for_; }),
        tracks_.end());
}

void LostTracks::predict(double dt, const TargetModel& model) {
    for (LostTrack& lost : tracks_) {
        const TargetPrediction f = predictTarget(model, lost.mean, dt);
        lost.mean = f.mean;
        lost.covariance = f.F * lost.covariance * f.F.transpose() + f.Q;
    }
}

std::optional<TrackId> LostTracks::continuedBy(const Vector6& mean, const Matrix6& covariance) {
    auto found = tracks_.end();
    for (auto lost = tracks_.begin(); lost != tracks_.end(); ++lost) {
        if (!(distance(lost->mean, lost->covariance, mean, covariance) <= gate_)) continue;
        if (found != tracks_.end()) return std::nullopt;
        found = lost;
    }
    if (found == tracks_.end()) return std::nullopt;
    const TrackId id = found->id;
    tracks_.erase(found);
    return id;
}

}  // namespace slamot
