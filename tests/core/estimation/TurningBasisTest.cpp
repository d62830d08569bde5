#include <gtest/gtest.h>

#include <cmath>

#include "slamot/core/data/Pose2.h"
#include "slamot/core/estimation/TurningBasis.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace turning_basis_test {

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
    const Eigen::MatrixXd Y = turningBasis(rows, 1e-10);
    ASSERT_EQ(Y.rows(), 4);
    EXPECT_TRUE(near(Y * Y.transpose(), Eigen::MatrixXd::Identity(4, 4), 1e-12));
    EXPECT_TRUE(near(rows * Y.transpose() * Y, rows, 1e-10));
    EXPECT_TRUE(near(turnedRows(rows) * Y.transpose() * Y, turnedRows(rows), 1e-10));
    for (int k = 0; k < 4; k += 2) EXPECT_EQ(Y.row(k + 1), turnedRows(Y.row(k)).row(0));
    // What is below the tolerance is left out.
    EXPECT_EQ(turningBasis(rows, 1e-3).rows(), 2);
    EXPECT_EQ(turningBasis(Eigen::MatrixXd::Zero(3, 4), 1e-10).rows(), 0);
    EXPECT_EQ(turningBasis(Eigen::MatrixXd(0, 4), 1e-10).rows(), 0);
}

TEST(TurningBasisTest, NoMoreRowsThanColumns) {
    // A tolerance of nothing would go on with rounding; rows of the whole space span it.
    RandomStream random(7, RandomPurpose::test);
    const Eigen::MatrixXd Y = turningBasis(randomMatrix(random, 30, 10), 0);
    ASSERT_EQ(Y.rows(), 10);
    EXPECT_TRUE(near(Y * Y.transpose(), Eigen::MatrixXd::Identity(10, 10), 1e-12));
}

TEST(TurningBasisTest, ManyRowsOfAllSizes) {
    // More than a panel of pivots, of lengths from 1 to 1e-12: what the panels' lengths are told by loses
    // half the digits, and must not show.
    RandomStream random(6, RandomPurpose::test);
    Eigen::MatrixXd rows = randomMatrix(random, 60, 150);
    for (int i = 0; i < 60; ++i) rows.row(i) *= std::pow(10.0, -i / 5.0);
    const Eigen::MatrixXd Y = turningBasis(rows, 1e-11);
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

/// Rows over the two parts, three of them: 1e6 along V, and `left` beside it in random directions.
CutRows mostlyAlong(const Eigen::MatrixXd& V, double left) {
    RandomStream random(9, RandomPurpose::test);
    const Eigen::MatrixXd rows =
        1e6 * randomMatrix(random, 3, static_cast<int>(V.rows())) * V + left * randomMatrix(random, 3, 20);
    return {rows.leftCols(12), rows.rightCols(8)};
}

TEST(TurningBasisTest, DirectionsBeyondABasisAreOrthogonalToIt) {
    // V is orthonormal to half the digits, as it may be. Taken out of the rows once, 1e-8 of it stays there,
    // of rows of 1e6; twice, 1e-16 and rounding: as much as what is left beside V, or more, and above what
    // may go.
    RandomStream random(8, RandomPurpose::test);
    Eigen::MatrixXd basis = turningBasis(randomMatrix(random, 3, 20), 1e-12);
    basis += 1e-8 * withTurnedRows(randomMatrix(random, 3, 20));
    const CutRows V{basis.leftCols(12), basis.rightCols(8)};
    for (const double left : {1e-3, 1e-7, 1e-9, 0.0}) {
        const CutRows rows = mostlyAlong(basis, left);
        const BeyondBasis parts({&V[0], &V[1]}, rows, 3, 1e-12);
        const Eigen::MatrixXd beyond = joined(parts.directions);
        const auto n = beyond.rows();
        ASSERT_EQ(parts.weights.cols(), n);
        EXPECT_LE(n, 6) << "no more than the rows and their turned ones";
        EXPECT_TRUE(near(beyond * basis.transpose(), Eigen::MatrixXd::Zero(n, 6), 1e-10)) << left;
        EXPECT_TRUE(near(beyond * beyond.transpose(), Eigen::MatrixXd::Identity(n, n), 1e-7)) << left;
        for (int k = 0; k < n; k += 2) EXPECT_EQ(beyond.row(k + 1), turnedRows(beyond.row(k)).row(0));
        // Nothing is lost but rounding.
        EXPECT_TRUE(near(parts.along * basis + parts.weights * beyond, joined(rows), 1e-8)) << left;
    }
}

TEST(TurningBasisTest, BeyondABasisOnlyWhatIsWorthIt) {
    RandomStream random(8, RandomPurpose::test);
    const Eigen::MatrixXd basis = turningBasis(randomMatrix(random, 3, 20), 1e-12);
    const CutRows V{basis.leftCols(12), basis.rightCols(8)};
    const CutRows rows = mostlyAlong(basis, 1e-3);
    EXPECT_EQ(BeyondBasis({&V[0], &V[1]}, rows, 3, 1e-6).weights.cols(), 6);
    const BeyondBasis parts({&V[0], &V[1]}, rows, 3, 1.0);
    EXPECT_EQ(parts.weights.cols(), 0);
    EXPECT_TRUE(near(parts.along * basis, joined(rows), 1.0));
    // Of no V at all the rows themselves are beyond; of no part, nothing is.
    const CutRows none{Eigen::MatrixXd(0, 12), Eigen::MatrixXd(0, 8)};
    const BeyondBasis all({&none[0], &none[1]}, rows, 3, 1e-12);
    EXPECT_TRUE(near(all.weights * joined(all.directions), joined(rows), 1e-8));
    const BeyondBasis nothing({}, {}, 3, 1e-12);
    EXPECT_EQ(nothing.along, Eigen::MatrixXd(3, 0));
    EXPECT_EQ(nothing.weights, Eigen::MatrixXd(3, 0));
}

}  // namespace turning_basis_test
}  // namespace slamot
