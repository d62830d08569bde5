#include "slamot/core/estimation/DenseAlgebra.h"

#include <cblas.h>

namespace slamot {
namespace {

/// OpenBLAS splits work over threads by default; sums would then depend on how many there are.
void useOneThread() {
    static const bool done = (openblas_set_num_threads(1), true);
    static_cast<void>(done);
}

void gemm(CBLAS_TRANSPOSE transpose, const MatrixIn& A, const MatrixIn& B, MatrixOut C) {
    useOneThread();
    if (B.rows() == 0) C.setZero();
    if (C.size() == 0 || B.rows() == 0) return;
    cblas_dgemm(CblasColMajor, transpose, CblasNoTrans, static_cast<int>(C.rows()),
                static_cast<int>(C.cols()), static_cast<int>(B.rows()), 1.0, A.data(),
                static_cast<int>(A.outerStride()), B.data(), static_cast<int>(B.outerStride()), 0.0, C.data(),
                static_cast<int>(C.outerStride()));
}

}  // namespace

void downdateLower(MatrixOut A, const MatrixIn& W) {
    useOneThread();
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, static_cast<int>(A.rows()),
                static_cast<int>(W.cols()), -1.0, W.data(), static_cast<int>(W.outerStride()), 1.0, A.data(),
                static_cast<int>(A.outerStride()));
}

void multiply(const MatrixIn& A, const MatrixIn& B, MatrixOut C) {
    gemm(CblasNoTrans, A, B, C);
}

Eigen::MatrixXd product(const MatrixIn& A, const MatrixIn& B) {
    Eigen::MatrixXd C(A.rows(), B.cols());
    multiply(A, B, C);
    return C;
}

void multiplyTransposed(const MatrixIn& A, const MatrixIn& B, MatrixOut C) {
    gemm(CblasTrans, A, B, C);
}

void solveLowerTransposedFromRight(const MatrixIn& L, MatrixOut W) {
    useOneThread();
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, static_cast<int>(W.rows()),
                static_cast<int>(W.cols()), 1.0, L.data(), static_cast<int>(L.outerStride()), W.data(),
                static_cast<int>(W.outerStride()));
}

}  // namespace slamot
