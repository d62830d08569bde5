// How the tiles of a PassiveMap are opened, closed and kept up to date.
#include "PassiveMapTiles.h"

#include <algorithm>
#include <cmath>

#include "slamot/core/estimation/DenseAlgebra.h"
#include "slamot/core/estimation/PassiveMap.h"
#include "slamot/core/estimation/TurningBasis.h"

namespace slamot {
namespace {

constexpr int tile_landmarks = 64;       // at most, in one tile
constexpr double closed_fraction = 0.6;  // a tile is closed when its Y is at most this part of its width
constexpr double regrown = 1.5;          // and closed anew when its Y has grown by this factor
constexpr int patience = 2;              // commits until closing is tried, doubled at each failure
constexpr int tries_per_commit = 4;
/// Directions of a tile that carry less than this part of a standard deviation to the rest are rounding.
constexpr double tolerance = 1e-12;

}  // namespace

using namespace passive_map;

Vector2 PassiveMap::Tile::centre() const {
    return Eigen::Map<const Eigen::Matrix2Xd>(mean.data(), 2, mean.size() / 2).rowwise().mean();
}

void PassiveMap::add(const Waiting& waiting, int t, int end) {
    const auto [first, count] = waiting.span[static_cast<std::size_t>(t)];
    if (count == 0) return;
    int columns = 0;
    for (int s = 0; s < end; ++s) columns = std::max(columns, waiting.span[s].first + waiting.span[s].second);
    product_.resize(waiting.Psi.rows(), count);
    addition_.resize(columns, count);
    multiply(waiting.Psi, waiting.X.middleCols(first, count), product_);
    multiplyTransposed(waiting.X.leftCols(columns), product_, addition_);
    for (int s = 0; s < end; ++s) {
        if (!used(s)) continue;
        Pair& p = s <= t ? pair(s, t) : pair(t, s);
        if (p.done > waiting.number) continue;
        const auto [first_s, count_s] = waiting.span[static_cast<std::size_t>(s)];
        if (s <= t)
            p.Z.topLeftCorner(count_s, count) += addition_.middleRows(first_s, count_s);
        else
            p.Z.topLeftCorner(count, count_s) += addition_.middleRows(first_s, count_s).transpose();
        p.done = waiting.number + 1;
    }
}

void PassiveMap::work(double multiplications) {
    while (multiplications > 0 && !waiting_.empty()) {
        const Waiting& oldest = waiting_.front();
        if (next_tile_ == static_cast<int>(oldest.span.size())) {
            waiting_.pop_front();
            next_tile_ = 0;
            continue;
        }
        const auto [first, count] = oldest.span[static_cast<std::size_t>(next_tile_)];
        if (used(next_tile_)) add(oldest, next_tile_, next_tile_ + 1);
        multiplications -= 1.0 * count * static_cast<double>(oldest.Psi.rows()) *
                           static_cast<double>(oldest.Psi.rows() + first + count);
        ++next_tile_;
    }
}

void PassiveMap::settle(int t) {
    for (const Waiting& waiting : waiting_)
        if (t < static_cast<int>(waiting.span.size())) add(waiting, t, static_cast<int>(waiting.span.size()));
}

void PassiveMap::open(int t) {
    settle(t);
    Tile& own = tile(t);
    if (own.open()) return;
    ++counts_.openings;
    const Eigen::MatrixXd Y = own.Y;
    own.Y.resize(0, 0);
    own.next_try = 0;
    own.X = own.X * Y;
    forPairsOf(t, [&](int s, Pair& p, bool at_columns) {
        transformSide(p.Z, Y, at_columns);
        if (s == t) transformSide(p.Z, Y, false);
        if (!tile(s).open() || p.D.size() == 0) return;
        p.Z += p.D;
        p.D.resize(0, 0);
    });
}

bool PassiveMap::close(int t) {
    Tile& own = tile(t);
    settle(t);
    // The base rows, each per standard deviation of what it belongs to.
    const Eigen::VectorXd per_std =
        row_std_.unaryExpr([](double std) { return std > 0 ? 1.0 / std : 0.0; });
    const Eigen::MatrixXd rows = per_std.asDiagonal() * (own.open() ? own.X : Eigen::MatrixXd(own.X * own.Y));
    double std = 0;
    for (const BlockId id : own.landmarks) std = std::max(std, std::sqrt(covariance(id, id).diagonal().maxCoeff()));
    const Eigen::MatrixXd Y =
        turningBasis(rows, tolerance * std, static_cast<int>(closed_fraction * own.width()));
    if (Y.rows() == 0) return false;

    ++counts_.closings;
    const Eigen::MatrixXd Y_before = own.open() ? Eigen::MatrixXd::Identity(own.width(), own.width()) : own.Y;
    forPairsOf(t, [&](int s, Pair& p, bool at_columns) {
        Eigen::MatrixXd Z = p.Z;
        transformSide(Z, Y_before, at_columns);
        if (s == t)
            transformSide(Z, Y_before, false);
        else if (!tile(s).open())
            transformSide(Z, tile(s).Y, !at_columns);
        if (p.D.size() > 0)
            p.D += Z;
        else
            p.D.swap(Z);
        const int rank_s = s == t ? static_cast<int>(Y.rows()) : tile(s).rank();
        p.Z = at_columns ? Eigen::MatrixXd::Zero(rank_s, Y.rows()) : Eigen::MatrixXd::Zero(Y.rows(), rank_s);
    });
    own.X = own.X * (Y_before * Y.transpose());
    own.Y = Y;
    own.directions_at_closing = own.rank();
    return true;
}

void PassiveMap::closeTiles() {
    int tries = 0;
    for (int i = 0; i < tileCount() && tries < tries_per_commit; ++i) {
        const int t = (next_closing_ + i) % tileCount();
        Tile& own = tile(t);
        if (!used(t) || own.width() < tile_landmarks || commits_ < own.next_try) continue;
        if (!own.open() && own.rank() < regrown * own.directions_at_closing) continue;
        if (own.next_try > 0) {
            ++tries;
            const bool closed = close(t);
            own.pause = closed ? patience : 2 * own.pause;
            next_closing_ = t + 1;
        } else {
            own.pause = patience;
        }
        own.next_try = commits_ + own.pause;
    }
}

void PassiveMap::drop(int t, const std::vector<int>& gone) {
    if (gone.empty()) return;
    Tile& own = tile(t);
    std::vector<int> kept;
    for (int i = 0; i < own.width() / 2; ++i)
        if (std::find(gone.begin(), gone.end(), i) == gone.end()) kept.push_back(i);
    const std::vector<int> columns = coordinatesOf(kept);
    forPairsOf(t, [&](int s, Pair& p, bool at_columns) {
        if (kept.empty()) {
            p = {};
            return;
        }
        keepSide(p.Z, columns, at_columns);
        if (s == t) keepSide(p.Z, columns, false);
        if (p.D.size() > 0) keepSide(p.D, columns, at_columns);
    });
    keepSide(own.X, columns, true);
    own.mean = Eigen::VectorXd(own.mean(columns));
    std::vector<BlockId> landmarks;
    for (const int i : kept) landmarks.push_back(own.landmarks[static_cast<std::size_t>(i)]);
    own.landmarks.swap(landmarks);
    if (own.landmarks.empty()) own = {};
}

int PassiveMap::tileFor(const Vector2& position) {
    int best = -1, free = -1;
    double best_distance = std::numeric_limits<double>::infinity();
    for (int t = 0; t < tileCount(); ++t) {
        const Tile& own = tile(t);
        if (!used(t)) {
            free = t;
            continue;
        }
        if (!own.open() || own.width() >= 2 * tile_landmarks) continue;
        const double distance = (own.centre() - position).norm();
        if (distance < best_distance) {
            best = t;
            best_distance = distance;
        }
    }
    if (best >= 0 && best_distance <= tile_reach_) return best;
    if (free < 0) {
        free = tileCount();
        tiles_.emplace_back();
        pairs_.emplace_back(tiles_.size());
    }
    // A new tile has seen all commits.
    tile(free).X.resize(q_, 0);
    for (int s = 0; s < tileCount(); ++s) {
        Pair& p = s <= free ? pair(s, free) : pair(free, s);
        p = {};
        p.done = commits_;
        const int rank_s = s == free ? 0 : tile(s).rank();
        p.Z.resize(s <= free ? rank_s : 0, s <= free ? 0 : rank_s);
    }
    return free;
}

Eigen::MatrixXd PassiveMap::rowsIn(int t, const std::vector<Address>& taken, const Eigen::VectorXd& std) {
    Tile& own = tile(t);
    const int count = 2 * static_cast<int>(taken.size());
    Eigen::MatrixXd rows(count, own.rank()), rest = Eigen::MatrixXd::Zero(count, own.open() ? 0 : own.width());
    for (int i = 0; i < count / 2; ++i) {
        const auto& [landmark, s, k] = taken[static_cast<std::size_t>(i)];
        const Pair& p = s <= t ? pair(s, t) : pair(t, s);
        if (s <= t)
            rows.middleRows<2>(2 * i) = p.Z.middleRows<2>(2 * k);
        else
            rows.middleRows<2>(2 * i) = p.Z.middleCols<2>(2 * k).transpose();
        if (p.D.size() == 0) continue;
        if (s <= t)
            rest.middleRows<2>(2 * i) = p.D.middleRows<2>(2 * k);
        else
            rest.middleRows<2>(2 * i) = p.D.middleCols<2>(2 * k).transpose();
    }
    if (own.open() || rest.isZero(0)) return rows;

    // What of D lies along Y, twice for rounding; what does not gives new directions.
    for (int pass = 0; pass < 2; ++pass) {
        const Eigen::MatrixXd along = rest * own.Y.transpose();
        rows += along;
        rest -= along * own.Y;
    }
    const Eigen::VectorXd per_std = std.unaryExpr([](double v) { return v > 0 ? 1.0 / v : 0.0; });
    double own_std = 0;
    for (const BlockId id : own.landmarks)
        own_std = std::max(own_std, std::sqrt(covariance(id, id).diagonal().maxCoeff()));
    const Eigen::MatrixXd more = turningBasis(per_std.asDiagonal() * rest, tolerance * own_std, own.width());
    const int added = static_cast<int>(more.rows());
    if (added == 0) return rows;
    counts_.extensions += added;
    rows.conservativeResize(Eigen::NoChange, own.rank() + added);
    rows.rightCols(added) = rest * more.transpose();
    forPairsOf(t, [&](int s, Pair& p, bool at_columns) {
        appendZeros(p.Z, added, at_columns);
        if (s == t) appendZeros(p.Z, added, false);
    });
    appendZeros(own.X, added, true);
    own.Y.conservativeResize(own.Y.rows() + added, Eigen::NoChange);
    own.Y.bottomRows(added) = more;
    return rows;
}

PassiveMap::Census PassiveMap::census() const {
    Census out = counts_;
    for (int t = 0; t < tileCount(); ++t) {
        if (!used(t)) continue;
        ++out.tiles;
        out.open += tile(t).open();
        out.directions += tile(t).rank();
        out.columns += tile(t).width();
    }
    out.waiting = static_cast<int>(waiting_.size());
    return out;
}

std::size_t PassiveMap::memory() const {
    std::size_t numbers = 0;
    for (const Tile& t : tiles_) numbers += static_cast<std::size_t>(t.X.size() + t.Y.size() + t.mean.size());
    for (const auto& row : pairs_)
        for (const Pair& p : row) numbers += static_cast<std::size_t>(p.Z.size() + p.D.size());
    for (const Waiting& w : waiting_) numbers += static_cast<std::size_t>(w.X.size() + w.Psi.size());
    return sizeof(double) * numbers;
}

}  // namespace slamot
