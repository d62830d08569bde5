#include <gtest/gtest.h>

#include <cmath>

#include "slamot/core/estimation/RelativeGaussian.h"
#include "slamot/core/models/RangeBearing.h"
#include "support/Expect.h"

namespace slamot {
namespace relative_gaussian_test {

using test::near;

RangeBearingDetection detectionOf(double range, double bearing, const Matrix2& covariance) {
    RangeBearingDetection detection;
    detection.range = range;
    detection.bearing = bearing;
    detection.covariance = covariance;
    return detection;
}

TEST(RelativeGaussianTest, FirstSightOfTheClassicFilterIsTheInverseModel) {
    const Matrix2 R = (Matrix2() << 0.01, 0.001, 0.001, 0.0025).finished();
    const Pose2 sensor{0.5, -0.2, 0.3};
    const Vector3 robot{1, 2, 0.5};
    const NewBlock out = inWorld(firstSight(detectionOf(8, 1.2, R), sensor, Consistency::classic), robot);
    const auto inverse = invertRangeBearing(robot, {8, 1.2}, sensor);
    // A few sums of numbers up to 10, in another order.
    EXPECT_TRUE(near(out.mean, inverse.point, 1e-14));
    EXPECT_TRUE(near(out.G, inverse.G_robot, 1e-14));
    EXPECT_TRUE(near(out.own, inverse.G_z * R * inverse.G_z.transpose(), 1e-15));
}

TEST(RelativeGaussianTest, FirstSightOfTheInvariantFilterHasTheMomentsOfTheBanana) {
    // Point at range r = 10 + noise 0.1, bearing b = noise s: moments of (r cos b, r sin b) with b Gaussian
    // are E cos b = exp(-s^2/2), E cos^2 b = (1 + exp(-2 s^2))/2, so that, with E r^2 = 100.01,
    const double s = 0.1, s2 = s * s, r2 = 100.01;
    const double mean = 10 * std::exp(-s2 / 2);
    const double along = r2 * (1 + std::exp(-2 * s2)) / 2 - mean * mean,
                 across = r2 * (1 - std::exp(-2 * s2)) / 2;
    const auto detection = detectionOf(10, 0, Vector2(0.01, s2).asDiagonal());
    const auto out = firstSight(detection, {}, Consistency::invariant);
    // Neglected: relative order s^4 / 8 of the mean, s^2 = 1 % of the variances.
    EXPECT_NEAR(out.mean.x(), mean, 10 * s2 * s2 / 8);
    EXPECT_NEAR(out.mean.x(), 10 * (1 - s2 / 2), 1e-14);
    EXPECT_NEAR(out.covariance(0, 0), along, 0.03 * along);
    EXPECT_NEAR(out.covariance(1, 1), across, 0.01 * across);
    EXPECT_NEAR(out.covariance(0, 0), 0.01 + 0.5 * 0.1 * 0.1, 1e-14);  // sigma_r^2 + (d s^2)^2/2
    // The classic filter misses a third of the variance along here.
    EXPECT_LT(firstSight(detection, {}, Consistency::classic).covariance(0, 0), 0.7 * along);
    // The Jacobian is taken at the shortened range.
    EXPECT_NEAR(inWorld(out, {0, 0, 0}).G(1, 2), 10 * (1 - s2 / 2), 1e-14);
}

TEST(RelativeGaussianTest, TheWorldSeesAMoverTurnedAndShiftedByTheRobotsPose) {
    const RelativeGaussian point{Vector2(3, 1), Vector2(0.04, 0.09).asDiagonal()};
    RelativeGaussian mover = moverAt(point, 2, 0.5);
    EXPECT_TRUE(near(Eigen::VectorXd(mover.covariance.diagonal()),
                     (Vector6() << 0.04, 0.09, 4, 4, 0.25, 0.25).finished(), 0));
    mover.mean.segment<2>(2) = Vector2(1, 0);
    // A robot that looks along +y: ahead is up, left is -x.
    const NewBlock out = inWorld(mover, {10, 20, pi / 2});
    EXPECT_TRUE(near(out.mean, (Vector6() << 9, 23, 0, 1, 0, 0).finished(), 1e-14));
    EXPECT_NEAR(out.own(0, 0), 0.09, 1e-15);
    EXPECT_NEAR(out.own(1, 1), 0.04, 1e-15);
    // Jacobian by central differences of the map itself, which is linear in x and y, smooth in theta.
    const double h = 1e-6;
    for (int k = 0; k < 3; ++k) {
        Vector3 plus{10, 20, pi / 2}, minus = plus;
        plus(k) += h;
        minus(k) -= h;
        const Eigen::VectorXd slope = (inWorld(mover, plus).mean - inWorld(mover, minus).mean) / (2 * h);
        EXPECT_TRUE(near(Eigen::VectorXd(out.G.col(k)), slope, 1e-8)) << "column " << k;
    }
}

}  // namespace relative_gaussian_test
}  // namespace slamot
