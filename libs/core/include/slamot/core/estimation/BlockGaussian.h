#pragma once
// Mean and covariance over the coordinates of a BlockLayout: the arithmetic of joint filters, for engines to
// build on. The robot is the first block.
#include <vector>

#include "slamot/core/estimation/BlockLayout.h"
#include "slamot/core/estimation/LinearMeasurement.h"

namespace slamot {

/// Only the lower triangle of the covariance is kept and worked on: it is symmetric by construction. Storage
/// grows by doubling, so that steps do not allocate once sizes have settled. The covariance need not be
/// definite, as long as every S is: an engine may have formal coordinates among its blocks.
class BlockGaussian {
  public:
    int dimension() const { return n_; }
    auto mean() const { return x_.head(n_); }
    auto mean() { return x_.head(n_); }
    /// n x n, its lower triangle.
    auto lower() const { return P_.topLeftCorner(n_, n_); }
    auto lower() { return P_.topLeftCorner(n_, n_); }
    BlockMatrix covariance(const BlockPlace& a, const BlockPlace& b) const;
    /// Of many blocks, in the order given.
    Eigen::MatrixXd jointCovariance(const BlockLayout& layout, const std::vector<BlockId>& blocks) const;
    /// Columns [first, first + out.cols()) of the symmetric matrix, whole.
    void gatherColumns(int first, Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> out) const;

    /// Takes over mean and covariance (its lower triangle).
    void set(const Eigen::Ref<const Eigen::VectorXd>& mean,
             const Eigen::Ref<const Eigen::MatrixXd>& covariance);
    /// `count` more coordinates at the end, with zero mean and covariance.
    void append(int count);
    void remove(int offset, int count);

    /// Appends a block that depends by G on the pose whose coordinates begin at `from`.
    void augment(const NewBlock& block, int from);
    void propagate(const BlockLayout& layout, BlockId block, const Eigen::Ref<const Eigen::VectorXd>& mean,
                   const Eigen::Ref<const Eigen::MatrixXd>& F, const Eigen::Ref<const Eigen::MatrixXd>& Q,
                   const std::vector<Coupling>& couplings);
    BatchLikelihood update(const BlockLayout& layout, const std::vector<LinearMeasurement>& batch,
                           Consistency consistency);
    /// P <- D P D^t for a mean that has moved by dx.
    void transport(const BlockLayout& layout, const Eigen::Ref<const Eigen::VectorXd>& dx);

    /// Becomes the moment-matched mixture of `modes`, none of which is this, as JointBank::mix says.
    void setMixture(const BlockLayout& layout, const std::vector<const BlockGaussian*>& modes,
                    const Eigen::Ref<const Eigen::VectorXd>& weights, Consistency consistency);

    /// x - from, with the heading's difference wrapped.
    void deviationFrom(const BlockGaussian& from, Eigen::Ref<Eigen::VectorXd> out) const;

  private:
    void reserve(int dimension);
    void reserveBatch(int rows);
    void scatterColumns(int first, const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& columns);
    void addTransport(const BlockLayout& layout, const BlockGaussian& from,
                      const Eigen::Ref<const Eigen::VectorXd>& dx, double weight);

    int n_ = 0;
    Eigen::VectorXd x_;
    Eigen::MatrixXd P_;  ///< lower triangle of the leading n_ x n_
    // Work space, kept so that steps need not allocate.
    Eigen::MatrixXd PHt_, S_, robot_columns_, columns_, moved_;
    Eigen::VectorXd nu_, dx_, shift_;
};

}  // namespace slamot
