#include <gtest/gtest.h>

#include <cmath>

#include "Builders.h"
#include "slamot/eval/Tracks.h"

namespace slamot::eval {
namespace tracks_test {

TEST(Tracks, GlobalAndRelativeErrorsByHand) {
    // The robot truly stands at the origin looking along x and believes to stand at (1, 0) looking along y.
    // The target is truly at (4, 0) moving (0, 2); the track is at (1, 4) moving (-2, 0): as the robot sees
    // it, all is right.
    RunRecord run;
    run.trajectory = {row(0, 1, 0, pi / 2)};
    run.tracks[at(0)] = {track(3, 7, 1, 4, -2, 0)};
    Truth truth;
    truth.robot = {truePose(0, 0, 0, 0)};
    truth.targets[SourceId{7}] = {trueTarget(0, 4, 0, 0, 2)};
    const auto m = targetMetrics(run, truth, {});
    ASSERT_TRUE(m);
    EXPECT_EQ(m->matched, 1);
    // (1 - 4, 4 - 0) = (-3, 4): 5 m; (-2, -2): sqrt(8) m/s.
    EXPECT_DOUBLE_EQ(m->all.position.rmse, 5);
    EXPECT_DOUBLE_EQ(m->all.velocity.rmse, std::sqrt(8.0));
    // Rounding of cos(pi / 2) at 4 m.
    EXPECT_NEAR(m->all.relative_position.rmse, 0, 1e-14);
    EXPECT_NEAR(m->all.relative_velocity.rmse, 0, 1e-14);
    // Unit covariance: NEES 25.
    ASSERT_TRUE(m->all.nees);
    EXPECT_NEAR(m->all.nees->average, 25, 1e-12);
    EXPECT_EQ(m->all.nees->coverage, 0);
    EXPECT_FALSE(m->seen);
}

TEST(Tracks, RelativeNeedsTheRobotsTruthAndVelocityTheTargets) {
    RunRecord run;
    run.trajectory = {row(0, 0, 0, 0), row(5, 0, 0, 0)};
    run.tracks[at(0)] = {track(0, 7, 1, 0)};
    run.tracks[at(5)] = {track(0, 7, 2, 0)};
    Truth truth;
    truth.robot = {truePose(5, 0, 0, 0)};
    const double unknown = std::nan("");
    truth.targets[SourceId{7}] = {trueTarget(0, 0, 0, unknown, unknown),
                                  trueTarget(5, 0, 0, unknown, unknown)};
    const auto m = targetMetrics(run, truth, {});
    ASSERT_TRUE(m);
    EXPECT_EQ(m->all.position.count, 2);
    EXPECT_EQ(m->all.velocity.count, 0);
    EXPECT_EQ(m->all.relative_position.count, 1);
    EXPECT_DOUBLE_EQ(m->all.relative_position.rmse, 2);
}

TEST(Tracks, CountsWhatIsNotMatched) {
    RunRecord run;
    run.trajectory = {row(0, 0, 0, 0), row(1, 0, 0, 0)};
    TrackEstimate sure = track(5, 7, 2, 0), unsure = track(4, 7, 9, 0);
    unsure.existence = 0.6;
    // Two tracks of 7, one without a source, one of 8 which truth does not know.
    run.tracks[at(0)] = {unsure, sure, track(6, -1, 0, 0), track(9, 8, 0, 0)};
    Truth truth;
    truth.targets[SourceId{7}] = {trueTarget(0, 0, 0), trueTarget(1, 0, 0)};
    const auto m = targetMetrics(run, truth, {});
    ASSERT_TRUE(m);
    EXPECT_EQ(m->matched, 1);
    EXPECT_EQ(m->doubled, 1);
    EXPECT_EQ(m->without_source, 1);
    EXPECT_EQ(m->without_truth, 1);
    EXPECT_EQ(m->missed, 1);  // 7 at 1 s
    EXPECT_DOUBLE_EQ(m->all.position.rmse, 2);
    EXPECT_EQ(m->by_target.count(SourceId{7}), 1u);
}

TEST(Tracks, WhileSeenTakesOnlyStampsWithAnUsedDetection) {
    RunRecord run;
    Truth truth;
    // Errors 1, 2, 3, 4, 5 m at 0, 1, 2, 3, 4 s; seen at 0 (initiated), 2 (updated) and 4 (updated with an
    // inflated covariance), rejected at 3.
    for (int i = 0; i < 5; ++i) {
        run.trajectory.push_back(row(i, 0, 0, 0));
        run.tracks[at(i)] = {track(0, 7, i + 1.0, 0)};
        truth.targets[SourceId{7}].push_back(trueTarget(i, 0, 0));
    }
    run.innovations = {innovation(0, "m", ObjectKind::mover, Outcome::initiated, std::nan(""), 0),
                       innovation(2, "m", ObjectKind::mover, Outcome::updated, 1, 0),
                       innovation(3, "m", ObjectKind::mover, Outcome::rejected, 40, 0),
                       innovation(4, "m", ObjectKind::mover, Outcome::inflated, 9, 0),
                       innovation(1, "m", ObjectKind::mover, Outcome::updated, 1, 55)};
    const auto m = targetMetrics(run, truth, {});
    ASSERT_TRUE(m);
    EXPECT_EQ(m->all.position.count, 5);
    EXPECT_DOUBLE_EQ(m->all.position.median, 3);
    ASSERT_TRUE(m->seen);
    EXPECT_EQ(m->seen->position.count, 3);
    EXPECT_DOUBLE_EQ(m->seen->position.rmse, std::sqrt((1.0 + 9.0 + 25.0) / 3));
}

TEST(Tracks, SaysWhatIsMissing) {
    RunRecord run;
    EXPECT_EQ(targetMetrics(run, {}, {}).whyAbsent(), "the run has no tracks");
    run.trajectory = {row(0, 0, 0, 0)};
    run.tracks[at(0)] = {track(0, -1, 0, 0)};
    EXPECT_EQ(targetMetrics(run, {}, {}).whyAbsent(), "truth has no targets");
    Truth truth;
    truth.targets[SourceId{7}] = {trueTarget(0, 0, 0)};
    EXPECT_EQ(targetMetrics(run, truth, {}).whyAbsent(),
              "no track carries a source id; OSPA and GOSPA need none");
}

}  // namespace tracks_test
}  // namespace slamot::eval
