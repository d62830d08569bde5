#include <gtest/gtest.h>

#include <Eigen/QR>

#include "slamot/core/estimation/FarGroup.h"
#include "slamot/core/estimation/TurningBasis.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace {

using test::near;
using test::randomMatrix;

constexpr int width = 12;

/// A basis whose first pair lives in both tiles alike, the second nearly, the third all but entirely in the
/// tile that leaves, of which `left` remains in the one that stays.
FarGroup groupWith(double left, const Eigen::MatrixXd& W) {
    RandomStream random(3, RandomPurpose::test);
    Eigen::MatrixXd rows = randomMatrix(random, 3, width);
    rows.row(1) *= 1e-3;
    rows.row(2) *= left;
    Eigen::MatrixXd V(6, width);
    for (int k = 0; k < 3; ++k) {
        V.row(2 * k) = rows.row(k);
        V.row(2 * k + 1) = turnedRows(rows.row(k));
    }
    FarGroup group;
    group.parts.resize(2);
    group.part(1).far = true;
    group.part(1).V = V;
    group.W = W;
    return group;
}

TEST(FarGroupTest, OrthonormalisingKeepsWhatLittleIsLeftOfADirection) {
    // The Gram matrix of V has the square of what is left, which is below its own rounding here: 1e-22
    // beside 1.
    RandomStream random(4, RandomPurpose::test);
    Eigen::MatrixXd W = randomMatrix(random, 8, 6);
    W.rightCols<2>() *= 1e6;
    for (const double left : {1e-6, 1e-9, 1e-11}) {
        FarGroup group = groupWith(left, W);
        const Eigen::MatrixXd before = group.part(1).V;
        group.orthonormalise(1e-12);
        const Eigen::MatrixXd& V = group.part(1).V;
        ASSERT_EQ(group.rank(), 6) << left;
        EXPECT_TRUE(near(V * V.transpose(), Eigen::MatrixXd::Identity(6, 6), 1e-7)) << left;
        // The third pair's share of W V is 1e6 left; rounding is 1e-16 of W.
        EXPECT_TRUE(near(group.W * V, W * before, 1e-9 * (1e6 * left) + 1e-14)) << left;
        for (int k = 0; k < 6; k += 2) EXPECT_EQ(V.row(k + 1), turnedRows(V.row(k)).row(0));
    }
}

TEST(FarGroupTest, OrthonormalisingDropsWhatSaysNothing) {
    RandomStream random(5, RandomPurpose::test);
    const Eigen::MatrixXd W = randomMatrix(random, 8, 6);
    FarGroup group = groupWith(1e-13, W);
    const Eigen::MatrixXd before = group.part(1).V;
    group.orthonormalise(1e-9);
    EXPECT_EQ(group.rank(), 4);
    EXPECT_TRUE(near(group.W * group.part(1).V, W * before, 1e-9));
    // No far tile is left: no direction either.
    group.part(1).far = false;
    group.orthonormalise(1e-9);
    EXPECT_EQ(group.rank(), 0);
}

}  // namespace
}  // namespace slamot
