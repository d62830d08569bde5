#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "slamot/core/data/Ellipse.h"

namespace slamot {
namespace ellipse_test {

struct Gaussian {
    Vector2 mean = Vector2::Zero();
    Matrix2 covariance = Matrix2::Zero();
    std::vector<Vector2> outline(int count) const { return ellipseOutline(mean, covariance, 3, count); }
};

double mahalanobis(const Vector2& p, const Gaussian& g) {
    const Vector2 d = p - g.mean;
    return std::sqrt(d.dot(g.covariance.inverse() * d));
}

TEST(Ellipse, outlineLiesAtTheAskedMahalanobisDistance) {
    Gaussian g;
    g.mean = {12, -7};
    g.covariance << 0.9, -0.4, -0.4, 0.3;  // determinant 0.27 - 0.16 > 0
    const std::vector<Vector2> outline = g.outline(24);
    ASSERT_EQ(outline.size(), 25u);
    EXPECT_EQ(outline.front(), outline.back());
    for (const Vector2& p : outline) {
        EXPECT_NEAR(mahalanobis(p, g), 3, 1e-9);  // rounding at coordinates near 10 is about 1e-14
    }
}

TEST(Ellipse, halfAxesOfADiagonalCovariance) {
    Gaussian g;
    g.covariance << 4, 0, 0, 0.25;  // standard deviations 2 and 0.5: at 3 sigma 6 and 1.5
    double reach_x = 0, reach_y = 0;
    for (const Vector2& p : g.outline(8)) {
        reach_x = std::max(reach_x, p.x());
        reach_y = std::max(reach_y, p.y());
    }
    EXPECT_NEAR(reach_x, 6, 1e-12);
    EXPECT_NEAR(reach_y, 1.5, 1e-12);
}

TEST(Ellipse, notFiniteIsEmptyAndSlightlyNegativeIsFlat) {
    Gaussian g;
    g.covariance << 1, 0, 0, -1e-18;
    for (const Vector2& p : g.outline(8)) {
        EXPECT_TRUE(p.allFinite());
        EXPECT_NEAR(p.y(), 0, 1e-12);
    }
    g.covariance(0, 0) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(g.outline(8).empty());
}

}  // namespace ellipse_test
}  // namespace slamot
