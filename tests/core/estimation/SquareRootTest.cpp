#include <gtest/gtest.h>

#include "slamot/core/estimation/SquareRoot.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace square_root_test {

using test::near;

TEST(SquareRootTest, GivesPBackAndWhitensIt) {
    RandomStream random(1, RandomPurpose::test);
    // Metres and radians: variances of 1e4 and 1e-6 side by side.
    Eigen::VectorXd scale = Eigen::VectorXd::Constant(9, 100.0);
    scale.tail<3>().setConstant(1e-3);
    const Eigen::MatrixXd P = scale.asDiagonal() * test::randomCovariance(random, 9) * scale.asDiagonal();
    const SquareRoot root = squareRoot(P);
    const Eigen::MatrixXd unit = scale.cwiseInverse().asDiagonal();
    EXPECT_TRUE(near(unit * root.root * root.root.transpose() * unit, unit * P * unit, 1e-14));
    EXPECT_TRUE(near(root.whitener * P * root.whitener.transpose(), Eigen::MatrixXd::Identity(9, 9), 1e-11));
    EXPECT_EQ(root.unknown(), Eigen::VectorXd::Ones(9));
}

TEST(SquareRootTest, LeavesOutWhatIsKnownExactly) {
    // One coordinate without variance, and two that always move together.
    RandomStream random(2, RandomPurpose::test);
    Eigen::MatrixXd A = test::randomMatrix(random, 6, 6);
    A.row(2).setZero();
    A.row(5) = A.row(4);
    const Eigen::MatrixXd P = A * A.transpose();
    const SquareRoot root = squareRoot(P);
    EXPECT_TRUE(near(root.root * root.root.transpose(), P, 1e-13));
    EXPECT_EQ(root.unknown().sum(), 4);
    const Eigen::MatrixXd white = root.whitener * P * root.whitener.transpose();
    EXPECT_TRUE(near(white, Eigen::MatrixXd(root.unknown().asDiagonal()), 1e-12));
    // What is linear in P is regained: P_ba P^+ P_ab of any columns in its range.
    const Eigen::MatrixXd columns = P * test::randomMatrix(random, 6, 2), w = root.whitener * columns;
    EXPECT_TRUE(near(root.root * w, columns, 1e-12));
}

TEST(SquareRootTest, ASmallRestInTheMiddleTakesNothingWithIt) {
    // x2 = x1 + 3e-8 x3: taken in this order, x2 has next to nothing left when x1 is known, and that little
    // is x3.
    Eigen::Matrix3d A;
    A << 1, 0, 0, 1, 0, 3e-8, 0, 0, 1;
    const Eigen::Matrix3d P = A * A.transpose();
    const SquareRoot root = squareRoot(P);
    EXPECT_TRUE(near(root.root * root.root.transpose(), P, 1e-14));
    EXPECT_EQ(root.unknown().sum(), 2);
}

}  // namespace square_root_test
}  // namespace slamot
