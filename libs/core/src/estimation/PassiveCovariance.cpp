#include "slamot/core/estimation/PassiveCovariance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slamot {
namespace {

/// Terms about two far tiles, of few directions each, touch nearly every block: several are gathered to one
/// of this rank, so that a block is not fetched from memory for every one of them.
constexpr int gathered_rank = 128;
/// Terms of a kind that may wait; more would make rows dear.
constexpr std::size_t most_waiting = 3;

}  // namespace

bool PassiveCovariance::Queue::added(int a, int b) const {
    const int first = std::min(a, b), second = std::max(a, b);
    return second < t || (second == t && first < s);
}

void PassiveCovariance::addTile() {
    blocks_.emplace_back(blocks_.size() + 1);
}

void PassiveCovariance::clearTile(int t) {
    for (int s = 0; s < tileCount(); ++s) block(std::min(s, t), std::max(s, t)).resize(0, 0);
}

Eigen::MatrixXd& PassiveCovariance::blockOfAtLeast(int s, int t, Eigen::Index rows, Eigen::Index cols) {
    Eigen::MatrixXd& Z = block(s, t);
    rows = std::max(rows, Z.rows());
    cols = std::max(cols, Z.cols());
    if (rows == Z.rows() && cols == Z.cols()) return Z;
    Eigen::MatrixXd larger = Eigen::MatrixXd::Zero(rows, cols);
    larger.topLeftCorner(Z.rows(), Z.cols()) = Z;
    Z.swap(larger);
    return Z;
}

void PassiveCovariance::add(int s, int row, int t, int column, const Eigen::Ref<const Eigen::MatrixXd>& P) {
    if (s > t) return add(t, column, s, row, P.transpose());
    blockOfAtLeast(s, t, row + P.rows(), column + P.cols()).block(row, column, P.rows(), P.cols()) += P;
}

void PassiveCovariance::addProduct(int s, int t, const MatrixIn& A, const MatrixIn& B) {
    if (s > t) return addProduct(t, s, B, A);
    addTransposedProduct(A, B, blockOfAtLeast(s, t, A.cols(), B.cols()).topLeftCorner(A.cols(), B.cols()));
}

void PassiveCovariance::addWaiting(WaitingTerm near_and_far, const WaitingTerm& two_far) {
    if (near_and_far.rank() > 0) push(near_and_far_, std::move(near_and_far));
    if (two_far.rank() > 0) gather(two_far);
}

void PassiveCovariance::gather(const WaitingTerm& two_far) {
    if (gathered_ + two_far.rank() > gathering_.rank()) {
        if (gathered_ > 0) push(two_far_, std::move(gathering_));
        gathering_ = {};
        gathering_.scale = Eigen::VectorXd::Zero(std::max(gathered_rank, two_far.rank()));
        gathered_ = 0;
    }
    gathering_.put(gathered_, two_far);
    gathered_ += two_far.rank();
}

void PassiveCovariance::push(Queue& queue, WaitingTerm term) {
    while (queue.terms.size() >= most_waiting) work(queue, std::numeric_limits<double>::infinity());
    queue.pending += term.cost();
    queue.terms.push_back(std::move(term));
    // Done by the time the next one comes, if that takes as many steps as this one took.
    queue.per_step = queue.pending / std::max(1.0, 0.8 * static_cast<double>(queue.steps));
    queue.steps = 0;
}

void PassiveCovariance::step() {
    for (Queue* queue : {&near_and_far_, &two_far_}) {
        ++queue->steps;
        work(*queue, queue->per_step);
    }
}

void PassiveCovariance::work(Queue& queue, double multiplications) {
    while (multiplications > 0 && !queue.terms.empty()) {
        const WaitingTerm& oldest = queue.terms.front();
        if (queue.t >= static_cast<int>(oldest.parts.size())) {
            queue.terms.pop_front();
            queue.s = queue.t = 0;
            if (queue.terms.empty()) queue.pending = 0;
            if (std::isinf(multiplications)) return;
            continue;
        }
        const int s = queue.s, t = queue.t;
        if (++queue.s > t) {
            ++queue.t;
            queue.s = 0;
        }
        if (!oldest.touches(s, t)) continue;
        oldest.addTo(s, t, blockOfAtLeast(s, t, oldest.width(s), oldest.width(t)));
        multiplications -= oldest.cost(s, t);
        queue.pending -= oldest.cost(s, t);
    }
}

template <class Action>
void PassiveCovariance::forWaiting(const Action& action) {
    for (Queue* queue : {&near_and_far_, &two_far_})
        for (WaitingTerm& term : queue->terms) action(term, &term == &queue->terms.front() ? queue : nullptr);
    if (gathered_ > 0) action(gathering_, nullptr);
}

template <class Action>
void PassiveCovariance::forWaiting(const Action& action) const {
    const_cast<PassiveCovariance*>(this)->forWaiting(
        [&action](const WaitingTerm& term, const Queue* adding) { action(term, adding); });
}

Matrix2 PassiveCovariance::covariance(int s, int row, int t, int column) const {
    if (s > t) return covariance(t, column, s, row).transpose();
    const Eigen::MatrixXd& Z = block(s, t);
    Matrix2 out = Matrix2::Zero();
    if (row < Z.rows() && column < Z.cols()) out = Z.block<2, 2>(row, column);
    forWaiting([&](const WaitingTerm& term, const Queue* adding) {
        if (!term.touches(s, t) || (adding != nullptr && adding->added(s, t))) return;
        if (row < term.width(s) && column < term.width(t))
            out += term.left(s, {row, row + 1}) * term.part(t).F.middleCols<2>(column);
    });
    return out;
}

void PassiveCovariance::drop(int tile, const std::vector<int>& kept) {
    for (int other = 0; other < tileCount(); ++other) {
        Eigen::MatrixXd& Z = block(std::min(other, tile), std::max(other, tile));
        if (Z.size() == 0) continue;
        std::vector<int> stored;
        for (const int i : kept)
            if (i < (other <= tile ? Z.cols() : Z.rows())) stored.push_back(i);
        if (other <= tile) Z = Eigen::MatrixXd(Z(Eigen::all, stored));
        if (other >= tile) Z = Eigen::MatrixXd(Z(stored, Eigen::all));
    }
    forWaiting([&](WaitingTerm& term, const Queue*) { term.dropColumns(tile, kept); });
}

double PassiveCovariance::longestStd() const {
    double variance = 0;
    for (int t = 0; t < tileCount(); ++t)
        if (block(t, t).size() > 0) variance = std::max(variance, block(t, t).diagonal().maxCoeff());
    return std::sqrt(variance);
}

int PassiveCovariance::waiting() const {
    int count = 0;
    forWaiting([&count](const WaitingTerm&, const Queue*) { ++count; });
    return count;
}

std::size_t PassiveCovariance::memory() const {
    Eigen::Index numbers = 0;
    for (const auto& row : blocks_)
        for (const Eigen::MatrixXd& Z : row) numbers += Z.size();
    forWaiting([&numbers](const WaitingTerm& term, const Queue*) {
        for (const WaitingTerm::Part& part : term.parts) numbers += part.F.size();
    });
    return sizeof(double) * static_cast<std::size_t>(numbers);
}

PassiveCovariance::Rows::Rows(const PassiveCovariance& covariance, const std::vector<Landmark>& landmarks)
    : covariance_(&covariance) {
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
        const auto& [tile, first] = landmarks[i];
        const auto same = [tile = tile](const Group& group) { return group.tile == tile; };
        auto group = std::find_if(groups_.begin(), groups_.end(), same);
        if (group == groups_.end()) group = groups_.insert(group, {tile, {}, {}});
        for (const int k : {0, 1}) {
            group->rows.push_back(2 * static_cast<int>(i) + k);
            group->coordinates.push_back(first + k);
        }
    }
    covariance.forWaiting([this](const WaitingTerm& term, const Queue* adding) {
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            const auto& [tile, rows, coordinates] = groups_[g];
            if (term.width(tile) == 0) continue;
            left_.push_back({&term, adding, g, term.left(tile, coordinates)});
        }
    });
}

Eigen::MatrixXd PassiveCovariance::Rows::with(int t, int width) const {
    Eigen::Index count = 0;
    for (const Group& group : groups_) count += static_cast<Eigen::Index>(group.rows.size());
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(count, width);
    for (const auto& [s, rows, coordinates] : groups_) {
        const Eigen::MatrixXd& Z = covariance_->block(std::min(s, t), std::max(s, t));
        for (std::size_t i = 0; i < rows.size() && s > t; ++i)
            if (coordinates[i] < Z.cols())
                out.row(rows[i]).head(Z.rows()) = Z.col(coordinates[i]).transpose();
        for (Eigen::Index j = 0; j < Z.cols() && s <= t; ++j)
            for (std::size_t i = 0; i < rows.size(); ++i)
                if (coordinates[i] < Z.rows()) out(rows[i], j) = Z(coordinates[i], j);
    }
    for (const auto& [term, adding, g, left] : left_) {
        const Group& group = groups_[g];
        if (!term->touches(group.tile, t) || (adding != nullptr && adding->added(group.tile, t))) continue;
        const Eigen::MatrixXd waiting = product(left, term->part(t).F);
        for (Eigen::Index j = 0; j < waiting.cols(); ++j)
            for (std::size_t i = 0; i < group.rows.size(); ++i)
                out(group.rows[i], j) += waiting(static_cast<Eigen::Index>(i), j);
    }
    return out;
}

}  // namespace slamot
