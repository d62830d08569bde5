#include "slamot/core/estimation/PassiveMap.h"

#include <stdexcept>

#include "slamot/core/estimation/DenseAlgebra.h"
#include "slamot/core/estimation/SquareRoot.h"
#include "slamot/core/estimation/TurningBasis.h"

namespace slamot {
namespace {

/// The two coordinates of each landmark.
std::vector<int> coordinatesOf(const std::vector<int>& landmarks) {
    std::vector<int> out;
    for (const int i : landmarks) {
        out.push_back(2 * i);
        out.push_back(2 * i + 1);
    }
    return out;
}

}  // namespace

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
}

std::vector<BlockId> PassiveMap::landmarks() const {
    std::vector<BlockId> out;
    for (const Address& address : addresses_) out.push_back(address.landmark);
    return out;
}

Vector2 PassiveMap::mean(BlockId landmark) const {
    const auto& [id, t, i] = find(landmark);
    Vector2 out = tile(t).mean.segment<2>(2 * i);
    if (tile(t).far) out += group_.part(t).V.middleCols<2>(2 * i).transpose() * group_.shift;
    return out;
}

Eigen::MatrixXd PassiveMap::base(BlockId landmark) const {
    const auto& [id, t, i] = find(landmark);
    if (tile(t).far) return group_.W * group_.part(t).V.middleCols<2>(2 * i);
    return tile(t).X.middleCols<2>(2 * i);
}

Matrix2 PassiveMap::covariance(BlockId a, BlockId b) const {
    const Address at_a = find(a), at_b = find(b);
    if (at_a.tile > at_b.tile) return covariance(b, a).transpose();
    const int s = at_a.tile, t = at_b.tile, row = 2 * at_a.index, column = 2 * at_b.index;
    const Pair& p = pair(s, t);
    Matrix2 out = Matrix2::Zero();
    if (row < p.Z.rows() && column < p.Z.cols()) out = p.Z.block<2, 2>(row, column);
    const auto addWaiting = [&](const FarGroup& group) {
        if (group.number < p.done || row >= group.width(s) || column >= group.width(t)) return;
        if (group.far(t))
            out += group.left(s, row, 2) * group.part(t).V.middleCols<2>(column);
        else if (group.far(s))
            out += (group.left(t, column, 2) * group.part(s).V.middleCols<2>(row)).transpose();
    };
    for (const FarGroup& old : old_groups_) addWaiting(old);
    addWaiting(group_);
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

Eigen::MatrixXd PassiveMap::rowsProper(const Eigen::MatrixXd& rows) const {
    return turning_ ? Eigen::MatrixXd(rows(Eigen::seq(0, Eigen::last, 2), Eigen::all)) : rows;
}

void PassiveMap::addBlock(int s, int row, int t, int column, const Eigen::Ref<const Eigen::MatrixXd>& P) {
    if (s > t) return addBlock(t, column, s, row, P.transpose());
    Eigen::MatrixXd& Z = pair(s, t).Z;
    const auto rows = std::max(Z.rows(), row + P.rows()), cols = std::max(Z.cols(), column + P.cols());
    if (rows > Z.rows() || cols > Z.cols()) {
        Eigen::MatrixXd larger = Eigen::MatrixXd::Zero(rows, cols);
        larger.topLeftCorner(Z.rows(), Z.cols()) = Z;
        Z.swap(larger);
    }
    Z.block(row, column, P.rows(), P.cols()) += P;
}

PassiveMap::Taken PassiveMap::take(const std::vector<BlockId>& landmarks) {
    std::vector<char> far(tiles_.size());
    bool come_near = false;
    for (int t = 0; t < tileCount(); ++t) far[static_cast<std::size_t>(t)] = tile(t).far;
    for (const BlockId id : landmarks) {
        const int t = find(id).tile;
        come_near |= tile(t).far;
        far[static_cast<std::size_t>(t)] = 0;
    }
    if (come_near) regroup(far);

    const int columns = 2 * static_cast<int>(landmarks.size());
    Taken taken;
    taken.mean.resize(columns);
    taken.base.resize(q_, columns);
    taken.covariance.resize(columns, columns);
    std::vector<Address> addresses;
    for (int i = 0; i < columns / 2; ++i) {
        const BlockId id = landmarks[static_cast<std::size_t>(i)];
        addresses.push_back(find(id));
        taken.mean.segment<2>(2 * i) = mean(id);
        taken.base.middleCols<2>(2 * i) = base(id);
        for (int j = 0; j < columns / 2; ++j)
            taken.covariance.block<2, 2>(2 * i, 2 * j) =
                covariance(id, landmarks[static_cast<std::size_t>(j)]);
    }
    const Eigen::MatrixXd proper = rowsProper(taken.base);
    const SquareRoot root = squareRoot(taken.covariance - proper.transpose() * proper);
    addRows(addresses, proper, root.whitener);
    taken.root = root.root;
    taken.new_rows = columns * (turning_ ? 2 : 1);
    q_ += taken.new_rows;

    std::vector<std::vector<int>> gone(tiles_.size());
    for (const Address& address : addresses)
        gone[static_cast<std::size_t>(address.tile)].push_back(address.index);
    for (int t = 0; t < tileCount(); ++t) drop(t, gone[static_cast<std::size_t>(t)]);
    index();
    return taken;
}

void PassiveMap::remove(BlockId landmark) {
    const Address address = find(landmark);
    drop(address.tile, {address.index});
    index();
}

void PassiveMap::drop(int t, const std::vector<int>& gone) {
    if (gone.empty()) return;
    Tile& own = tile(t);
    std::vector<int> kept;
    for (int i = 0; i < own.width() / 2; ++i)
        if (std::find(gone.begin(), gone.end(), i) == gone.end()) kept.push_back(i);
    const std::vector<int> columns = coordinatesOf(kept);
    for (int s = 0; s < tileCount(); ++s) {
        if (!used(s)) continue;
        Eigen::MatrixXd& Z = pair(s, t).Z;
        std::vector<int> stored;
        for (const int i : columns)
            if (i < (s <= t ? Z.cols() : Z.rows())) stored.push_back(i);
        if (s <= t) Z = Eigen::MatrixXd(Z(Eigen::all, stored));
        if (s >= t) Z = Eigen::MatrixXd(Z(stored, Eigen::all));
    }
    for (FarGroup& old : old_groups_) old.dropColumns(t, columns);
    group_.dropColumns(t, columns);
    if (!own.far) own.X = Eigen::MatrixXd(own.X(Eigen::all, columns));
    own.mean = Eigen::VectorXd(own.mean(columns));
    std::vector<BlockId> landmarks;
    for (const int i : kept) landmarks.push_back(own.landmarks[static_cast<std::size_t>(i)]);
    own.landmarks.swap(landmarks);
}

void PassiveMap::commit(const Commit& commit) {
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
    index();
}

void PassiveMap::append(const Commit& commit, const Eigen::MatrixXd& near_rows,
                        const Eigen::MatrixXd& far_rows, const std::vector<int>& first_column) {
    std::vector<std::vector<int>> late(
        tiles_.size());  // landmarks of the commit, by the tile they are in by now
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
            addBlock(s, 0, t, width, P.transpose());
            if (s == t) addBlock(t, width, t, 0, P);
        }
        addBlock(t, width, t, width, commit.covariance.block<2, 2>(2 * j, 2 * j));

        own.X.conservativeResize(q_, width + 2);
        own.X.rightCols<2>() = withTurned(commit.base.middleCols<2>(2 * j));
        own.mean.conservativeResize(width + 2);
        own.mean.tail<2>() = commit.mean.segment<2>(2 * j);
        FarGroup::Part& part = group_.part(t);
        part.C.conservativeResize(width + 2, group_.rank());
        part.C.bottomRows<2>() = far_rows.middleRows<2>(2 * j);
        own.landmarks.push_back(commit.landmarks[static_cast<std::size_t>(j)]);
        late[static_cast<std::size_t>(t)].push_back(j);
    }
}

void PassiveMap::addTerm(const Eigen::MatrixXd& Psi) {
    int columns = 0;
    for (int t = 0; t < tileCount(); ++t)
        if (!tile(t).far) columns += tile(t).width();
    Eigen::MatrixXd X(q_, columns), product, sum;
    columns = 0;
    for (int t = 0; t < tileCount(); ++t) {
        if (tile(t).far || !used(t)) continue;
        const int width = tile(t).width();
        X.middleCols(columns, width) = tile(t).X;
        columns += width;
        product.resize(q_, width);
        sum.resize(columns, width);
        multiply(Psi, tile(t).X, product);
        multiplyTransposed(X.leftCols(columns), product, sum);
        for (int s = 0, first = 0; s <= t; ++s) {
            if (tile(s).far || !used(s)) continue;
            addBlock(s, 0, t, 0, sum.middleRows(first, tile(s).width()));
            first += tile(s).width();
        }
        if (group_.rank() > 0) group_.part(t).C.noalias() += product.transpose() * group_.W;
    }
    if (group_.rank() > 0) group_.zeta.noalias() += group_.W.transpose() * (Psi * group_.W);
}

}  // namespace slamot
