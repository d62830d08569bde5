#include "slamot/core/estimation/PassiveMap.h"

#include <stdexcept>
#include <utility>

#include "slamot/core/estimation/DenseAlgebra.h"
#include "slamot/core/estimation/SquareRoot.h"
#include "slamot/core/estimation/TurningBasis.h"

namespace slamot {
std::vector<int> PassiveMap::coordinatesOf(const std::vector<int>& landmarks) {
    std::vector<int> out;
    for (const int i : landmarks) {
        out.push_back(2 * i);
        out.push_back(2 * i + 1);
    }
    return out;
}

bool PassiveMap::contains(BlockId landmark) const {
    return landmark >= 0 && landmark < static_cast<BlockId>(addresses_.size()) &&
           addresses_[static_cast<std::size_t>(landmark)].tile >= 0;
}

const PassiveMap::Address& PassiveMap::find(BlockId landmark) const {
    if (!contains(landmark)) throw std::out_of_range("no such block in the joint state");
    return addresses_[static_cast<std::size_t>(landmark)];
}

void PassiveMap::index(int t) {
    const std::vector<BlockId>& landmarks = tile(t).landmarks;
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
        const auto id = static_cast<std::size_t>(landmarks[i]);
        if (id >= addresses_.size()) addresses_.resize(id + 1);
        size_ += addresses_[id].tile < 0;
        addresses_[id] = {t, static_cast<int>(i)};
    }
}

std::vector<BlockId> PassiveMap::landmarks() const {
    std::vector<BlockId> out;
    for (std::size_t id = 0; id < addresses_.size(); ++id)
        if (addresses_[id].tile >= 0) out.push_back(static_cast<BlockId>(id));
    return out;
}

Vector2 PassiveMap::mean(BlockId landmark) const {
    const auto& [t, i] = find(landmark);
    Vector2 out = tile(t).mean.segment<2>(2 * i);
    if (tile(t).far) out += group_.part(t).V.middleCols<2>(2 * i).transpose() * group_.shift;
    return out;
}

Eigen::MatrixXd PassiveMap::base(BlockId landmark) const {
    const auto& [t, i] = find(landmark);
    if (tile(t).far) return group_.W.topRows(q_) * group_.part(t).V.middleCols<2>(2 * i);
    return tile(t).X.topRows(q_).middleCols<2>(2 * i);
}

Matrix2 PassiveMap::covariance(BlockId a, BlockId b) const {
    const Address at_a = find(a), at_b = find(b);
    const int s = at_a.tile, t = at_b.tile, row = 2 * at_a.index, column = 2 * at_b.index;
    Matrix2 out = covariance_.covariance(s, row, t, column);
    if (tile(t).far)
        out += group_.left(s, row, 2) * group_.part(t).V.middleCols<2>(column);
    else if (tile(s).far)
        out += (group_.left(t, column, 2) * group_.part(s).V.middleCols<2>(row)).transpose();
    return out;
}

Eigen::MatrixXd PassiveMap::withTurned(const Eigen::MatrixXd& proper) const {
    return turning_ ? withTurnedRows(proper) : proper;
}

Eigen::MatrixXd PassiveMap::rowsProper(const Eigen::MatrixXd& rows) const {
    return turning_ ? firstOfPairs(rows) : rows;
}

PassiveMap::Taken PassiveMap::prepare(const std::vector<BlockId>& landmarks) {
    forgetPrepared();
    // Landmarks of far tiles: all around them comes near, since more will be asked for. And a group that
    // landmarks were removed from is made anew, since rows are projected on its directions.
    std::vector<Vector2> places;
    for (const BlockId id : landmarks)
        if (tile(find(id).tile).far) places.push_back(tile(find(id).tile).centre());
    if (!places.empty() || group_.cut) {
        std::vector<char> far = farFrom(places);
        for (int t = 0; t < tileCount(); ++t) far[static_cast<std::size_t>(t)] &= tile(t).far ? 1 : 0;
        regroup(far);
    }

    const auto count = static_cast<Eigen::Index>(landmarks.size()), columns = 2 * count;
    Taken taken;
    taken.landmarks = landmarks;
    taken.mean.resize(columns);
    taken.base.resize(q_, columns);
    taken.covariance.resize(columns, columns);
    std::vector<Address> addresses;
    for (Eigen::Index i = 0; i < count; ++i) {
        const BlockId id = landmarks[static_cast<std::size_t>(i)];
        addresses.push_back(find(id));
        taken.mean.segment<2>(2 * i) = mean(id);
        taken.base.middleCols<2>(2 * i) = base(id);
        for (Eigen::Index j = 0; j < count; ++j)
            taken.covariance.block<2, 2>(2 * i, 2 * j) =
                covariance(id, landmarks[static_cast<std::size_t>(j)]);
    }
    const Eigen::MatrixXd proper = rowsProper(taken.base);
    const SquareRoot root = squareRoot(taken.covariance - transposedProduct(proper, proper));
    addRows(addresses, proper, root.whitener);
    taken.root = root.root;
    taken.new_rows = prepared_rows_ = static_cast<int>(columns) * (turning_ ? 2 : 1);
    return taken;
}

void PassiveMap::take(const Taken& taken) {
    if (taken.base.rows() != q_ || taken.new_rows != prepared_rows_)
        throw std::logic_error("these landmarks were not prepared last");
    q_ += std::exchange(prepared_rows_, 0);
    std::vector<std::vector<int>> gone(tiles_.size());
    for (const BlockId id : taken.landmarks) {
        const Address& address = find(id);
        gone[static_cast<std::size_t>(address.tile)].push_back(address.index);
    }
    for (int t = 0; t < tileCount(); ++t) drop(t, gone[static_cast<std::size_t>(t)]);
}

void PassiveMap::forgetPrepared() {
    if (std::exchange(prepared_rows_, 0) == 0) return;
    group_.W.conservativeResize(q_, Eigen::NoChange);
    for (int t = 0; t < tileCount(); ++t)
        if (used(t) && !tile(t).far) tile(t).X.conservativeResize(q_, Eigen::NoChange);
}

void PassiveMap::remove(BlockId landmark) {
    forgetPrepared();
    const Address address = find(landmark);
    drop(address.tile, {address.index});
}

void PassiveMap::clear() {
    for (int t = 0; t < tileCount(); ++t) {
        tile(t) = {};
        covariance_.clearTile(t);
    }
    group_ = {};
    group_.parts.resize(tiles_.size());
    q_ = prepared_rows_ = 0;
}

void PassiveMap::drop(int t, const std::vector<int>& gone) {
    if (gone.empty()) return;
    Tile& own = tile(t);
    std::vector<int> kept;
    std::vector<BlockId> landmarks;
    for (int i = 0; i < own.width() / 2; ++i) {
        const BlockId id = own.landmarks[static_cast<std::size_t>(i)];
        if (std::find(gone.begin(), gone.end(), i) == gone.end()) {
            kept.push_back(i);
            landmarks.push_back(id);
        } else {
            addresses_[static_cast<std::size_t>(id)] = {};
            --size_;
        }
    }
    const std::vector<int> columns = coordinatesOf(kept);
    covariance_.drop(t, columns);
    group_.dropColumns(t, columns);
    if (!own.far) own.X = Eigen::MatrixXd(own.X(Eigen::all, columns));
    own.mean = Eigen::VectorXd(own.mean(columns));
    own.landmarks.swap(landmarks);
    index(t);
}

PassiveMap::Census PassiveMap::census() const {
    Census out;
    for (int t = 0; t < tileCount(); ++t) {
        if (!used(t)) continue;
        ++out.tiles;
        out.columns += tile(t).width();
        out.near += !tile(t).far;
        out.near_columns += tile(t).far ? 0 : tile(t).width();
    }
    out.directions = group_.rank();
    out.waiting = covariance_.waiting();
    out.added_terms = covariance_.added();
    out.regroupings = regroupings_;
    return out;
}

std::size_t PassiveMap::memory() const {
    Eigen::Index numbers = group_.W.size() + group_.zeta.size();
    for (const Tile& t : tiles_) numbers += t.X.size() + t.mean.size();
    for (const FarGroup::Part& p : group_.parts) numbers += p.V.size() + p.C.size();
    return sizeof(double) * static_cast<std::size_t>(numbers) + covariance_.memory();
}

}  // namespace slamot
