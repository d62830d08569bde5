#pragma once
// Joint innovations of linearised measurements of one Gaussian: S_ab = H_a P H_b^t, + R where a = b. What an
// update with those measurements would take as its S.
#include <vector>

#include "slamot/core/association/JointInnovations.h"
#include "slamot/core/estimation/JointBank.h"

namespace slamot {

/// Looks at the state when asked: it must not change meanwhile. Keeps what it has computed; memory and time
/// grow with the pairs compared, at most the square of the candidates.
class LinearInnovations : public JointInnovations {
  public:
    LinearInnovations(const JointView& state, const std::vector<LinearMeasurement>& by_candidate)
        : state_(state), measurements_(by_candidate), rows_(by_candidate.size()) {}

    Vector2 residual(int candidate) const override;
    Matrix2 covariance(int a, int b) override;

  private:
    Matrix2 compute(int a, int b) const;

    const JointView& state_;
    const std::vector<LinearMeasurement>& measurements_;
    std::vector<std::vector<Matrix2>> rows_;  ///< [a][b], b <= a; empty, or NaN where not yet asked for
};

}  // namespace slamot
