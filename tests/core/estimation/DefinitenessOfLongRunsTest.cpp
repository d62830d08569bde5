// The covariance stays positive semi-definite where rounding is worst: a huge prior against precise
// measurements, thousands of times.
#include <gtest/gtest.h>

#include "slamot/core/estimation/Definiteness.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "slamot/core/estimation/RangeBearingUpdate.h"
#include "slamot/core/estimation/RelativeGaussian.h"

namespace slamot {
namespace definiteness_of_long_runs_test {

class DefinitenessOfLongRuns : public testing::TestWithParam<Consistency> {};

TEST_P(DefinitenessOfLongRuns, HugePriorsAndPreciseMeasurements) {
    // Variances of prior and measurement 1e14 apart, near the 1e16 of doubles. The landmark starts at first
    // sight, so that it is uncertain with the robot, as in any run, and not against it.
    const Matrix3 prior = Vector3(1e6, 1e6, 1.0).asDiagonal();
    DenseJointBank bank(Vector3::Zero(), prior, GetParam());
    JointMode& state = bank.mode(0);
    RangeBearingDetection detection;
    detection.range = 11;
    detection.bearing = 0.5;
    detection.covariance = Vector2(1e-8, 1e-8).asDiagonal();
    const BlockId landmark = bank.augment(
        BlockKind::landmark, inWorld(firstSight(detection, {}, GetParam()), state.mean(robot_block)));
    for (int i = 0; i < 20000; ++i) {
        const Vector3 robot = state.mean(robot_block);
        const Vector2 rel = rotation(-robot.z()) * (state.mean(landmark).head<2>() - robot.head<2>());
        detection.range = rel.norm();
        detection.bearing = std::atan2(rel.y(), rel.x());
        state.update({linearise(state, landmark, detection, {}, GetParam()).measurement});
        ASSERT_TRUE(isPositiveSemidefinite(state.jointCovariance({robot_block, landmark}), 1e-9))
            << "update " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Cores, DefinitenessOfLongRuns,
                         testing::Values(Consistency::classic, Consistency::invariant), [](const auto& core) {
                             return std::string(core.param == Consistency::classic ? "classic" : "invariant");
                         });

}  // namespace definiteness_of_long_runs_test
}  // namespace slamot
