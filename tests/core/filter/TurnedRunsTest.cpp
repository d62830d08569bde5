// Every method of association on the same log in worlds turned through the full circle: the same decisions,
// the same answer turned. The sensor looks all around, so bearings cross +-pi in every scan; robot headings
// cross it at another moment in every world.
#include <gtest/gtest.h>

#include <tuple>

#include "HiddenWorld.h"
#include "support/Expect.h"

namespace slamot {
namespace turned_runs_test {

using test::HiddenWorld;
using test::near;

struct Answer {
    std::vector<std::int64_t> decisions;  ///< of every detection: outcome, landmark, track
    PoseGaussian robot;
    std::vector<LandmarkEstimate> landmarks;
    std::vector<TrackEstimate> tracks;
};

Answer run(const HiddenWorld& world, const JointFilterParameters& parameters, double turn) {
    JointFilter filter(parameters, HiddenWorld::motion());
    filter.start({}, {Pose2{0, 0, turn} * world.start().mean, Matrix3::Zero()});
    Answer out;
    for (const HiddenWorld::Step& now : world.steps) {
        filter.predict(now.odometry);
        for (const Innovation& i : filter.update(now.hidden).innovations)
            for (const std::int64_t v :
                 {static_cast<std::int64_t>(i.outcome), i.landmark.value, i.track.value})
                out.decisions.push_back(v);
    }
    out.robot = filter.robot();
    out.landmarks = filter.landmarks();
    out.tracks = filter.tracks();
    return out;
}

class TurnedRuns
    : public testing::TestWithParam<std::tuple<LandmarkAssociation, MoverAssociation, Consistency, bool>> {};

TEST_P(TurnedRuns, GiveTheTurnedAnswer) {
    const auto [landmarks, movers, consistency, kinds_known] = GetParam();
    test::HiddenWorldOptions options;
    options.kinds_known = kinds_known;
    options.steps = 120;
    const HiddenWorld world(options);
    JointFilterParameters parameters = HiddenWorld::parameters();
    parameters.association.landmarks = landmarks;
    parameters.association.movers = movers;
    parameters.consistency = consistency;

    const Answer plain = run(world, parameters, 0);
    EXPECT_GE(plain.landmarks.size(), 15u);
    EXPECT_GE(plain.tracks.size(), 1u);
    // Turning rounds coordinates of 10 m to 2e-15; 120 steps pass that on, none enlarges it without end.
    constexpr double rounding = 1e-9;
    for (int k = 1; k < 8; ++k) {
        SCOPED_TRACE(45 * k);
        const double angle = radians(45.0 * k);
        const Answer turned = run(world, parameters, angle);
        ASSERT_EQ(turned.decisions, plain.decisions);
        const Matrix2 R = rotation(angle);
        EXPECT_TRUE(near(turned.robot.mean.position(), R * plain.robot.mean.position(), rounding));
        EXPECT_NEAR(angleDifference(turned.robot.mean.theta, plain.robot.mean.theta + angle), 0, rounding);
        ASSERT_EQ(turned.landmarks.size(), plain.landmarks.size());
        for (std::size_t i = 0; i < plain.landmarks.size(); ++i) {
            const LandmarkEstimate &a = turned.landmarks[i], &b = plain.landmarks[i];
            EXPECT_EQ(a.id, b.id);
            EXPECT_TRUE(near(a.mean, R * b.mean, rounding));
            EXPECT_TRUE(near(a.covariance, R * b.covariance * R.transpose(), rounding));
            EXPECT_NEAR(a.existence, b.existence, rounding);
            EXPECT_NEAR(a.moving, b.moving, rounding);
        }
        ASSERT_EQ(turned.tracks.size(), plain.tracks.size());
        Matrix6 R6 = Matrix6::Zero();
        for (int j = 0; j < 6; j += 2) R6.block<2, 2>(j, j) = R;
        for (std::size_t i = 0; i < plain.tracks.size(); ++i) {
            const TrackEstimate &a = turned.tracks[i], &b = plain.tracks[i];
            EXPECT_EQ(a.id, b.id);
            EXPECT_TRUE(near(a.mean, R6 * b.mean, rounding));
            EXPECT_TRUE(near(a.covariance, R6 * b.covariance * R6.transpose(), rounding));
            EXPECT_NEAR(a.existence, b.existence, rounding);
            EXPECT_NEAR(a.moving, b.moving, rounding);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, TurnedRuns,
    testing::Combine(testing::Values(LandmarkAssociation::nearest, LandmarkAssociation::sequential,
                                     LandmarkAssociation::jcbb, LandmarkAssociation::gnn),
                     testing::Values(MoverAssociation::nearest, MoverAssociation::gnn,
                                     MoverAssociation::jpda),
                     testing::Values(Consistency::classic, Consistency::invariant), testing::Bool()));

}  // namespace turned_runs_test
}  // namespace slamot
