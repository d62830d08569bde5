// Whole runs of JointFilter with both engines: a robot on a loop of several hundred metres, twice, among many
// landmarks, with movers that come and go.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "LoopScene.h"
#include "slamot/core/estimation/CompressedJointBank.h"
#include "slamot/core/estimation/Definiteness.h"
#include "slamot/core/filter/JointFilter.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"
#include "support/Scenes.h"

namespace slamot {
namespace joint_engine_test {

/// start_std: of the start's x and y [m].
JointFilter filterWith(JointEngine::Kind kind, Consistency consistency, bool background = false,
                       double start_std = 0.01) {
    JointFilterParameters parameters;
    parameters.consistency = consistency;
    parameters.engine.kind = kind;
    parameters.engine.background = background;
    parameters.engine.active_set.keep_at_least = 10;
    parameters.target_max_unseen = 2;
    JointFilter filter(parameters, {});
    filter.start({}, {{0, 0, 0}, Vector3(start_std * start_std, start_std * start_std, 1e-4).asDiagonal()});
    return filter;
}

/// Robot and landmarks.
Eigen::VectorXd positions(const JointFilter& filter) {
    const auto landmarks = filter.landmarks();
    Eigen::VectorXd out(3 + 2 * static_cast<int>(landmarks.size()));
    out.head<3>() = filter.robot().mean.vector();
    for (std::size_t i = 0; i < landmarks.size(); ++i)
        out.segment<2>(3 + 2 * static_cast<Eigen::Index>(i)) = landmarks[i].mean;
    return out;
}

/// With or without a thread for what is put away.
class JointEngines : public testing::TestWithParam<std::tuple<Consistency, bool>> {};

TEST_P(JointEngines, AgreeOverAWholeRun) {
    // The engines add the same numbers in another order, some 1e4 times; the map leaves
    // out what is below 2e-12 of a standard deviation. 1e-9 of the largest number of a kind is what is
    // promised.
    test::LoopScene loop(5, 260);
    const auto& [consistency, background] = GetParam();
    JointFilter dense = filterWith(JointEngine::Kind::dense, consistency),
                compressed = filterWith(JointEngine::Kind::compressed, consistency, background);
    const auto& bank = dynamic_cast<const CompressedJointBank&>(compressed.state());
    std::set<BlockId> been_away, came_back;
    double worst = 0;
    const auto compare = [&worst](const Eigen::MatrixXd& value, const Eigen::MatrixXd& expected) {
        ASSERT_EQ(value.rows(), expected.rows());
        ASSERT_TRUE(value.allFinite());
        worst = std::max(worst, (value - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff());
    };
    for (int step = 0; step < 500; ++step) {
        const OdometryIncrement odometry = loop.drive(step);
        const DetectionSet set = loop.look(step);
        for (JointFilter* filter : {&dense, &compressed}) {
            filter->predict(odometry);
            filter->update(set);
        }
        for (const BlockId id : bank.map().landmarks()) been_away.insert(id);
        for (const BlockId id : been_away)
            if (bank.active(id)) came_back.insert(id);

        // Each kind of number relative to the largest of its kind: robot, tracks, map.
        compare(compressed.robot().covariance, dense.robot().covariance);
        const auto tracks = dense.tracks(), same_tracks = compressed.tracks();
        ASSERT_EQ(tracks.size(), same_tracks.size());
        for (std::size_t i = 0; i < tracks.size(); ++i) {
            compare(same_tracks[i].mean, tracks[i].mean);
            compare(same_tracks[i].covariance, tracks[i].covariance);
        }
        ASSERT_LT(worst, 1e-9) << step;
        if (step % 50 != 49) continue;
        const Eigen::MatrixXd P = compressed.jointCovariance().matrix;
        compare(P, dense.jointCovariance().matrix);
        ASSERT_TRUE(isPositiveSemidefinite(P, 1e-9)) << step;
        compare(positions(compressed), positions(dense));
        ASSERT_LT(worst, 1e-9) << step;
    }
    RecordProperty("worst_relative_difference", fmt::format("{}", worst));
    // Or the comparison would be of the dense engine with itself.
    EXPECT_GT(bank.commits(), 20);
    EXPECT_GT(came_back.size(), 100u);
    EXPECT_GT(bank.map().census().regroupings, 0);
    EXPECT_GT(bank.map().census().added_terms, 0);
    EXPECT_LT(bank.activeDimension(), dense.state().dimension() / 2);
}

/// Both filters around a loop of 260 steps and on, the robot's covariances equal at every step.
void driveTheLoop(JointFilter& dense, JointFilter& compressed, int steps) {
    test::LoopScene loop(5, 260);
    for (int step = 0; step < steps; ++step) {
        const OdometryIncrement odometry = loop.drive(step);
        const DetectionSet set = loop.look(step);
        for (JointFilter* filter : {&dense, &compressed}) {
            filter->predict(odometry);
            ASSERT_NO_THROW(filter->update(set)) << step;
        }
        const Matrix3 P = dense.robot().covariance, difference = compressed.robot().covariance - P;
        ASSERT_LT(difference.cwiseAbs().maxCoeff(), 1e-9 * P.cwiseAbs().maxCoeff()) << step;
    }
}

TEST_P(JointEngines, AgreeWhenLandmarksAreSeenBeforeTheyArePrepared) {
    // Told that sensors see to 5 m, where they see to 12, the engine has most landmarks come unforeseen,
    // while others are prepared.
    const auto& [consistency, background] = GetParam();
    JointFilterParameters parameters;
    parameters.consistency = consistency;
    parameters.target_max_unseen = 2;
    parameters.engine.background = background;
    parameters.engine.active_set.keep_at_least = 10;
    parameters.engine.active_set.range = 5;
    parameters.engine.active_set.activate_margin = 1.2;
    parameters.engine.active_set.keep_margin = 1.25;
    JointFilter compressed(parameters, {}), dense = filterWith(JointEngine::Kind::dense, consistency);
    compressed.start({}, {{0, 0, 0}, Matrix3::Identity() * 1e-4});
    ASSERT_NO_FATAL_FAILURE(driveTheLoop(dense, compressed, 300));
    EXPECT_GT(dynamic_cast<const CompressedJointBank&>(compressed.state()).unforeseen(), 50);
}

TEST_P(JointEngines, AgreeWhereAllIsUncertainTogether) {
    // The robot starts somewhere within kilometres, and landmarks are known to each other to centimetres:
    // rows of the base that are whitened by what is left of a landmark are 1e6 times as large as what they
    // say of far ones. When the robot has closed its loop (from step 240 on) and landmarks come back, that
    // must not show.
    const auto& [consistency, background] = GetParam();
    JointFilter dense = filterWith(JointEngine::Kind::dense, consistency, false, 1000),
                compressed = filterWith(JointEngine::Kind::compressed, consistency, background, 1000);
    ASSERT_NO_FATAL_FAILURE(driveTheLoop(dense, compressed, 320));
    const Eigen::MatrixXd P = dense.jointCovariance().matrix;
    EXPECT_LT((compressed.jointCovariance().matrix - P).cwiseAbs().maxCoeff(),
              1e-9 * P.cwiseAbs().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(
    All, JointEngines,
    testing::Combine(testing::Values(Consistency::classic, Consistency::invariant), testing::Bool()),
    [](const auto& each) {
        return std::string(std::get<0>(each.param) == Consistency::classic ? "classic" : "invariant") +
               (std::get<1>(each.param) ? "InTheBackground" : "");
    });

}  // namespace joint_engine_test
}  // namespace slamot
