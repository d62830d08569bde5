#pragma once
// The innovations of several pairs at once, which joint compatibility judges.
#include <Eigen/Core>
#include <vector>

#include "slamot/core/data/Pose2.h"

namespace slamot {

/// Residuals and their covariance over all candidates of a problem, by number of candidate.
class JointInnovations {
  public:
    virtual ~JointInnovations() = default;
    virtual Vector2 residual(int candidate) const = 0;
    /// E[nu_a nu_b^t], noise included where a = b. Asked for only what is compared; may be kept for next
    /// time.
    virtual Matrix2 covariance(int a, int b) = 0;
};

/// S = L L^t and w = L^-1 nu of a list of pairs that grows and shrinks at its end: adding the k-th costs k^2,
/// taking it away nothing.
class InnovationFactor {
  public:
    InnovationFactor(JointInnovations& innovations, int most_pairs);

    int pairs() const { return static_cast<int>(candidates_.size()); }
    const std::vector<int>& candidates() const { return candidates_; }
    /// nu^t S^-1 nu of all pairs in the list; never smaller with one more.
    double nis() const { return nis_.back(); }
    /// log N of the last pair given all before it.
    double logConditional() const;
    /// The last pair's innovation and its covariance, given all before it.
    struct Conditional {
        Vector2 residual;
        Matrix2 covariance;
    };
    Conditional conditional() const;

    /// false, and nothing done, when S is not positive definite.
    bool push(int candidate);
    void pop();

  private:
    JointInnovations& innovations_;
    std::vector<int> candidates_;
    std::vector<double> nis_{0};
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> L_;
    Eigen::VectorXd w_;
};

}  // namespace slamot
