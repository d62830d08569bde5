#include <gtest/gtest.h>

#include <cmath>

#include "slamot/core/estimation/OutlierGate.h"
#include "support/Expect.h"

namespace slamot {
namespace outlier_gate_test {

using test::near;

Linearisation linear(const Vector2& residual, double variance) {
    Linearisation out;
    out.measurement.residual = residual;
    out.measurement.R.setIdentity();
    out.S = variance * Matrix2::Identity();
    out.nis = residual.squaredNorm() / variance;
    return out;
}

RangeBearingDetection detection() {
    RangeBearingDetection out;
    out.covariance = Vector2(0.2, 0.1).asDiagonal();
    return out;
}

TEST(OutlierGateTest, InnovationsOfModesAreMomentMatched) {
    // Means 0.4 and -0.4 with weights 3/4 and 1/4: 0.2, spread 3/4 0.2^2 + 1/4 0.6^2 = 0.12, variance 0.75 +
    // 0.5.
    Innovation innovation;
    const Matrix2 more = OutlierGate{}.judge(
        Eigen::Vector2d(0.75, 0.25), {linear({0.4, 0}, 1), linear({-0.4, 0}, 2)}, detection(), innovation);
    EXPECT_TRUE(near(innovation.residual, Vector2(0.2, 0), 1e-15));
    EXPECT_TRUE(near(innovation.covariance, Matrix2(Vector2(1.37, 1.25).asDiagonal()), 1e-15));
    EXPECT_NEAR(innovation.nis, 0.04 / 1.37, 1e-15);
    EXPECT_EQ(innovation.outcome, Outcome::updated);
    EXPECT_TRUE(more.isZero(0));
}

TEST(OutlierGateTest, BearingsOnBothSidesOfPiAreNear) {
    Innovation innovation;
    OutlierGate{}.judge(Eigen::Vector2d(0.5, 0.5), {linear({0, pi - 0.1}, 4), linear({0, -pi + 0.3}, 4)},
                        detection(), innovation);
    EXPECT_NEAR(std::abs(angleDifference(innovation.residual.y(), pi + 0.1)), 0, 1e-14);
    EXPECT_NEAR(innovation.covariance(1, 1), 4 + 0.04, 1e-14);
}

TEST(OutlierGateTest, TheBestModeJudges) {
    // The gate of 0.999 is 13.82; NIS are 40 and 10, then 40 and 20.
    const Eigen::Vector2d mu(0.9, 0.1);
    for (const auto& [treatment, outcome] : {std::pair{OutlierTreatment::inflate, Outcome::inflated},
                                             std::pair{OutlierTreatment::reject, Outcome::rejected},
                                             std::pair{OutlierTreatment::accept, Outcome::updated}}) {
        const OutlierGate gate{treatment, 0.999};
        Innovation innovation;
        gate.judge(mu, {linear({std::sqrt(40), 0}, 1), linear({std::sqrt(10), 0}, 1)}, detection(),
                   innovation);
        EXPECT_EQ(innovation.outcome, Outcome::updated);
        const Matrix2 more = gate.judge(mu, {linear({std::sqrt(40), 0}, 1), linear({std::sqrt(20), 0}, 1)},
                                        detection(), innovation);
        EXPECT_EQ(innovation.outcome, outcome);
        const double factor = std::pow(20 / (-2 * std::log(0.001)), 2) - 1;
        const bool inflates = treatment == OutlierTreatment::inflate;
        EXPECT_TRUE(!inflates || near(more, Matrix2(factor * detection().covariance), 1e-12));
    }
}

}  // namespace outlier_gate_test
}  // namespace slamot
