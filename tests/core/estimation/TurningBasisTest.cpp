#include <gtest/gtest.h>

#include <cmath>

#include "slamot/core/data/Pose2.h"
#include "slamot/core/estimation/TurningBasis.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace {

using test::near;
using test::randomMatrix;

TEST(TurningBasisTest, TurnsEveryVector) {
    RandomStream random(1, RandomPurpose::test);
    const Eigen::MatrixXd rows = randomMatrix(random, 3, 8), turned = turnedRows(rows);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 8; k += 2)
            EXPECT_EQ(turned.row(i).segment<2>(k).transpose(),
                      quarterTurn() * rows.row(i).segment<2>(k).transpose());
}

TEST(TurningBasisTest, SpansTheRowsAndTheTurnedRows) {
    // Five rows in the span of two and their turned ones, of very different sizes.
    RandomStream random(2, RandomPurpose::test);
    Eigen::MatrixXd seeds(4, 20);
    seeds.topRows<2>() = randomMatrix(random, 2, 20);
    seeds.row(1) *= 1e-5;
    seeds.bottomRows<2>() = turnedRows(seeds.topRows<2>());
    const Eigen::MatrixXd rows = randomMatrix(random, 5, 4) * seeds;
    const Eigen::MatrixXd Y = turningBasis(rows, 1e-10, 20);
    ASSERT_EQ(Y.rows(), 4);
    EXPECT_TRUE(near(Y * Y.transpose(), Eigen::MatrixXd::Identity(4, 4), 1e-12));
    EXPECT_TRUE(near(rows * Y.transpose() * Y, rows, 1e-10));
    EXPECT_TRUE(near(turnedRows(rows) * Y.transpose() * Y, turnedRows(rows), 1e-10));
    for (int k = 0; k < 4; k += 2) EXPECT_EQ(Y.row(k + 1), turnedRows(Y.row(k)).row(0));
    // What is below the tolerance is left out, what does not fit is refused.
    EXPECT_EQ(turningBasis(rows, 1e-3, 20).rows(), 2);
    EXPECT_EQ(turningBasis(rows, 1e-10, 3).rows(), 0);
    EXPECT_EQ(turningBasis(Eigen::MatrixXd::Zero(3, 4), 1e-10, 4).rows(), 0);
    EXPECT_EQ(turningBasis(Eigen::MatrixXd(0, 4), 1e-10, 4).rows(), 0);
}

TEST(TurningBasisTest, ManyRowsOfAllSizes) {
    // More than a panel of pivots, of lengths from 1 to 1e-12: what the panels' lengths are told by loses
    // half the digits, and must not show.
    RandomStream random(6, RandomPurpose::test);
    Eigen::MatrixXd rows = randomMatrix(random, 60, 150);
    for (int i = 0; i < 60; ++i) rows.row(i) *= std::pow(10.0, -i / 5.0);
    const Eigen::MatrixXd Y = turningBasis(rows, 1e-11, 150);
    const auto n = Y.rows();
    EXPECT_GT(n, 2 * 45);
    EXPECT_TRUE(near(Y * Y.transpose(), Eigen::MatrixXd::Identity(n, n), 1e-12));
    EXPECT_LE((rows - rows * Y.transpose() * Y).rowwise().norm().maxCoeff(), 2e-11);
}

/// Rows over two parts of 12 and 8 coordinates in pairs: the first pair is of length one, the second of 1e-3,
/// the third of `left`.
CutRows rowsOf(double left) {
    RandomStream random(3, RandomPurpose::test);
    Eigen::MatrixXd rows = randomMatrix(random, 3, 20);
    rows.row(1) *= 1e-3;
    rows.row(2) *= left;
    const Eigen::MatrixXd V = withTurnedRows(rows);
    return {V.leftCols(12), V.rightCols(8)};
}

Eigen::MatrixXd joined(const CutRows& rows) {
    Eigen::MatrixXd out(rows[0].rows(), rows[0].cols() + rows[1].cols());
    out << rows[0], rows[1];
    return out;
}

TEST(TurningBasisTest, OrthonormalRowsKeepWhatLittleIsLeftOfADirection) {
    // The Gram matrix of V has the square of what is left, which is below its own rounding here: 1e-22
    // beside 1.
    RandomStream random(4, RandomPurpose::test);
    Eigen::MatrixXd W = randomMatrix(random, 8, 6);
    W.rightCols<2>() *= 1e6;
    for (const double left : {1e-6, 1e-9, 1e-11}) {
        const CutRows V = rowsOf(left);
        const OrthonormalRows orthonormal(W, {&V[0], &V[1]}, 1e-12);
        ASSERT_EQ(orthonormal.rank(), 6) << left;
        const Eigen::MatrixXd unit = joined(orthonormal.times(Eigen::MatrixXd::Identity(6, 6)));
        EXPECT_TRUE(near(unit * unit.transpose(), Eigen::MatrixXd::Identity(6, 6), 1e-7)) << left;
        // The third pair's share of W V is 1e6 left; rounding is 1e-16 of W.
        EXPECT_TRUE(near(orthonormal.W() * unit, W * joined(V), 1e-9 * (1e6 * left) + 1e-14)) << left;
        for (int k = 0; k < 6; k += 2) EXPECT_EQ(unit.row(k + 1), turnedRows(unit.row(k)).row(0));
        // Combinations of the rows, closed under the quarter turn.
        const Eigen::MatrixXd K = withTurnedRows(randomMatrix(random, 2, 6));
        EXPECT_TRUE(near(joined(orthonormal.times(K)), K * unit, 1e-12));
    }
}

TEST(TurningBasisTest, OrthonormalRowsDropWhatSaysNothing) {
    RandomStream random(5, RandomPurpose::test);
    const Eigen::MatrixXd W = randomMatrix(random, 8, 6);
    const CutRows V = rowsOf(1e-13);
    const OrthonormalRows orthonormal(W, {&V[0], &V[1]}, 1e-9);
    ASSERT_EQ(orthonormal.rank(), 4);
    const Eigen::MatrixXd unit = joined(orthonormal.times(Eigen::MatrixXd::Identity(4, 4)));
    EXPECT_TRUE(near(orthonormal.W() * unit, W * joined(V), 1e-9));
    EXPECT_EQ(OrthonormalRows(W, {&V[0], &V[1]}, 1e6).rank(), 0);
    EXPECT_EQ(OrthonormalRows(W, {}, 1e-9).rank(), 0) << "no part is left: no direction either";
}

}  // namespace
}  // namespace slamot
