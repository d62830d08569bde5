#include "slamot/core/estimation/PassiveMap.h"

#include <algorithm>
#include <stdexcept>

#include "PassiveMapTiles.h"
#include "slamot/core/estimation/DenseAlgebra.h"
#include "slamot/core/estimation/TurningBasis.h"

namespace slamot {

using namespace passive_map;

bool PassiveMap::contains(BlockId landmark) const {
    const auto found = std::lower_bound(addresses_.begin(), addresses_.end(), landmark,
                                        [](const Address& a, BlockId id) { return a.landmark < id; });
    return found != addresses_.end() && found->landmark == landmark;
}

const PassiveMap::Address& PassiveMap::find(BlockId landmark) const {
    if (!contains(landmark)) throw std::out_of_range("no such block in the joint state");
    return *std::lower_bound(addresses_.begin(), addresses_.end(), landmark,
                             [](const Address& a, BlockId id) { return a.landmark < id; });
}

void PassiveMap::index() {
    addresses_.clear();
    for (int t = 0; t < tileCount(); ++t)
        for (std::size_t i = 0; i < tile(t).landmarks.size(); ++i)
            addresses_.push_back({tile(t).landmarks[i], t, static_cast<int>(i)});
    std::sort(addresses_.begin(), addresses_.end(),
              [](const Address& a, const Address& b) { return a.landmark < b.landmark; });
    size_ = static_cast<int>(addresses_.size());
}

std::vector<BlockId> PassiveMap::landmarks() const {
    std::vector<BlockId> out;
    for (const Address& address : addresses_) out.push_back(address.landmark);
    return out;
}

Vector2 PassiveMap::mean(BlockId landmark) const {
    const Address& at = find(landmark);
    return tile(at.tile).mean.segment<2>(2 * at.index);
}

Eigen::MatrixXd PassiveMap::base(BlockId landmark) const {
    const Address& at = find(landmark);
    const Tile& t = tile(at.tile);
    if (t.open()) return t.X.middleCols<2>(2 * at.index);
    return t.X * t.Y.middleCols<2>(2 * at.index);
}

Matrix2 PassiveMap::covariance(BlockId a, BlockId b) const {
    const Address &at_a = find(a), &at_b = find(b);
    if (at_a.tile > at_b.tile) return covariance(b, a).transpose();
    const Tile &s = tile(at_a.tile), &t = tile(at_b.tile);
    const Pair& p = pair(at_a.tile, at_b.tile);
    const Eigen::MatrixXd y_a = columnsOf(s.Y, s.rank(), at_a.index), y_b = columnsOf(t.Y, t.rank(), at_b.index);
    Matrix2 out = y_a.transpose() * p.Z * y_b;
    if (p.D.size() > 0) out += p.D.block<2, 2>(2 * at_a.index, 2 * at_b.index);
    for (const Waiting& waiting : waiting_) {
        if (waiting.number < p.done) continue;
        const auto [first_a, count_a] = waiting.span[static_cast<std::size_t>(at_a.tile)];
        const auto [first_b, count_b] = waiting.span[static_cast<std::size_t>(at_b.tile)];
        const Eigen::MatrixXd B_a = waiting.X.middleCols(first_a, count_a) * y_a.topRows(count_a);
        const Eigen::MatrixXd B_b = waiting.X.middleCols(first_b, count_b) * y_b.topRows(count_b);
        out += B_a.transpose() * waiting.Psi * B_b;
    }
    return out;
}

Eigen::MatrixXd PassiveMap::withTurned(const Eigen::MatrixXd& rows) const {
    if (!turning_) return rows;
    Eigen::MatrixXd out(2 * rows.rows(), rows.cols());
    const Eigen::MatrixXd turned = turnedRows(rows);
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
        out.row(2 * k) = rows.row(k);
        out.row(2 * k + 1) = turned.row(k);
    }
    return out;
}

PassiveMap::Taken PassiveMap::take(const std::vector<BlockId>& landmarks) {
    std::vector<Address> addresses;
    for (const BlockId id : landmarks) addresses.push_back(find(id));
    for (const Address& address : addresses) open(address.tile);

    const int columns = 2 * static_cast<int>(landmarks.size());
    Taken taken;
    taken.mean.resize(columns);
    taken.base.resize(q_, columns);
    taken.covariance.resize(columns, columns);
    for (int i = 0; i < columns / 2; ++i) {
        const Address& a = addresses[static_cast<std::size_t>(i)];
        taken.mean.segment<2>(2 * i) = mean(a.landmark);
        taken.base.middleCols<2>(2 * i) = base(a.landmark);
        for (int j = 0; j < columns / 2; ++j)
            taken.covariance.block<2, 2>(2 * i, 2 * j) =
                covariance(a.landmark, addresses[static_cast<std::size_t>(j)].landmark);
    }
    const Eigen::VectorXd std = taken.covariance.diagonal().cwiseMax(0).cwiseSqrt();
    taken.new_rows = columns * (turning_ ? 2 : 1);
    for (int t = 0; t < tileCount(); ++t) {
        if (!used(t)) continue;
        const Eigen::MatrixXd rows = withTurned(rowsIn(t, addresses, std));
        tile(t).X.conservativeResize(q_ + taken.new_rows, Eigen::NoChange);
        tile(t).X.bottomRows(taken.new_rows) = rows;
    }
    row_std_.conservativeResize(q_ + taken.new_rows);
    for (int k = 0; k < taken.new_rows; ++k) row_std_(q_ + k) = std(turning_ ? k / 2 : k);
    q_ += taken.new_rows;

    std::vector<std::vector<int>> gone(tiles_.size());
    for (const Address& address : addresses) gone[static_cast<std::size_t>(address.tile)].push_back(address.index);
    for (int t = 0; t < tileCount(); ++t) drop(t, gone[static_cast<std::size_t>(t)]);
    index();
    return taken;
}

void PassiveMap::remove(BlockId landmark) {
    const Address address = find(landmark);
    open(address.tile);
    drop(address.tile, {address.index});
    index();
}

void PassiveMap::commit(const Commit& commit) {
    // Additions wait for one commit; what is left of the one before is made now.
    while (!waiting_.empty()) work(std::numeric_limits<double>::infinity());

    Waiting addition;
    addition.number = commits_++;
    addition.Psi = commit.Psi;
    int columns = 0;
    for (int t = 0; t < tileCount(); ++t) {
        addition.span.emplace_back(columns, used(t) ? tile(t).rank() : 0);
        columns += addition.span.back().second;
    }
    addition.X.resize(q_, columns);
    for (int t = 0; t < tileCount(); ++t)
        if (used(t)) addition.X.middleCols(addition.span[static_cast<std::size_t>(t)].first, tile(t).rank()) = tile(t).X;

    Eigen::MatrixXd U(commit.Phi.rows(), columns), V(commit.Phi_landmarks.rows(), columns);
    multiply(commit.Phi, addition.X, U);
    multiply(commit.Phi_landmarks, addition.X, V);
    const Eigen::VectorXd moved = addition.X.transpose() * commit.eta;
    for (int t = 0; t < tileCount(); ++t) {
        if (!used(t)) continue;
        const auto [first, count] = addition.span[static_cast<std::size_t>(t)];
        Tile& own = tile(t);
        if (own.open())
            own.mean += moved.segment(first, count);
        else
            own.mean.noalias() += own.Y.transpose() * moved.segment(first, count);
        own.X = withTurned(U.middleCols(first, count));
    }
    const int rows = turning_ ? 2 : 1;
    q_ = rows * static_cast<int>(commit.Phi.rows());
    row_std_.resize(q_);
    for (int k = 0; k < q_; ++k) row_std_(k) = commit.kept_std(k / rows);

    // New landmarks go to open tiles.
    std::vector<std::vector<int>> to_tile;
    for (int j = 0; j < static_cast<int>(commit.landmarks.size()); ++j) {
        const auto t = static_cast<std::size_t>(tileFor(commit.mean.segment<2>(2 * j)));
        to_tile.resize(tiles_.size());
        to_tile[t].push_back(j);
        tiles_[t].landmarks.push_back(commit.landmarks[static_cast<std::size_t>(j)]);
        tiles_[t].mean.conservativeResize(tiles_[t].mean.size() + 2);
        tiles_[t].mean.tail<2>() = commit.mean.segment<2>(2 * j);
    }
    to_tile.resize(tiles_.size());
    std::vector<std::vector<int>> appended(tiles_.size());
    for (int t = 0; t < tileCount(); ++t)
        if (!to_tile[static_cast<std::size_t>(t)].empty())
            appendColumns(t, to_tile[static_cast<std::size_t>(t)], commit, V, addition, appended);
    index();
    if (columns > 0) waiting_.push_back(std::move(addition));
    closeTiles();
}

void PassiveMap::appendColumns(int t, const std::vector<int>& which, const Commit& commit, const Eigen::MatrixXd& V,
                               const Waiting& addition, std::vector<std::vector<int>>& appended) {
    Tile& own = tile(t);
    const int before = own.rank(), more = 2 * static_cast<int>(which.size());
    const std::vector<int> columns = coordinatesOf(which);
    own.X.conservativeResize(q_, before + more);
    own.X.rightCols(more) = withTurned(commit.kept_covariance(Eigen::all, columns));
    appended[static_cast<std::size_t>(t)] = which;
    forPairsOf(t, [&](int s, Pair& p, bool at_columns) {
        // P of tile s's coordinates with the new columns: first those that were there before the commit.
        const std::vector<int> others = coordinatesOf(appended[static_cast<std::size_t>(s)]);
        const int late = static_cast<int>(others.size()), early = tile(s).rank() - late;
        Eigen::MatrixXd fresh(early + late, more);
        if (early > 0)
            fresh.topRows(early) =
                V(columns, Eigen::seqN(addition.span[static_cast<std::size_t>(s)].first, early)).transpose();
        fresh.bottomRows(late) = commit.own_covariance(others, columns);
        if (s == t) {
            p.Z.conservativeResize(before + more, before + more);
            p.Z.rightCols(more) = fresh;
            p.Z.bottomLeftCorner(more, before) = fresh.topRows(before).transpose();
        } else if (at_columns) {
            p.Z.conservativeResize(tile(s).rank(), before + more);
            p.Z.rightCols(more) = fresh;
        } else {
            p.Z.conservativeResize(before + more, tile(s).rank());
            p.Z.bottomRows(more) = fresh.transpose();
        }
        if (p.D.size() > 0) appendZeros(p.D, more, at_columns);
    });
}

}  // namespace slamot
