#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "slamot/core/models/RangeBearing.h"
#include "support/AutoDiff.h"
#include "support/Expect.h"

namespace slamot {
namespace range_bearing_test {

using test::jacobian;
using test::near;

struct Geometry {
    Vector3 robot;
    Vector2 point;
    Pose2 sensor;
};

/// Points all around several robots, at ranges from just above the floor to far, bearings on both sides of
/// +-pi.
std::vector<Geometry> geometries() {
    std::vector<Geometry> out;
    for (const Pose2& sensor : {Pose2{}, Pose2{1.5, -0.4, 0.3}, Pose2{-2, 0, pi}})
        for (const Vector3& robot : {Vector3(0, 0, 0), Vector3(3, -2, 2.5), Vector3(-10, 4, -pi + 1e-9)})
            for (const double range : {1.1e-3, 0.02, 1.0, 80.0})
                for (const double bearing :
                     {0.0, 1.0, -2.0, pi / 2, pi - 1e-9, -pi + 1e-9, pi - 1e-3, -pi + 1e-3}) {
                    const Pose2 T_world_sensor = Pose2::fromVector(robot) * sensor;
                    const Vector2 in_sensor(range * std::cos(bearing), range * std::sin(bearing));
                    out.push_back({robot, T_world_sensor * in_sensor, sensor});
                }
    return out;
}

std::string describe(const Geometry& g) {
    std::ostringstream text;
    text << "robot " << g.robot.transpose() << " point " << g.point.transpose() << " sensor "
         << g.sensor.vector().transpose();
    return text.str();
}

TEST(RangeBearingTest, JacobiansAreThoseOfTheModel) {
    for (const Geometry& g : geometries()) {
        const auto h = predictRangeBearing(g.robot, g.point, g.sensor);
        const auto H_robot = jacobian<3>(
            [&](const auto& x) {
                using S = typename std::decay_t<decltype(x)>::Scalar;
                return rangeBearing<S>(x, g.point.cast<S>(), g.sensor);
            },
            g.robot);
        const auto H_point = jacobian<2>(
            [&](const auto& p) {
                using S = typename std::decay_t<decltype(p)>::Scalar;
                return rangeBearing<S>(g.robot.cast<S>(), p, g.sensor);
            },
            g.point);
        EXPECT_TRUE(near(h.H_robot, H_robot, 1e-12)) << describe(g);
        EXPECT_TRUE(near(h.H_point, H_point, 1e-12)) << describe(g);
        // rel = p - (x.xy + Rot(theta) s)
        const auto D_robot = jacobian<3>(
            [&](const auto& x) {
                using S = typename std::decay_t<decltype(x)>::Scalar;
                return Eigen::Matrix<S, 2, 1>(g.point.cast<S>() - x.template head<2>() -
                                              rotation(x(2)) * g.sensor.position().cast<S>());
            },
            g.robot);
        EXPECT_TRUE(near(h.D_robot, D_robot, 1e-14)) << describe(g);
        EXPECT_TRUE(near(h.z, rangeBearing<double>(g.robot, g.point, g.sensor), 1e-15)) << describe(g);
        // `across` is the unit normal of the line of sight, to its left.
        const Vector2 rel = g.point - (Pose2::fromVector(g.robot) * g.sensor).position();
        EXPECT_NEAR(h.across.norm(), 1, 1e-14);
        EXPECT_NEAR(h.across.dot(rel) / rel.norm(), 0, 1e-12) << describe(g);
        EXPECT_GT(rel.x() * h.across.y() - rel.y() * h.across.x(), 0) << describe(g);
    }
}

TEST(RangeBearingTest, ThetaEntryIsMinusOneAndBearingRowFallsWithTheSquare) {
    // The paper prints +1 and 1/r (eq. 38-42). Point 2 m ahead on the x axis: d bearing / d y = 1/2 = 2/2^2.
    const auto h = predictRangeBearing({0, 0, 0}, {2, 0}, {});
    const Eigen::Matrix<double, 2, 3> expected =
        (Eigen::Matrix<double, 2, 3>() << -1, 0, 0, 0, -0.5, -1).finished();
    EXPECT_TRUE(near(h.H_robot, expected, 1e-15));
    EXPECT_TRUE(near(h.H_point, -expected.leftCols<2>(), 1e-15));
}

TEST(RangeBearingTest, InverseJacobiansAreThoseOfTheModel) {
    for (const Geometry& g : geometries()) {
        const Vector2 z = rangeBearing<double>(g.robot, g.point, g.sensor);
        const auto inverse = invertRangeBearing(g.robot, z, g.sensor);
        const auto G_robot = jacobian<3>(
            [&](const auto& x) {
                using S = typename std::decay_t<decltype(x)>::Scalar;
                return inverseRangeBearing<S>(x, z.cast<S>(), g.sensor);
            },
            g.robot);
        const auto G_z = jacobian<2>(
            [&](const auto& q) {
                using S = typename std::decay_t<decltype(q)>::Scalar;
                return inverseRangeBearing<S>(g.robot.cast<S>(), q, g.sensor);
            },
            z);
        EXPECT_TRUE(near(inverse.G_robot, G_robot, 1e-13)) << describe(g);
        EXPECT_TRUE(near(inverse.G_z, G_z, 1e-13)) << describe(g);
        EXPECT_TRUE(near(inverse.point, g.point, 1e-13)) << "inverse of the model: " << describe(g);
    }
}

TEST(RangeBearingTest, JacobiansStayFiniteAtTheSensor) {
    for (const double range : {0.0, std::numeric_limits<double>::denorm_min(), 1e-12, 0.9e-3}) {
        const auto h = predictRangeBearing({1, 2, 0.4}, Vector2(1 + range, 2), {});
        EXPECT_TRUE(h.z.allFinite() && h.H_robot.allFinite() && h.H_point.allFinite()) << range;
        EXPECT_NEAR(h.H_point.row(0).norm(), 1, 1e-12) << range;
        EXPECT_NEAR(h.H_point.row(1).norm(), 1 / range_floor, 1e-9) << range;
    }
}

TEST(RangeBearingTest, ResidualTakesTheShortWayRound) {
    const Vector2 residual = rangeBearingResidual({5, pi - 0.1}, {4, -pi + 0.1});
    EXPECT_NEAR(residual.x(), 1, 1e-15);
    EXPECT_NEAR(residual.y(), -0.2, 1e-14);
}

}  // namespace range_bearing_test
}  // namespace slamot
