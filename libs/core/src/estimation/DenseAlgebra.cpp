#include "slamot/core/estimation/DenseAlgebra.h"

#include <cblas.h>

namespace slamot {
namespace {

/// OpenBLAS splits work over threads by default; sums would then depend on how many there are.
void useOneThread() {
    static const bool done = (openblas_set_num_threads(1), true);
    static_cast<void>(done);
}

/// C <- beta C + op(A) op(B), the products of `inner` terms each.
void gemm(CBLAS_TRANSPOSE of_A, const MatrixIn& A, CBLAS_TRANSPOSE of_B, const MatrixIn& B, double beta,
          MatrixOut C) {
    useOneThread();
    const Eigen::Index inner = of_A == CblasNoTrans ? A.cols() : A.rows();
    if (inner == 0 && beta == 0) C.setZero();
    if (C.size() == 0 || inner == 0) return;
    cblas_dgemm(CblasColMajor, of_A, of_B, static_cast<int>(C.rows()), static_cast<int>(C.cols()),
                static_cast<int>(inner), 1.0, A.data(), static_cast<int>(A.outerStride()), B.data(),
                static_cast<int>(B.outerStride()), beta, C.data(), static_cast<int>(C.outerStride()));
}

}  // namespace

void downdateLower(MatrixOut A, const MatrixIn& W) {
    useOneThread();
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, static_cast<int>(A.rows()),
                static_cast<int>(W.cols()), -1.0, W.data(), static_cast<int>(W.outerStride()), 1.0, A.data(),
                static_cast<int>(A.outerStride()));
}

void multiply(const MatrixIn& A, const MatrixIn& B, MatrixOut C) {
    gemm(CblasNoTrans, A, CblasNoTrans, B, 0, C);
}

void multiplyTransposed(const MatrixIn& A, const MatrixIn& B, MatrixOut C) {
    gemm(CblasTrans, A, CblasNoTrans, B, 0, C);
}

void addProduct(const MatrixIn& A, const MatrixIn& B, MatrixOut C) {
    gemm(CblasNoTrans, A, CblasNoTrans, B, 1, C);
}

void addTransposedProduct(const MatrixIn& A, const MatrixIn& B, MatrixOut C) {
    gemm(CblasTrans, A, CblasNoTrans, B, 1, C);
}

Eigen::MatrixXd product(const MatrixIn& A, const MatrixIn& B) {
    Eigen::MatrixXd C(A.rows(), B.cols());
    gemm(CblasNoTrans, A, CblasNoTrans, B, 0, C);
    return C;
}

Eigen::MatrixXd transposedProduct(const MatrixIn& A, const MatrixIn& B) {
    Eigen::MatrixXd C(A.cols(), B.cols());
    gemm(CblasTrans, A, CblasNoTrans, B, 0, C);
    return C;
}

Eigen::MatrixXd productTransposed(const MatrixIn& A, const MatrixIn& B) {
    Eigen::MatrixXd C(A.rows(), B.rows());
    gemm(CblasNoTrans, A, CblasTrans, B, 0, C);
    return C;
}

void solveLowerTransposedFromRight(const MatrixIn& L, MatrixOut W) {
    useOneThread();
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, static_cast<int>(W.rows()),
                static_cast<int>(W.cols()), 1.0, L.data(), static_cast<int>(L.outerStride()), W.data(),
                static_cast<int>(W.outerStride()));
}

}  // namespace slamot
