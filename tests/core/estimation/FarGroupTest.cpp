#include <gtest/gtest.h>

#include "slamot/core/estimation/FarGroup.h"
#include "slamot/core/estimation/TurningBasis.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace far_group_test {

using test::near;
using test::randomMatrix;

/// A near tile of 4 coordinates and two far ones of 6 and 8, with 4 directions; zeta has two eigenvalues of
/// size one and two of 1e-9.
FarGroup someGroup() {
    RandomStream random(1, RandomPurpose::test);
    FarGroup group;
    group.parts.resize(3);
    group.part(0).C = randomMatrix(random, 4, 4);
    const Eigen::MatrixXd V = turningBasis(randomMatrix(random, 2, 14), 1e-12);
    group.part(1) = {true, V.leftCols(6), {}};
    group.part(2) = {true, V.rightCols(8), {}};
    group.W = randomMatrix(random, 5, 4);
    const Eigen::MatrixXd Q = turningBasis(randomMatrix(random, 2, 4), 1e-12);
    group.zeta = Q.transpose() * Eigen::Vector4d(1, -2, 1e-9, -1e-9).asDiagonal() * Q;
    group.shift = Eigen::VectorXd::Zero(4);
    return group;
}

TEST(FarGroupTest, WhatWaitsGoesOverIntoTerms) {
    FarGroup group = someGroup();
    const Eigen::MatrixXd V_1 = group.part(1).V, V_2 = group.part(2).V, C = group.part(0).C;
    EXPECT_TRUE(near(group.left(0, 2, 2) * V_1, C.bottomRows(2) * V_1, 1e-15));
    EXPECT_TRUE(near(group.left(1, 2, 2) * V_2, V_1.middleCols(2, 2).transpose() * group.zeta * V_2, 1e-14));

    const WaitingTerm two_far = group.aboutTwoFar(1e-8);
    EXPECT_EQ(two_far.rank(), 2) << "eigenvalues below 1e-8 are left out";
    EXPECT_FALSE(two_far.touches(0, 1));
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(6, 8);
    two_far.addTo(1, 2, P);
    EXPECT_TRUE(near(P, V_1.transpose() * group.zeta * V_2, 3e-9));
    EXPECT_GT(two_far.cost(1, 1), 0);

    const WaitingTerm near_and_far = group.takeNearAndFar();
    EXPECT_FALSE(near_and_far.touches(1, 2));
    EXPECT_FALSE(near_and_far.touches(0, 0));
    P = Eigen::MatrixXd::Zero(4, 8);
    near_and_far.addTo(0, 2, P);
    EXPECT_TRUE(near(P, C * V_2, 1e-14));
    P = Eigen::MatrixXd::Zero(6, 4);
    near_and_far.addTo(1, 0, P);
    EXPECT_TRUE(near(P, (C * V_1).transpose(), 1e-14));
}

TEST(FarGroupTest, MoreDirectionsChangeNothingYet) {
    FarGroup group = someGroup();
    const FarGroup before = group;
    group.extend(2);
    EXPECT_EQ(group.rank(), 6);
    EXPECT_TRUE(near(group.W * group.part(1).V, before.W * before.part(1).V, 1e-15));
    EXPECT_TRUE(near(group.left(1, 0, 6) * group.part(2).V, before.left(1, 0, 6) * before.part(2).V, 1e-15));
    EXPECT_TRUE(near(group.left(0, 0, 4) * group.part(2).V, before.left(0, 0, 4) * before.part(2).V, 1e-15));
    group.dropColumns(1, {0, 1, 4, 5});
    EXPECT_EQ(group.part(1).V.leftCols(2).topRows(4), before.part(1).V.leftCols(2));
    EXPECT_EQ(group.part(1).V.rightCols(2).topRows(4), before.part(1).V.rightCols(2));
    EXPECT_EQ(group.part(1).V.bottomRows(2), Eigen::MatrixXd::Zero(2, 4));
}

}  // namespace far_group_test
}  // namespace slamot
