#include <gtest/gtest.h>

#include <array>

#include "slamot/core/estimation/DenseAlgebra.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace dense_algebra_test {

using test::near;
using test::randomMatrix;

// Sums of up to 40 products of numbers of size one, added in another order than Eigen's.
constexpr double rounding = 1e-13;

TEST(DenseAlgebraTest, DowndateIsEigensOnTheLowerTriangle) {
    RandomStream random(1, RandomPurpose::test);
    for (const auto& [n, m] : {std::pair{1, 1}, {7, 2}, {63, 40}}) {
        const Eigen::MatrixXd A = randomMatrix(random, n, n), W = randomMatrix(random, n, m);
        Eigen::MatrixXd out = A;
        downdateLower(out, W);
        const Eigen::MatrixXd expected = A - W * W.transpose();
        EXPECT_TRUE(near(Eigen::MatrixXd(out.triangularView<Eigen::Lower>()),
                         Eigen::MatrixXd(expected.triangularView<Eigen::Lower>()), rounding));
        EXPECT_EQ(Eigen::MatrixXd(out.triangularView<Eigen::StrictlyUpper>()),
                  Eigen::MatrixXd(A.triangularView<Eigen::StrictlyUpper>()));
    }
}

TEST(DenseAlgebraTest, SolveIsEigens) {
    RandomStream random(2, RandomPurpose::test);
    for (const auto& [n, m] : {std::pair{1, 1}, {7, 2}, {63, 40}}) {
        Eigen::MatrixXd L = randomMatrix(random, m, m) / m;
        L.diagonal().setConstant(2.0);
        const Eigen::MatrixXd W = randomMatrix(random, n, m);
        Eigen::MatrixXd out = W;
        solveLowerTransposedFromRight(L, out);
        const Eigen::MatrixXd lower = L.triangularView<Eigen::Lower>();  // what lies above is not looked at
        EXPECT_TRUE(near(out * lower.transpose(), W, rounding));
    }
}

TEST(DenseAlgebraTest, WorksOnBlocksOfLargerStorage) {
    RandomStream random(3, RandomPurpose::test);
    Eigen::MatrixXd A_storage = randomMatrix(random, 20, 20), W_storage = randomMatrix(random, 15, 9);
    const Eigen::MatrixXd A_before = A_storage, W_before = W_storage;
    downdateLower(A_storage.topLeftCorner(10, 10), W_storage.topLeftCorner(10, 4));
    const Eigen::MatrixXd expected =
        A_before.topLeftCorner(10, 10) -
        W_before.topLeftCorner(10, 4) * W_before.topLeftCorner(10, 4).transpose();
    EXPECT_TRUE(near(Eigen::MatrixXd(A_storage.topLeftCorner(10, 10).triangularView<Eigen::Lower>()),
                     Eigen::MatrixXd(expected.triangularView<Eigen::Lower>()), rounding));
    EXPECT_EQ(A_storage.bottomRows(10), A_before.bottomRows(10));
    EXPECT_EQ(A_storage.rightCols(10), A_before.rightCols(10));
    solveLowerTransposedFromRight(Eigen::Matrix4d::Identity() * 2, W_storage.topLeftCorner(10, 4));
    EXPECT_TRUE(near(W_storage.topLeftCorner(10, 4), W_before.topLeftCorner(10, 4) / 2, rounding));
    EXPECT_EQ(W_storage.rightCols(5), W_before.rightCols(5));
    EXPECT_EQ(W_storage.bottomRows(5), W_before.bottomRows(5));
}

TEST(DenseAlgebraTest, ProductsAreEigens) {
    RandomStream random(4, RandomPurpose::test);
    for (const auto& [n, k, m] : {std::array{1, 1, 1}, {7, 2, 5}, {40, 33, 6}, {5, 0, 4}}) {
        const Eigen::MatrixXd A = randomMatrix(random, n, k), B = randomMatrix(random, k, m),
                              C = randomMatrix(random, n, m);
        const Eigen::MatrixXd A_t = A.transpose(), B_t = B.transpose(), AB = A * B;
        Eigen::MatrixXd out = C;
        multiply(A, B, out);
        EXPECT_TRUE(near(out, AB, rounding));
        out = C;
        addTransposedProduct(A_t, B, out);
        EXPECT_TRUE(near(out, C + AB, rounding));
        EXPECT_TRUE(near(product(A, B), AB, rounding));
        EXPECT_TRUE(near(transposedProduct(A_t, B), AB, rounding));
        EXPECT_TRUE(near(productTransposed(A, B_t), AB, rounding));
    }
}

}  // namespace dense_algebra_test
}  // namespace slamot
