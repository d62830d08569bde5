#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "slamot/report/Ellipse.h"

namespace slamot::report {
namespace {

double mahalanobis(const Eigen::Vector2d& p, const GaussianPoint& g) {
    const Eigen::Vector2d d = p - g.mean;
    return std::sqrt(d.dot(g.covariance.inverse() * d));
}

TEST(Ellipse, outlineLiesAtTheAskedMahalanobisDistance) {
    GaussianPoint g;
    g.mean = {12, -7};
    g.covariance << 0.9, -0.4, -0.4, 0.3;  // determinant 0.27 - 0.16 > 0
    const Points2 outline = ellipseOutline(g, 3, 24);
    ASSERT_EQ(outline.size(), 25u);
    EXPECT_EQ(outline.front(), outline.back());
    for (const Eigen::Vector2d& p : outline) {
        EXPECT_NEAR(mahalanobis(p, g), 3, 1e-9);  // rounding at coordinates near 10 is about 1e-14
    }
}

TEST(Ellipse, halfAxesOfADiagonalCovariance) {
    GaussianPoint g;
    g.covariance << 4, 0, 0, 0.25;  // standard deviations 2 and 0.5: at 3 sigma 6 and 1.5
    double reach_x = 0, reach_y = 0;
    for (const Eigen::Vector2d& p : ellipseOutline(g, 3, 8)) {
        reach_x = std::max(reach_x, p.x());
        reach_y = std::max(reach_y, p.y());
    }
    EXPECT_NEAR(reach_x, 6, 1e-12);
    EXPECT_NEAR(reach_y, 1.5, 1e-12);
}

TEST(Ellipse, notFiniteIsEmptyAndSlightlyNegativeIsFlat) {
    GaussianPoint g;
    g.covariance << 1, 0, 0, -1e-18;
    for (const Eigen::Vector2d& p : ellipseOutline(g, 3, 8)) {
        EXPECT_TRUE(p.allFinite());
        EXPECT_NEAR(p.y(), 0, 1e-12);
    }
    g.covariance(0, 0) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(ellipseOutline(g, 3, 8).empty());
}

}  // namespace
}  // namespace slamot::report
