#include <gtest/gtest.h>

#include <limits>

#include "slamot/core/estimation/Definiteness.h"

namespace slamot {
namespace definiteness_test {

constexpr double tolerance = 1e-9;

/// Diagonal values turned, so that no entry shows them.
Eigen::Matrix3d turned(double a, double b, double c) {
    const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
    const Eigen::Matrix3d reflection = Eigen::Matrix3d::Identity() - 2 * axis * axis.transpose();
    return reflection * Eigen::Vector3d(a, b, c).asDiagonal() * reflection;
}

TEST(DefinitenessTest, SemidefiniteAllowsZerosAndRounding) {
    EXPECT_TRUE(isPositiveSemidefinite(turned(3, 2, 1), tolerance));
    EXPECT_TRUE(isPositiveSemidefinite(Eigen::Matrix3d::Zero(), tolerance));
    EXPECT_TRUE(isPositiveSemidefinite(Eigen::Vector3d(1, 0, 0).asDiagonal().toDenseMatrix(), tolerance));
    EXPECT_TRUE(isPositiveSemidefinite(turned(1, 1, -0.9e-9), tolerance));
    EXPECT_FALSE(isPositiveSemidefinite(turned(1, 1, -1.1e-9), tolerance));
    EXPECT_FALSE(isPositiveSemidefinite(turned(1e6, 1, -1), tolerance));
    EXPECT_TRUE(isPositiveSemidefinite(turned(1e9, 1, -0.9), tolerance));  // relative to the largest
    EXPECT_FALSE(isPositiveSemidefinite(-1e-20 * Eigen::Matrix3d::Identity(), tolerance));
    EXPECT_TRUE(isPositiveSemidefinite(Eigen::MatrixXd(), tolerance));
}

TEST(DefinitenessTest, DefiniteWantsMore) {
    EXPECT_TRUE(isPositiveDefinite(turned(3, 2, 1)));
    EXPECT_TRUE(isPositiveDefinite(turned(1e-12, 1, 1)));
    EXPECT_FALSE(isPositiveDefinite(Eigen::Matrix3d::Zero()));
    EXPECT_FALSE(isPositiveDefinite(Eigen::Vector3d(1, 0, 1).asDiagonal().toDenseMatrix()));
    EXPECT_FALSE(isPositiveDefinite(turned(1, 1, -1e-3)));
}

TEST(DefinitenessTest, TheLowerTriangleDecides) {
    Eigen::Matrix2d upper_wrong;
    upper_wrong << 1, 99, 0.5, 1;
    EXPECT_TRUE(isPositiveSemidefinite(upper_wrong, tolerance));
    EXPECT_TRUE(isPositiveDefinite(upper_wrong));
    Eigen::Matrix2d lower_wrong = upper_wrong.transpose();
    EXPECT_FALSE(isPositiveSemidefinite(lower_wrong, tolerance));
    EXPECT_FALSE(isPositiveDefinite(lower_wrong));
}

TEST(DefinitenessTest, WhatIsNotFiniteIsNot) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
        matrix(1, 1) = bad;
        EXPECT_FALSE(isPositiveSemidefinite(matrix, tolerance));
        EXPECT_FALSE(isPositiveDefinite(matrix));
    }
}

}  // namespace definiteness_test
}  // namespace slamot
