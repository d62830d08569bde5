#include "slamot/core/estimation/CommonConditional.h"

#include <Eigen/Eigenvalues>

namespace slamot {
namespace {

/// The coordinates of the blocks that are put away, or of the others.
std::vector<int> coordinates(const BlockLayout& layout, bool put_away) {
    std::vector<int> out;
    for (const BlockPlace& block : layout.places())
        for (int k = 0; k < block.size && block.put_away == put_away; ++k) out.push_back(block.offset + k);
    return out;
}

}  // namespace

Eigen::MatrixXd pseudoInverse(const Eigen::Ref<const Eigen::MatrixXd>& P) {
    // Units differ between components: the eigenvalues to be judged are those of the correlations.
    const Eigen::VectorXd scale =
        P.diagonal().unaryExpr([](double variance) { return variance > 0 ? 1.0 / std::sqrt(variance) : 0.0; });
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * P * scale.asDiagonal());
    const double floor = 1e-14 * static_cast<double>(P.rows()) * solver.eigenvalues().maxCoeff();
    const Eigen::VectorXd inverse =
        solver.eigenvalues().unaryExpr([floor](double value) { return value > floor ? 1.0 / value : 0.0; });
    const Eigen::MatrixXd V = scale.asDiagonal() * solver.eigenvectors();
    return V * inverse.asDiagonal() * V.transpose();
}

void shareConditional(const BlockLayout& layout, const std::vector<BlockGaussian*>& modes,
                      const Eigen::Ref<const Eigen::VectorXd>& weights, Consistency consistency) {
    const bool invariant = consistency == Consistency::invariant;
    Eigen::Index r = 0;
    weights.maxCoeff(&r);
    const BlockGaussian reference = *modes[static_cast<std::size_t>(r)];
    const int n = reference.dimension();

    // Deviations of the modes' means from the merged one.
    Eigen::MatrixXd dx(n, static_cast<Eigen::Index>(modes.size()));
    for (std::size_t i = 0; i < modes.size(); ++i)
        modes[i]->deviationFrom(reference, dx.col(static_cast<Eigen::Index>(i)));
    const Eigen::VectorXd merged = dx * weights;
    dx.colwise() -= merged;

    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t i = 0; i < modes.size(); ++i) {
        const auto column = static_cast<Eigen::Index>(i);
        if (invariant) modes[i]->transport(layout, -dx.col(column));
        if (weights(column) == 0) continue;
        P += weights(column) * (modes[i]->lower() + dx.col(column) * dx.col(column).transpose());
    }
    P.triangularView<Eigen::StrictlyUpper>() = P.transpose();

    const std::vector<int> a = coordinates(layout, false), b = coordinates(layout, true);
    const Eigen::MatrixXd P_aa = P(a, a), P_bb = P(b, b), A = pseudoInverse(P_aa) * P(a, b);
    for (std::size_t i = 0; i < modes.size(); ++i) {
        BlockGaussian& mode = *modes[i];
        const auto column = static_cast<Eigen::Index>(i);
        Eigen::MatrixXd P_i = mode.lower().selfadjointView<Eigen::Lower>();
        const Eigen::MatrixXd own = P_i(a, a);
        P_i(a, b) = own * A;
        P_i(b, a) = P_i(a, b).transpose();
        P_i(b, b) = P_bb + A.transpose() * (own - P_aa) * A;
        mode.lower().triangularView<Eigen::Lower>() = P_i;

        Eigen::VectorXd moved = dx.col(column);
        moved(b) = A.transpose() * moved(a);
        for (const int k : b) mode.mean()(k) = reference.mean()(k) + merged(k) + moved(k);
        if (invariant) mode.transport(layout, moved);
    }
}

}  // namespace slamot
