#include <cmath>
#include <vector>

#include "slamot/core/models/ControlledTarget.h"
#include "support/AutoDiff.h"
#include "support/Expect.h"

namespace slamot {
namespace controlled_target_test {

using test::jacobian;
using test::near;

using Vector5 = Eigen::Matrix<double, 5, 1>;

/// g of [x y theta v w].
template <class S>
Eigen::Matrix<S, 3, 1> motionOf(ControlledPath path, const Eigen::Matrix<S, 5, 1>& y, double dt) {
    const Eigen::Matrix<S, 3, 1> x = y.template head<3>();
    const Eigen::Matrix<S, 2, 1> u = y.template tail<2>();
    return path == ControlledPath::printed ? controlledMotion(x, u, dt) : controlledArc(x, u, dt);
}

/// Ordinary, straight, standing, around the switch of sinc to its series (half a turn of 1e-4), turning hard.
std::vector<ControlledTarget> controls() {
    std::vector<ControlledTarget> out;
    for (const double speed : {1.0, 0.0, 7.0})
        for (const double turn_rate : {0.05, 0.0, 0.99e-3, 1.01e-3, -1.01e-3, 1e-9, 3.0, -20.0}) {
            ControlledTarget p;
            p.speed = speed;
            p.turn_rate = turn_rate;
            p.speed_std = 0.3;
            p.turn_rate_std = 0.2;
            out.push_back(p);
        }
    return out;
}

TEST(ControlledTargetTest, JacobiansAreThoseOfAutomaticDifferentiation) {
    for (ControlledTarget p : controls())
        for (const ControlledPath path : {ControlledPath::printed, ControlledPath::arc})
            for (const double dt : {0.2, 1.0})
                for (const double heading : {0.0, 0.7, pi, -2.5}) {
                    p.path = path;
                    Vector5 y;
                    y << 3, -2, heading, p.speed, p.turn_rate;
                    const auto J = jacobian<5>([&](const auto& v) { return motionOf(path, v, dt); }, y);
                    const ControlledPrediction g = predictControlled(p, y.head<3>(), dt);
                    EXPECT_TRUE(near(g.pose, motionOf(path, y, dt), 1e-14));
                    EXPECT_TRUE(near(g.F, J.leftCols<3>(), 1e-12));
                    const Matrix2 Q_u = Vector2(0.09, 0.04).asDiagonal();
                    EXPECT_TRUE(near(g.Q, J.rightCols<2>() * Q_u * J.rightCols<2>().transpose(), 1e-8))
                        << p.speed << " " << p.turn_rate;
                }
}

// Eq. 16 by hand: a quarter turn in one step of 1 s ends with the step taken along the new heading.
TEST(ControlledTargetTest, PrintedAndExactPathByHand) {
    ControlledTarget p;
    p.speed = 2;
    p.turn_rate = pi / 2;
    p.path = ControlledPath::printed;
    EXPECT_TRUE(near(predictControlled(p, Vector3(1, 1, 0), 1).pose, Vector3(1, 3, pi / 2), 1e-15));
    // The arc has radius v / w = 4 / pi.
    p.path = ControlledPath::arc;
    EXPECT_TRUE(
        near(predictControlled(p, Vector3(1, 1, 0), 1).pose, Vector3(1 + 4 / pi, 1 + 4 / pi, pi / 2), 1e-15));
}

TEST(ControlledTargetTest, NoiseThatHoldsForAnIntervalAddsUp) {
    ControlledTarget p;
    p.noise_interval = 0.5;
    p.turn_rate_std = 0;
    // Straight on: variances of steps add up along the path, whatever they are cut into.
    const double whole = predictControlled(p, Vector3::Zero(), 0.4).Q(0, 0),
                 half = predictControlled(p, Vector3::Zero(), 0.2).Q(0, 0);
    EXPECT_NEAR(whole, 2 * half, 1e-15);
    EXPECT_NEAR(whole, 0.01 * 0.5 * 0.4, 1e-15);
}

TEST(ControlledTargetTest, StateHasVelocityAndCentripetalAcceleration) {
    ControlledTarget p;
    p.speed = 2;
    p.turn_rate = 0.5;
    p.speed_std = 0.1;
    p.turn_rate_std = 0.2;
    const auto f = [](const auto& y) {
        using S = std::decay_t<decltype(y(0))>;
        using std::cos;
        using std::sin;
        const S c = cos(y(2)), s = sin(y(2)), v = y(3), a = y(3) * y(4);
        Eigen::Matrix<S, 6, 1> out;
        out << y(0), y(1), v * c, v * s, -a * s, a * c;
        return out;
    };
    Vector5 y;
    y << 4, 5, 2.1, 2, 0.5;
    const auto J = jacobian<5>(f, y);
    const ControlledState state = controlledState(p, y.head<3>());
    EXPECT_TRUE(near(state.mean, f(y), 1e-15));
    EXPECT_TRUE(near(state.G, J.leftCols<3>(), 1e-15));
    EXPECT_TRUE(near(
        state.Q, J.rightCols<2>() * Vector2(0.01, 0.04).asDiagonal() * J.rightCols<2>().transpose(), 1e-15));
}

}  // namespace controlled_target_test
}  // namespace slamot
