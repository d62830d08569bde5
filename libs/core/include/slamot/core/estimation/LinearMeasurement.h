#pragma once
// Linearised measurements, and what conditioning on them says about a filter's model.
#include <array>

#include "slamot/core/data/Pose2.h"
#include "slamot/core/estimation/Blocks.h"

namespace slamot {

/// Up to 2 x 6: Jacobian of a measurement with respect to the leading coordinates of a block.
using MeasurementJacobian = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::ColMajor, 2, 6>;

/// z - h(x) = H dx + noise, for two rows: residual, noise, and H as blocks.
struct LinearMeasurement {
    static constexpr int rows = 2;
    struct Term {
        BlockId block = -1;
        MeasurementJacobian H;
    };
    /// Robot, object and at most one more; blocks differ from one another.
    std::array<Term, 3> terms;
    int term_count = 0;
    Vector2 residual;
    Matrix2 R;

    void add(BlockId block, const MeasurementJacobian& H) { terms[term_count++] = {block, H}; }
};

/// The innovations nu of a batch under their covariance S = L L^t, rows in the order of the batch. A view: it
/// holds until the mode that gave it is updated or mixed again.
class BatchLikelihood {
  public:
    using Factor = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
    using Whitened = Eigen::Map<const Eigen::VectorXd>;

    BatchLikelihood(Factor L, Whitened w) : L_(L), w_(w) {}

    int rows() const { return static_cast<int>(w_.size()); }
    /// L; what stands above the diagonal means nothing.
    const Factor& factor() const { return L_; }
    /// w = L^-1 nu.
    const Whitened& whitened() const { return w_; }

    /// log density of rows [first, first + count) given all rows before them; 0 for no rows. With the
    /// targets' measurements last, this is their likelihood conditional on the landmarks'.
    double logConditional(int first, int count) const;
    /// log density of these rows alone.
    double logMarginal(int first, int count) const;

  private:
    Factor L_;
    Whitened w_;
};

}  // namespace slamot
