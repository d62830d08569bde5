#include "slamot/core/estimation/CommonConditional.h"

#include "slamot/core/estimation/SquareRoot.h"

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

Eigen::MatrixXd regression(const Eigen::Ref<const Eigen::MatrixXd>& P_aa,
                           const Eigen::Ref<const Eigen::MatrixXd>& P_ab) {
    // From right to left: rounding then stays in the directions of small variance, where it does no harm. The
    // inverse by itself spreads it over all, times the condition of P_aa.
    const Eigen::MatrixXd whitener = squareRoot(P_aa).whitener;
    return whitener.transpose() * (whitener * P_ab);
}

Eigen::MatrixXd pseudoInverse(const Eigen::Ref<const Eigen::MatrixXd>& P) {
    return regression(P, Eigen::MatrixXd::Identity(P.rows(), P.cols()));
}

MatchedModes matchModes(const BlockLayout& layout, const std::vector<BlockGaussian*>& modes,
                        const Eigen::Ref<const Eigen::VectorXd>& weights, Consistency consistency) {
    Eigen::Index r = 0;
    weights.maxCoeff(&r);
    const BlockGaussian& reference = *modes[static_cast<std::size_t>(r)];
    const int n = reference.dimension();

    MatchedModes out;
    out.deviation.resize(n, static_cast<Eigen::Index>(modes.size()));
    for (std::size_t i = 0; i < modes.size(); ++i)
        modes[i]->deviationFrom(reference, out.deviation.col(static_cast<Eigen::Index>(i)));
    const Eigen::VectorXd merged = out.deviation * weights;
    out.mean = reference.mean() + merged;
    out.deviation.colwise() -= merged;

    out.covariance = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t i = 0; i < modes.size(); ++i) {
        const auto dx = out.deviation.col(static_cast<Eigen::Index>(i));
        const double weight = weights(static_cast<Eigen::Index>(i));
        if (consistency == Consistency::invariant && modes.size() > 1) modes[i]->transport(layout, -dx);
        if (weight == 0) continue;
        out.covariance.triangularView<Eigen::Lower>() += weight * modes[i]->lower();
        if (modes.size() > 1) out.covariance.selfadjointView<Eigen::Lower>().rankUpdate(dx, weight);
    }
    out.covariance.triangularView<Eigen::StrictlyUpper>() = out.covariance.transpose();
    return out;
}

void shareConditional(const BlockLayout& layout, const std::vector<BlockGaussian*>& modes,
                      const Eigen::Ref<const Eigen::VectorXd>& weights, Consistency consistency) {
    const MatchedModes matched = matchModes(layout, modes, weights, consistency);
    const Eigen::MatrixXd& P = matched.covariance;
    const std::vector<int> a = coordinates(layout, false), b = coordinates(layout, true);
    const Eigen::MatrixXd P_aa = P(a, a), P_bb = P(b, b), A = regression(P_aa, P(a, b));
    for (std::size_t i = 0; i < modes.size(); ++i) {
        BlockGaussian& mode = *modes[i];
        Eigen::MatrixXd P_i = mode.lower().selfadjointView<Eigen::Lower>();
        const Eigen::MatrixXd own = P_i(a, a);
        P_i(a, b) = own * A;
        P_i(b, a) = P_i(a, b).transpose();
        P_i(b, b) = P_bb + A.transpose() * (own - P_aa) * A;

        Eigen::VectorXd x = mode.mean(), moved = matched.deviation.col(static_cast<Eigen::Index>(i));
        moved(b) = A.transpose() * moved(a);
        x(b) = matched.mean(b) + moved(b);
        mode.set(x, P_i);
        if (consistency == Consistency::invariant) mode.transport(layout, moved);
    }
}

}  // namespace slamot
