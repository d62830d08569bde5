#include "slamot/core/association/JointInnovations.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace slamot {

InnovationFactor::InnovationFactor(JointInnovations& innovations, int most_pairs)
    : innovations_(innovations), L_(2 * most_pairs, 2 * most_pairs), w_(2 * most_pairs) {}

bool InnovationFactor::push(int candidate) {
    // [L11 0; L21 L22] with L21 = S21 L11^-t and L22 L22^t = S22 - L21 L21^t.
    const int k = 2 * pairs();
    auto L21 = L_.block(k, 0, 2, k);
    for (int i = 0; i < pairs(); ++i)
        L21.middleCols<2>(2 * i) =
            innovations_.covariance(candidate, candidates_[static_cast<std::size_t>(i)]);
    L_.topLeftCorner(k, k).triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(L21);
    const Matrix2 rest = innovations_.covariance(candidate, candidate) - L21 * L21.transpose();
    const Eigen::LLT<Matrix2> factor(rest);
    if (factor.info() != Eigen::Success) return false;

    L_.block<2, 2>(k, k) = factor.matrixL();
    w_.segment<2>(k) = factor.matrixL().solve(innovations_.residual(candidate) - L21 * w_.head(k));
    candidates_.push_back(candidate);
    nis_.push_back(nis_.back() + w_.segment<2>(k).squaredNorm());
    return true;
}

void InnovationFactor::pop() {
    candidates_.pop_back();
    nis_.pop_back();
}

double InnovationFactor::logConditional() const {
    const int k = 2 * (pairs() - 1);
    return -0.5 * w_.segment<2>(k).squaredNorm() - std::log(L_(k, k) * L_(k + 1, k + 1)) - std::log(2.0 * pi);
}

InnovationFactor::Conditional InnovationFactor::conditional() const {
    const int k = 2 * (pairs() - 1);
    const Matrix2 L = L_.block<2, 2>(k, k);
    return {L * w_.segment<2>(k), L * L.transpose()};
}

}  // namespace slamot
