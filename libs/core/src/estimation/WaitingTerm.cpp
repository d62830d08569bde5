#include "slamot/core/estimation/WaitingTerm.h"

#include <algorithm>

namespace slamot {

void WaitingTerm::put(int row, const WaitingTerm& other) {
    parts.resize(std::max(parts.size(), other.parts.size()));
    for (int t = 0; t < static_cast<int>(other.parts.size()); ++t) {
        if (other.width(t) == 0) continue;
        Part& own = part(t);
        own.far = other.part(t).far;
        const int before = width(t);
        if (other.width(t) > before) {
            own.F.conservativeResize(rank(), other.width(t));
            own.F.rightCols(other.width(t) - before).setZero();
        }
        own.F.block(row, 0, other.rank(), other.width(t)) = other.part(t).F;
    }
    scale.segment(row, other.rank()) = other.scale;
}

bool WaitingTerm::touches(int s, int t) const {
    if (width(s) == 0 || width(t) == 0) return false;
    return about == About::two_far ? part(s).far && part(t).far : part(s).far != part(t).far;
}

Eigen::MatrixXd WaitingTerm::left(int s, const std::vector<int>& coordinates) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(coordinates.size()), rank());
    for (std::size_t i = 0; i < coordinates.size(); ++i)
        if (coordinates[i] < width(s))
            out.row(static_cast<Eigen::Index>(i)) =
                part(s).F.col(coordinates[i]).cwiseProduct(scale).transpose();
    return out;
}

void WaitingTerm::addTo(int s, int t, MatrixOut P) const {
    const Eigen::MatrixXd scaled = scale.asDiagonal() * part(t).F;
    addTransposedProduct(part(s).F, scaled, P.topLeftCorner(width(s), width(t)));
}

double WaitingTerm::cost(int s, int t) const {
    return touches(s, t) ? 1.0 * rank() * width(s) * width(t) : 0;
}

double WaitingTerm::cost() const {
    double far = 0, far_squared = 0, near = 0;
    for (const Part& p : parts) {
        const auto width = static_cast<double>(p.F.cols());
        (p.far ? far : near) += width;
        far_squared += p.far ? width * width : 0;
    }
    return rank() * (about == About::two_far ? 0.5 * (far * far + far_squared) : near * far);
}

void WaitingTerm::dropColumns(int tile, const std::vector<int>& kept) {
    std::vector<int> known;
    for (const int i : kept)
        if (i < width(tile)) known.push_back(i);
    if (width(tile) > 0) part(tile).F = Eigen::MatrixXd(part(tile).F(Eigen::all, known));
}

}  // namespace slamot
