#include "slamot/core/estimation/DenseAlgebra.h"

#include <cblas.h>

namespace slamot {
namespace {

/// OpenBLAS splits work over threads by default; sums would then depend on how many there are.
void useOneThread() {
    static const bool done = (openblas_set_num_threads(1), true);
    static_cast<void>(done);
}

}  // namespace

void downdateLower(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> A,
                   const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& W) {
    useOneThread();
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, static_cast<int>(A.rows()), static_cast<int>(W.cols()),
                -1.0, W.data(), static_cast<int>(W.outerStride()), 1.0, A.data(), static_cast<int>(A.outerStride()));
}

void solveLowerTransposedFromRight(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& L,
                                   Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> W) {
    useOneThread();
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, static_cast<int>(W.rows()),
                static_cast<int>(W.cols()), 1.0, L.data(), static_cast<int>(L.outerStride()), W.data(),
                static_cast<int>(W.outerStride()));
}

}  // namespace slamot
