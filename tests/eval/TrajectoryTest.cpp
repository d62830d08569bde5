#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "Builders.h"
#include "slamot/eval/Trajectory.h"

namespace slamot::eval {
namespace trajectory_test {

using testing::HasSubstr;

PosePair pose(double t, const Pose2& estimate, const Pose2& truth) {
    return {at(t), {estimate, Matrix3::Zero()}, truth};
}

TEST(Trajectory, PairsOnlyWhereTruthIsDense) {
    Truth truth;
    // Truth at 1.0, 1.1 and 2.0 s: 1.05 lies between near neighbours, 1.5 in a gap, 0.5 and 2.5 outside.
    truth.robot = {truePose(1.0, 0, 0, 0), truePose(1.1, 1, 0, 0), truePose(2.0, 2, 0, 0)};
    std::vector<RobotRow> rows;
    for (const double t : {0.5, 1.05, 1.5, 2.0, 2.5}) rows.push_back(row(t, 0, 0, 0));
    const PairedTrajectory paired = pairWithTruth(rows, truth);
    EXPECT_EQ(paired.counts.total, 5);
    EXPECT_EQ(paired.counts.covered, 3);
    EXPECT_EQ(paired.counts.matched, 2);
    EXPECT_EQ(paired.pairs[0].stamp, at(1.05));
    // Halfway between x = 0 and x = 1; rounding only.
    EXPECT_NEAR(paired.pairs[0].truth.x, 0.5, 1e-12);

    // Two of three is more than a half and less than 0.7.
    EXPECT_FALSE(whyTooFew(paired, rows, truth, 0.5));
    const auto why = whyTooFew(paired, rows, truth, 0.7);
    ASSERT_TRUE(why);
    EXPECT_THAT(*why, HasSubstr("only 2 of the 3 estimates within truth's span"));
}

TEST(Trajectory, NamesStampsInAnotherUnit) {
    std::vector<RobotRow> rows;
    Truth milliseconds, elsewhere;
    for (int i = 0; i <= 10; ++i) {
        rows.push_back(row(1000 + i, 0, 0, 0));
        milliseconds.robot.push_back(truePose(1e6 + 1e3 * i, 0, 0, 0));
        elsewhere.robot.push_back(truePose(5000 + i, 0, 0, 0));
    }
    const auto mistake = whyTooFew(pairWithTruth(rows, milliseconds), rows, milliseconds, 0.5);
    ASSERT_TRUE(mistake);
    EXPECT_THAT(*mistake, HasSubstr("truth's stamps look like milliseconds, expected seconds"));
    EXPECT_THAT(*mistake, HasSubstr("0 of 11 estimates"));

    // The other way round: the run is what is in milliseconds.
    std::vector<RobotRow> scaled;
    for (const TruePose& p : milliseconds.robot) scaled.push_back({p.stamp, {}});
    Truth seconds;
    for (const RobotRow& r : rows) seconds.robot.push_back({r.stamp, {}});
    EXPECT_THAT(*whyTooFew(pairWithTruth(scaled, seconds), scaled, seconds, 0.5),
                HasSubstr("the run's stamps look like milliseconds"));

    const auto no_overlap = whyTooFew(pairWithTruth(rows, elsewhere), rows, elsewhere, 0.5);
    ASSERT_TRUE(no_overlap);
    EXPECT_THAT(*no_overlap, HasSubstr("the run covers 1000.0000000 s to 1010.0000000 s"));
    EXPECT_THAT(*no_overlap, testing::Not(HasSubstr("look like")));
}

TEST(Trajectory, NamesAnotherUnitWhenBothStartAtZero) {
    // Run 0..100 s; truth 0..100000 'seconds', which are milliseconds. Every tenth of a second it is at 100
    // i: only t = 0 and t = 100 match.
    std::vector<RobotRow> rows;
    Truth truth;
    for (int i = 0; i <= 1000; ++i) {
        rows.push_back(row(0.1 * i, 0, 0, 0));
        truth.robot.push_back(truePose(100.0 * i, 0, 0, 0));
    }
    EXPECT_THAT(*whyTooFew(pairWithTruth(rows, truth), rows, truth, 0.5),
                HasSubstr("look like milliseconds"));
}

TEST(Trajectory, UnalignedErrorsByHand) {
    // Errors (3, 4) with heading 3.1 - (-3.1) = 6.2, wrapped to 6.2 - 2 pi; then (0, 0) with 0.
    const std::vector<PosePair> pairs{pose(0, {3, 4, 3.1}, {0, 0, -3.1}), pose(1, {1, 1, 0.5}, {1, 1, 0.5})};
    const RobotErrors e = robotErrors(pairs);
    EXPECT_DOUBLE_EQ(e.position.rmse, std::sqrt(25.0 / 2));
    EXPECT_DOUBLE_EQ(e.x.rmse, std::sqrt(9.0 / 2));
    EXPECT_DOUBLE_EQ(e.y.rmse, std::sqrt(16.0 / 2));
    EXPECT_DOUBLE_EQ(e.position.maximum, 5);
    EXPECT_DOUBLE_EQ(e.position.final, 0);
    EXPECT_NEAR(e.heading.maximum, 2 * pi - 6.2, 1e-12);
}

TEST(Trajectory, AlignmentTakesAwayARigidMotionOnly) {
    // Estimates are the truth seen from a frame at (5, -2) turned by 0.7 rad.
    const Pose2 T{5, -2, 0.7};
    std::vector<PosePair> pairs;
    for (const auto& p : {Pose2{0, 0, 0}, Pose2{4, 0, 1}, Pose2{4, 3, 3}, Pose2{0, 3, -2}})
        pairs.push_back(pose(static_cast<double>(pairs.size()), inverse(T) * p, p));
    const AbsoluteError exact = absoluteError(pairs, Alignment::se2);
    // Rounding of a 2 x 2 singular value decomposition of numbers near 10.
    EXPECT_NEAR(exact.position.maximum, 0, 1e-12);
    EXPECT_NEAR(exact.heading.maximum, 0, 1e-12);
    EXPECT_NEAR(exact.T_truth_estimate.x, 5, 1e-12);
    EXPECT_NEAR(exact.T_truth_estimate.y, -2, 1e-12);
    EXPECT_NEAR(exact.T_truth_estimate.theta, 0.7, 1e-12);
    EXPECT_NEAR(absoluteError(pairs, Alignment::first_pose).position.maximum, 0, 1e-12);
    EXPECT_GT(absoluteError(pairs, Alignment::none).position.rmse, 1);
}

TEST(Trajectory, AlignmentHasNoScale) {
    // Truth at x = -1, 1, estimated at x = -2, 2: the best rigid motion is none, and both errors stay 1.
    const std::vector<PosePair> pairs{pose(0, {-2, 0, 0}, {-1, 0, 0}), pose(1, {2, 0, 0}, {1, 0, 0})};
    const AbsoluteError e = absoluteError(pairs, Alignment::se2);
    EXPECT_NEAR(e.position.rmse, 1, 1e-12);
    EXPECT_NEAR(e.T_truth_estimate.theta, 0, 1e-12);
}

TEST(Trajectory, AlignmentOfPointsOnOneSpotDoesNotTurn) {
    // Numbers whose means do not come out exactly, so that centred positions are rounding and not zero.
    const std::vector<PosePair> pairs(7, pose(0, {0.1, 0.7, 0}, {1.3, -0.3, 0}));
    const Pose2 T = alignmentOf(pairs, Alignment::se2);
    EXPECT_EQ(T.theta, 0);
    EXPECT_NEAR(T.x, 1.2, 1e-12);
    EXPECT_NEAR(T.y, -1.0, 1e-12);
}

TEST(Trajectory, RelativeErrorOverTimeByHand) {
    // Truth goes 1 m/s along x; the estimate goes 1.5 m/s and turns 0.1 rad in the second second only.
    const std::vector<PosePair> pairs{pose(0, {0, 0, 0}, {0, 0, 0}), pose(1, {1.5, 0, 0}, {1, 0, 0}),
                                      pose(2, {3.0, 0, 0.1}, {2, 0, 0})};
    const auto over_1 = relativeError(pairs, 1, RelativeUnit::seconds);
    ASSERT_TRUE(over_1);
    EXPECT_EQ(over_1->position.count, 2);
    EXPECT_DOUBLE_EQ(over_1->position.rmse, 0.5);
    EXPECT_NEAR(over_1->heading.rmse, std::sqrt(0.01 / 2), 1e-12);
    const auto over_2 = relativeError(pairs, 2, RelativeUnit::seconds);
    EXPECT_EQ(over_2->position.count, 1);
    EXPECT_DOUBLE_EQ(over_2->position.rmse, 1);
    EXPECT_DOUBLE_EQ(over_2->mean_delta, 2);

    // 0.8 s: the next pose is 1 s on, a quarter more than asked for.
    const auto none = relativeError(pairs, 0.8, RelativeUnit::seconds);
    EXPECT_FALSE(none);
    EXPECT_THAT(none.whyAbsent(), HasSubstr("no two matched poses are between 0.8 and"));
}

TEST(Trajectory, RelativeErrorDoesNotSeeTheFrame) {
    // A drift of 0.1 m per metre sideways, seen from any frame.
    for (const Pose2& frame : {Pose2{0, 0, 0}, Pose2{100, -50, 2.5}}) {
        std::vector<PosePair> pairs;
        for (int i = 0; i < 5; ++i)
            pairs.push_back(pose(10.0 * i, frame * Pose2{1.0 * i, 0.1 * i, 0}, Pose2{1.0 * i, 0, 0}));
        const auto e = relativeError(pairs, 2, RelativeUnit::metres);
        ASSERT_TRUE(e);
        EXPECT_EQ(e->position.count, 3);
        // Rounding at coordinates near 100 m.
        EXPECT_NEAR(e->position.rmse, 0.2, 1e-12);
        EXPECT_NEAR(e->heading.maximum, 0, 1e-12);
    }
}

TEST(Trajectory, IsComparedAtThePointTruthIsMeasuredAt) {
    // An antenna 2 m ahead and 1 m to the left of the robot at (10, 0), heading pi / 2: at (9, 2). Its x
    // varies with the heading by -2 m per rad, its y by -1 m per rad.
    Truth truth;
    truth.point = {2, 1};
    truth.robot = {truePose(0, 9, 2, std::nan(""))};
    const Matrix3 P = Vector3(1, 4, 0.25).asDiagonal();
    const auto pairs = pairWithTruth({row(0, 10, 0, pi / 2, P)}, truth).pairs;
    ASSERT_EQ(pairs.size(), 1u);
    const PoseGaussian& e = pairs[0].estimate;
    EXPECT_NEAR((e.mean.position() - pairs[0].truth.position()).norm(), 0, 1e-14);
    EXPECT_NEAR(e.covariance(0, 0), 1 + 4 * 0.25, 1e-14);
    EXPECT_NEAR(e.covariance(0, 1), 2 * 0.25, 1e-14);
    EXPECT_NEAR(e.covariance(1, 1), 4 + 0.25, 1e-14);
    EXPECT_NEAR(e.covariance(1, 2), -0.25, 1e-14);
    EXPECT_EQ(e.covariance(2, 2), 0.25);
}

}  // namespace trajectory_test
}  // namespace slamot::eval
