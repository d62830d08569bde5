#pragma once
// The dense kernels that dominate joint filters, through the system's BLAS, which picks the processor's
// widest instructions at run time. One thread, so that results do not depend on the machine's load. The only
// place where BLAS is called.
#include <Eigen/Core>

namespace slamot {

using MatrixIn = Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using MatrixOut = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

/// Lower triangle of A -= W W^t.
void downdateLower(MatrixOut A, const MatrixIn& W);

/// W <- W L^-t with L lower triangular.
void solveLowerTransposedFromRight(const MatrixIn& L, MatrixOut W);

/// C <- A B.
void multiply(const MatrixIn& A, const MatrixIn& B, MatrixOut C);
/// C <- A^t B.
void multiplyTransposed(const MatrixIn& A, const MatrixIn& B, MatrixOut C);
/// C += A B.
void addProduct(const MatrixIn& A, const MatrixIn& B, MatrixOut C);
/// C += A^t B.
void addTransposedProduct(const MatrixIn& A, const MatrixIn& B, MatrixOut C);

/// A B.
Eigen::MatrixXd product(const MatrixIn& A, const MatrixIn& B);
/// A^t B.
Eigen::MatrixXd transposedProduct(const MatrixIn& A, const MatrixIn& B);
/// A B^t.
Eigen::MatrixXd productTransposed(const MatrixIn& A, const MatrixIn& B);

}  // namespace slamot
