// Which tiles of a PassiveMap are near, and what is known of the others together.
#include <algorithm>
#include <cmath>

#include "slamot/core/estimation/PassiveMap.h"
#include "slamot/core/estimation/TurningBasis.h"

namespace slamot {
namespace {

/// Tiles whose centre lies farther away, in reaches of the sensors, are far; grouped anew after half the way
/// that could bring a landmark of one within reach.
constexpr double far_distance = 5.0;
constexpr double regroup_after = 2.0;
constexpr double latest = 1.25;  // of that, whatever else there is to do
/// Directions that carry less than this part of a standard deviation, in the root mean square over all
/// landmarks, are left out. What the engine says differs from what the dense one says by some ten times as
/// much.
constexpr double tolerance = 2e-12;
/// What the end of a group leaves out, in parts of a variance.
constexpr double negligible = 1e-12;

}  // namespace

Vector2 PassiveMap::Tile::centre() const {
    return Eigen::Map<const Eigen::Matrix2Xd>(mean.data(), 2, mean.size() / 2).rowwise().mean();
}

double PassiveMap::negligibleLength() const {
    return tolerance * landmark_std_ * std::sqrt(2.0 * size());
}

std::vector<char> PassiveMap::farFrom(const std::vector<Vector2>& places) const {
    std::vector<char> far(tiles_.size());
    for (int t = 0; t < tileCount(); ++t) {
        if (!used(t)) continue;
        const Vector2 centre = tile(t).centre();
        far[static_cast<std::size_t>(t)] = std::all_of(
            places.begin(), places.end(),
            [&](const Vector2& place) { return (centre - place).norm() > far_distance * reach_; });
    }
    return far;
}

void PassiveMap::follow(const Vector2& robot, double reach, bool busy) {
    reach_ = reach;
    if (size() == 0) return;
    if (grouped_at_ && (robot - *grouped_at_).norm() < regroup_after * reach * (busy ? latest : 1)) return;
    grouped_at_ = robot;
    const std::vector<char> far = farFrom({robot});
    bool any = false;
    for (int t = 0; t < tileCount(); ++t)
        any |= used(t) && (far[static_cast<std::size_t>(t)] != 0 || tile(t).far);
    if (any) regroup(far);
}

void PassiveMap::regroup(const std::vector<char>& far) {
    ++regroupings_;

    FarGroup next;
    next.parts.resize(tiles_.size());
    std::vector<int> staying, joining;  // far tiles
    CutRowsView V;
    for (int t = 0; t < tileCount(); ++t) {
        if (!used(t)) continue;
        Tile& own = tile(t);
        const bool was_far = own.far;
        own.far = far[static_cast<std::size_t>(t)];
        next.part(t).far = own.far;
        if (was_far) own.mean.noalias() += group_.part(t).V.transpose() * group_.shift;
        if (was_far && !own.far) own.X = product(group_.W, group_.part(t).V);
        if (own.far) (was_far ? staying : joining).push_back(t);
        if (own.far && was_far) V.push_back(&group_.part(t).V);
    }

    // [W X] of those that stay and those that join = W' K, in few rows of K; V' = K [V 0; 0 I].
    const OrthonormalRows stayed(group_.W, V, negligibleLength());
    int columns = stayed.rank();
    for (const int t : joining) columns += tile(t).width();
    Eigen::MatrixXd M(group_.W.rows(), columns);
    M.leftCols(stayed.rank()) = stayed.W();
    columns = stayed.rank();
    for (const int t : joining) {
        M.middleCols(columns, tile(t).width()) = tile(t).X;
        columns += tile(t).width();
    }
    const Eigen::MatrixXd K = turningBasis(M, negligibleLength());
    CutRows turned = stayed.times(K.leftCols(stayed.rank()));
    for (std::size_t i = 0; i < staying.size(); ++i) next.part(staying[i]).V.swap(turned[i]);
    columns = stayed.rank();
    for (const int t : joining) {
        next.part(t).V = K.middleCols(columns, tile(t).width());
        columns += tile(t).width();
        tile(t).X.resize(0, 0);
    }
    next.W = productTransposed(M, K);
    next.zeta = Eigen::MatrixXd::Zero(next.rank(), next.rank());
    next.shift = Eigen::VectorXd::Zero(next.rank());
    for (int t = 0; t < tileCount(); ++t)
        if (!tile(t).far) next.part(t).C = Eigen::MatrixXd::Zero(tile(t).width(), next.rank());

    const WaitingTerm two_far = group_.aboutTwoFar(negligible * landmark_std_ * landmark_std_);
    covariance_.addWaiting(group_.takeNearAndFar(), two_far);
    std::swap(group_, next);
    landmark_std_ = covariance_.longestStd();
}

}  // namespace slamot
