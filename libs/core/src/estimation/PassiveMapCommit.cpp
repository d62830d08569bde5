// A new base for a PassiveMap, and landmarks that are put away.
#include "slamot/core/estimation/PassiveMap.h"

namespace slamot {
namespace {

constexpr int tile_landmarks = 50;   // at most, in one tile
constexpr double tile_radius = 1.0;  // reaches of the sensors: how far from a tile's centre a member may lie

}  // namespace

void PassiveMap::commit(const Commit& commit) {
    forgetPrepared();
    addTerm(commit.Psi);

    // The new base, and what the landmarks that are put away have to do with those that are away.
    std::vector<int> first_column(tiles_.size());
    int columns = 0;
    for (int t = 0; t < tileCount(); ++t) {
        first_column[static_cast<std::size_t>(t)] = columns;
        if (!tile(t).far) columns += tile(t).width();
    }
    Eigen::MatrixXd near_rows(commit.Phi.rows(), columns);
    for (int t = 0; t < tileCount(); ++t) {
        Tile& own = tile(t);
        if (own.far || !used(t)) continue;
        multiply(commit.Phi, own.X,
                 near_rows.middleCols(first_column[static_cast<std::size_t>(t)], own.width()));
        own.mean.noalias() += own.X.transpose() * commit.eta;
        own.X = withTurned(product(commit.rows, own.X));
    }
    const Eigen::MatrixXd far_rows = product(commit.Phi, group_.W);
    if (group_.rank() > 0) group_.shift.noalias() += group_.W.transpose() * commit.eta;
    group_.W = withTurned(product(commit.rows, group_.W));
    q_ = (turning_ ? 2 : 1) * static_cast<int>(commit.rows.rows());

    append(commit, near_rows, far_rows, first_column);
    landmark_std_ = covariance_.longestStd();
}

void PassiveMap::addTerm(const Eigen::MatrixXd& Psi) {
    const Eigen::MatrixXd Psi_W = product(Psi, group_.W);
    for (int t = 0; t < tileCount(); ++t) {
        if (tile(t).far || !used(t)) continue;
        const Eigen::MatrixXd Psi_X = product(Psi, tile(t).X);
        for (int s = 0; s <= t; ++s)
            if (used(s) && !tile(s).far) covariance_.addProduct(s, t, tile(s).X, Psi_X);
        addTransposedProduct(tile(t).X, Psi_W, group_.part(t).C);
    }
    addTransposedProduct(group_.W, Psi_W, group_.zeta);
}

void PassiveMap::append(const Commit& commit, const Eigen::MatrixXd& near_rows,
                        const Eigen::MatrixXd& far_rows, const std::vector<int>& first_column) {
    // Landmarks of the commit, by the tile they are in by now.
    std::vector<std::vector<int>> late(tiles_.size());
    for (int j = 0; j < static_cast<int>(commit.landmarks.size()); ++j) {
        const int t = tileFor(commit.mean.segment<2>(2 * j));
        late.resize(tiles_.size());
        Tile& own = tile(t);
        const int width = own.width();
        const auto rows = near_rows.middleRows<2>(2 * j);
        for (int s = 0; s < tileCount(); ++s) {
            if (!used(s) || tile(s).far) continue;
            // First the landmarks that were away before, then those of this commit.
            const std::vector<int> others = coordinatesOf(late[static_cast<std::size_t>(s)]);
            const int after = static_cast<int>(others.size()), before = tile(s).width() - after;
            Eigen::MatrixXd P(2, before + after);
            if (before > 0)
                P.leftCols(before) = rows.middleCols(first_column[static_cast<std::size_t>(s)], before);
            P.rightCols(after) = commit.covariance.middleRows<2>(2 * j)(Eigen::all, others);
            covariance_.add(s, 0, t, width, P.transpose());
            if (s == t) covariance_.add(t, width, t, 0, P);
        }
        covariance_.add(t, width, t, width, commit.covariance.block<2, 2>(2 * j, 2 * j));

        own.X.conservativeResize(q_, width + 2);
        own.X.rightCols<2>() = withTurned(commit.base.middleCols<2>(2 * j));
        own.mean.conservativeResize(width + 2);
        own.mean.tail<2>() = commit.mean.segment<2>(2 * j);
        FarGroup::Part& part = group_.part(t);
        part.C.conservativeResize(width + 2, group_.rank());
        part.C.bottomRows<2>() = far_rows.middleRows<2>(2 * j);
        own.landmarks.push_back(commit.landmarks[static_cast<std::size_t>(j)]);
        late[static_cast<std::size_t>(t)].push_back(j);
        index(t);
    }
}

int PassiveMap::tileFor(const Vector2& position) {
    int best = -1, free = -1;
    double best_distance = std::numeric_limits<double>::infinity();
    for (int t = 0; t < tileCount(); ++t) {
        const Tile& own = tile(t);
        if (!used(t)) free = t;
        if (!used(t) || own.far || own.width() >= 2 * tile_landmarks) continue;
        const double distance = (own.centre() - position).norm();
        if (distance >= best_distance) continue;
        best = t;
        best_distance = distance;
    }
    if (best >= 0 && best_distance <= tile_radius * reach_) return best;
    if (free < 0) {
        free = tileCount();
        tiles_.emplace_back();
        covariance_.addTile();
        group_.parts.emplace_back();
    }
    tile(free) = {};
    covariance_.clearTile(free);
    group_.part(free) = {};
    group_.part(free).C.resize(0, group_.rank());
    return free;
}

}  // namespace slamot
