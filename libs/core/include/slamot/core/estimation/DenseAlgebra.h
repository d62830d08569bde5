#pragma once
// The two dense kernels that dominate joint filters, through the system's BLAS, which picks the processor's widest
// instructions at run time. One thread, so that results do not depend on the machine's load. The only place where
// BLAS is called.
#include <Eigen/Core>

namespace slamot {

/// Lower triangle of A -= W W^t.
void downdateLower(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> A,
                   const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& W);

/// W <- W L^-t with L lower triangular.
void solveLowerTransposedFromRight(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& L,
                                   Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> W);

}  // namespace slamot
