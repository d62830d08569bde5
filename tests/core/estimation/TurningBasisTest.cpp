#include <gtest/gtest.h>

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

}  // namespace
}  // namespace slamot
