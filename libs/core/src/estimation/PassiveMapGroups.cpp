// Which tiles of a PassiveMap are near, and what waits for those that are not.
#include <cmath>

#include "slamot/core/estimation/DenseAlgebra.h"
#include "slamot/core/estimation/PassiveMap.h"
#include "slamot/core/estimation/TurningBasis.h"

namespace slamot {
namespace {

constexpr int tile_landmarks = 50;  // at most, in one tile
constexpr double tile_radius =
    1.0;  // reaches of the sensors: how far from a tile's centre a new member may lie
/// Tiles whose centre lies farther away are far; grouped anew after half the way that could bring a landmark
/// of one within reach.
constexpr double far_distance = 5.0;
constexpr double regroup_after = 2.0;
/// Directions that carry less than this part of a standard deviation, in the root mean square over all
/// landmarks, are left out. What the engine says differs from what the dense one says by some ten times as
/// much.
constexpr double tolerance = 3e-12;
/// What the end of a group leaves out, in parts of a variance.
constexpr double negligible = 1e-13;
constexpr std::size_t most_waiting = 3;

}  // namespace

Vector2 PassiveMap::Tile::centre() const {
    return Eigen::Map<const Eigen::Matrix2Xd>(mean.data(), 2, mean.size() / 2).rowwise().mean();
}

double PassiveMap::landmarkStd() const {
    double variance = 0;
    for (int t = 0; t < tileCount(); ++t)
        if (used(t)) variance = std::max(variance, pair(t, t).Z.diagonal().maxCoeff());
    return std::sqrt(variance);
}

double PassiveMap::negligibleLength() const {
    return tolerance * landmarkStd() * std::sqrt(2.0 * size());
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
        pairs_.emplace_back(tiles_.size());
        group_.parts.emplace_back();
    }
    // Nothing waits for a new tile.
    tile(free) = {};
    for (int s = 0; s < tileCount(); ++s) pair(s, free) = {Eigen::MatrixXd(), group_.number};
    group_.part(free) = {};
    group_.part(free).C.resize(0, group_.rank());
    return free;
}

bool PassiveMap::follow(const Vector2& robot, double reach) {
    robot_ = robot;
    reach_ = reach;
    if ((robot - grouped_at_).norm() < regroup_after * reach && regroupings_ > 0) return false;
    std::vector<char> far(tiles_.size());
    bool any = false;
    for (int t = 0; t < tileCount(); ++t) {
        if (!used(t)) continue;
        const bool is_far = (tile(t).centre() - robot).norm() > far_distance * reach;
        far[static_cast<std::size_t>(t)] = is_far;
        any |= is_far || tile(t).far;
    }
    if (!any) return false;
    grouped_at_ = robot;
    regroup(far);
    return true;
}

void PassiveMap::regroup(const std::vector<char>& far) {
    ++regroupings_;
    while (old_groups_.size() >= most_waiting) work(std::numeric_limits<double>::infinity());

    FarGroup next;
    next.number = group_.number + 1;
    next.parts.resize(tiles_.size());
    next.W = group_.W;
    if (next.W.rows() == 0) next.W.resize(q_, 0);
    std::vector<int> staying, joining;  // far tiles
    int joining_columns = 0;
    for (int t = 0; t < tileCount(); ++t) {
        if (!used(t)) continue;
        Tile& own = tile(t);
        const bool was_far = own.far;
        own.far = far[static_cast<std::size_t>(t)];
        next.part(t).far = own.far;
        if (was_far) own.mean.noalias() += group_.part(t).V.transpose() * group_.shift;
        if (was_far && !own.far) own.X = product(group_.W, group_.part(t).V);
        if (!own.far) continue;
        next.part(t).V = was_far ? group_.part(t).V : Eigen::MatrixXd(next.rank(), 0);
        (was_far ? staying : joining).push_back(t);
        joining_columns += was_far ? 0 : own.width();
    }
    next.orthonormalise(negligibleLength());

    // [W X] of those that stay and those that join = W' K, in few rows of K; V' = K [V 0; 0 I].
    Eigen::MatrixXd M(q_, next.rank() + joining_columns);
    M.leftCols(next.rank()) = next.W;
    int column = next.rank();
    for (const int t : joining) {
        M.middleCols(column, tile(t).width()) = tile(t).X;
        column += tile(t).width();
    }
    const Eigen::MatrixXd K = turningBasis(M, negligibleLength(), static_cast<int>(M.cols()));
    for (const int t : staying) next.part(t).V = product(K.leftCols(next.rank()), next.part(t).V);
    column = next.rank();
    for (const int t : joining) {
        next.part(t).V = K.middleCols(column, tile(t).width());
        column += tile(t).width();
        tile(t).X.resize(0, 0);
    }
    next.W = product(M, K.transpose());
    next.zeta = Eigen::MatrixXd::Zero(next.rank(), next.rank());
    next.shift = Eigen::VectorXd::Zero(next.rank());
    for (int t = 0; t < tileCount(); ++t)
        if (!tile(t).far) next.part(t).C = Eigen::MatrixXd::Zero(tile(t).width(), next.rank());
    group_.end(negligible * landmarkStd() * landmarkStd());
    std::swap(group_, next);
    old_groups_.push_back(std::move(next));

    const FarGroup& ended = old_groups_.back();
    double cost = 0;
    for (int t = 0; t < tileCount(); ++t)
        for (int s = 0; s <= t; ++s)
            if (used(s) && used(t) && (ended.far(s) || ended.far(t))) cost += ended.cost(s, t);
    queued_ = old_groups_.size() == 1 ? cost : queued_ + cost;
    steps_between_regroupings_ = steps_since_regrouping_;
    steps_since_regrouping_ = 0;
}

void PassiveMap::step() {
    ++steps_since_regrouping_;
    // Done by the time of the next regrouping, if that takes as many steps as the last.
    if (!old_groups_.empty()) work(queued_ / std::max(1.0, 0.8 * steps_between_regroupings_));
}

void PassiveMap::work(double multiplications) {
    while (multiplications > 0 && !old_groups_.empty()) {
        const FarGroup& oldest = old_groups_.front();
        if (next_t_ == static_cast<int>(oldest.parts.size()) || oldest.rank() == 0) {
            old_groups_.pop_front();
            next_s_ = next_t_ = 0;
            if (std::isinf(multiplications)) return;
            continue;
        }
        const int s = next_s_, t = next_t_;
        if (++next_s_ > t) {
            ++next_t_;
            next_s_ = 0;
        }
        if (!used(s) || !used(t) || pair(s, t).done > oldest.number) continue;
        pair(s, t).done = oldest.number + 1;
        if (!oldest.far(s) && !oldest.far(t)) continue;
        addBlock(s, 0, t, 0, oldest.waiting(s, t));
        multiplications -= oldest.cost(s, t);
    }
}

void PassiveMap::addRows(const std::vector<Address>& taken, const Eigen::MatrixXd& known,
                         const Eigen::MatrixXd& whitener) {
    const int count = 2 * static_cast<int>(taken.size());
    // For each group what stands left of V in the rows of the landmarks taken.
    std::vector<const FarGroup*> groups;
    std::vector<Eigen::MatrixXd> left;
    for (std::size_t g = 0; g <= old_groups_.size(); ++g) {
        const FarGroup& group = g < old_groups_.size() ? old_groups_[g] : group_;
        groups.push_back(&group);
        left.push_back(Eigen::MatrixXd::Zero(count, group.rank()));
        for (int i = 0; i < count / 2; ++i) {
            const auto& [id, s, k] = taken[static_cast<std::size_t>(i)];
            if (2 * k < group.width(s)) left.back().middleRows<2>(2 * i) = group.left(s, 2 * k, 2);
        }
    }
    // P_c,t0 with what waits in old groups.
    const auto rowsIn = [&](int t) {
        Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(count, tile(t).width());
        for (int i = 0; i < count / 2; ++i) {
            const auto& [id, s, k] = taken[static_cast<std::size_t>(i)];
            const Eigen::MatrixXd& Z = pair(s, t).Z;
            if (s <= t && 2 * k < Z.rows())
                rows.block(2 * i, 0, 2, Z.cols()) = Z.middleRows<2>(2 * k);
            else if (s > t && 2 * k < Z.cols())
                rows.block(2 * i, 0, 2, Z.rows()) = Z.middleCols<2>(2 * k).transpose();
        }
        for (std::size_t g = 0; g + 1 < groups.size(); ++g) {
            const FarGroup& old = *groups[g];
            const int width = old.width(t);
            if (width == 0) continue;
            Eigen::MatrixXd factor = left[g];
            for (int i = 0; i < count / 2; ++i) {
                const auto& [id, s, k] = taken[static_cast<std::size_t>(i)];
                const bool waits = pair(s, t).done <= old.number && 2 * k < old.width(s);
                if (!waits) factor.middleRows<2>(2 * i).setZero();
                if (waits && !old.far(t) && old.far(s))
                    rows.block(2 * i, 0, 2, width) +=
                        old.part(s).V.middleCols<2>(2 * k).transpose() * old.part(t).C.transpose();
            }
            if (old.far(t)) rows.leftCols(width) += product(factor, old.part(t).V);
        }
        return rows;
    };

    // Far tiles: what of these rows lies along V, twice for rounding; what does not gives new directions.
    const int rank = group_.rank();
    std::vector<int> far;
    int columns = 0;
    for (int t = 0; t < tileCount(); ++t) {
        if (!used(t)) continue;
        if (tile(t).far) {
            far.push_back(t);
            columns += tile(t).width();
            continue;
        }
        const Eigen::MatrixXd rows =
            withTurned(whitener * (rowsIn(t) - known.transpose() * rowsProper(tile(t).X)));
        tile(t).X.conservativeResize(q_ + rows.rows(), Eigen::NoChange);
        tile(t).X.bottomRows(rows.rows()) = rows;
    }
    std::vector<Eigen::MatrixXd> rest;
    for (const int t : far) rest.push_back(rowsIn(t));
    Eigen::MatrixXd along = left.back();
    for (int pass = 0; pass < 2 && rank > 0; ++pass) {
        Eigen::MatrixXd part = Eigen::MatrixXd::Zero(count, rank);
        for (std::size_t i = 0; i < far.size(); ++i)
            part += product(rest[i], group_.part(far[i]).V.transpose());
        for (std::size_t i = 0; i < far.size(); ++i) rest[i] -= product(part, group_.part(far[i]).V);
        along += part;
    }
    Eigen::MatrixXd left_over(count, columns);
    columns = 0;
    for (const Eigen::MatrixXd& part : rest) {
        left_over.middleCols(columns, part.cols()) = part;
        columns += static_cast<int>(part.cols());
    }
    left_over = whitener * left_over;
    along = whitener * (along - known.transpose() * rowsProper(group_.W));
    const Eigen::MatrixXd more = turningBasis(left_over, negligibleLength(), 2 * count + 2);
    const int added = static_cast<int>(more.rows());
    Eigen::MatrixXd rows(count, rank + added);
    rows << along, left_over * more.transpose();
    group_.extend(added);
    columns = 0;
    for (const int t : far) {
        group_.part(t).V.bottomRows(added) = more.middleCols(columns, tile(t).width());
        columns += tile(t).width();
    }
    const Eigen::MatrixXd with_turned = withTurned(rows);
    group_.W.conservativeResize(q_ + with_turned.rows(), Eigen::NoChange);
    group_.W.bottomRows(with_turned.rows()) = with_turned;
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
    out.waiting = static_cast<int>(old_groups_.size());
    out.regroupings = regroupings_;
    return out;
}

std::size_t PassiveMap::memory() const {
    Eigen::Index numbers = 0;
    for (const Tile& t : tiles_) numbers += t.X.size() + t.mean.size();
    for (const auto& row : pairs_)
        for (const Pair& p : row) numbers += p.Z.size();
    const auto count = [&numbers](const FarGroup& group) {
        for (const FarGroup::Part& p : group.parts) numbers += p.V.size() + p.C.size() + p.E.size();
        numbers += group.W.size() + group.zeta.size();
    };
    for (const FarGroup& old : old_groups_) count(old);
    count(group_);
    return sizeof(double) * static_cast<std::size_t>(numbers);
}

}  // namespace slamot
