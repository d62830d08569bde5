// Whole runs of JointFilter with both engines: a robot on a loop of several hundred metres, twice, among many
// landmarks, with movers that come and go.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "slamot/core/estimation/CompressedJointBank.h"
#include "slamot/core/estimation/Definiteness.h"
#include "slamot/core/estimation/JointFilter.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"
#include "support/Scenes.h"

namespace slamot {
namespace {

using test::near;

constexpr double range = 12, dt = 0.5;

JointFilter filterWith(JointEngine::Kind kind, Consistency consistency) {
    JointFilterParameters parameters;
    parameters.consistency = consistency;
    parameters.engine.kind = kind;
    parameters.engine.active_set.keep_at_least = 10;
    parameters.target_max_unseen = 2;
    JointFilter filter(parameters, {});
    filter.start({}, {{0, 0, 0}, Matrix3::Identity() * 1e-4});
    return filter;
}

/// A rectangle of 80 m x 40 m at 1 m a step, with landmarks on both sides.
class Loop {
  public:
    Loop() : random_(5, RandomPurpose::test) {
        for (int i = 0; i < 260; ++i)
            landmarks_.emplace_back(random_.uniform(-15, 95), random_.uniform(-15, 55));
        pose_ = {0, 0, 0};
    }

    OdometryIncrement drive(int step) {
        const int along = step % 240;
        const bool corner = along == 80 || along == 120 || along == 200 || (along == 0 && step > 0);
        const Pose2 increment{1, 0, corner ? pi / 2 : 0};
        // Turns in place before moving on, so that the path stays on the rectangle.
        pose_ = pose_ * Pose2{0, 0, increment.theta} * Pose2{1, 0, 0};
        const Pose2 measured{std::cos(increment.theta) + 0.02 * random_.normal(),
                             std::sin(increment.theta) + 0.01 * random_.normal(),
                             increment.theta + 0.005 * random_.normal()};
        return test::odometry(dt * step, dt * (step + 1), measured);
    }

    DetectionSet look(int step) {
        std::vector<RangeBearingDetection> detections;
        for (std::size_t i = 0; i < landmarks_.size(); ++i)
            if ((landmarks_[i] - pose_.position()).norm() < range)
                detections.push_back(
                    test::seen(pose_, landmarks_[i], ObjectKind::landmark, static_cast<std::int64_t>(i)));
        // A mover overtakes the robot every 30 steps; its track has ended in between.
        if (step % 30 < 12)
            detections.push_back(test::seen(pose_, pose_ * Vector2(-6 + step % 30, 3), ObjectKind::mover, 0));
        if (step % 50 > 40)
            detections.push_back(
                test::seen(pose_, pose_ * Vector2(4, 10 - 2 * (step % 50 - 40)), ObjectKind::mover, 1));
        for (RangeBearingDetection& d : detections) {
            d.range += 0.1 * random_.normal();
            d.bearing = wrapAngle(d.bearing + 0.02 * random_.normal());
        }
        DetectionSet set = test::detectionsAt(dt * (step + 1), detections);
        std::get<RangeBearingSet>(set.measurements).sensors[0].max_range = range;
        return set;
    }

  private:
    RandomStream random_;
    std::vector<Vector2> landmarks_;
    Pose2 pose_;
};

/// Robot and landmarks.
Eigen::VectorXd positions(const JointFilter& filter) {
    const auto landmarks = filter.landmarks();
    Eigen::VectorXd out(3 + 2 * static_cast<int>(landmarks.size()));
    out.head<3>() = filter.robot().mean.vector();
    for (std::size_t i = 0; i < landmarks.size(); ++i)
        out.segment<2>(3 + 2 * static_cast<Eigen::Index>(i)) = landmarks[i].mean;
    return out;
}

class JointEngines : public testing::TestWithParam<Consistency> {};

TEST_P(JointEngines, AgreeOverAWholeRun) {
    // The engines add the same numbers in another order, some 1e4 times; the map leaves
    // out what is below 1e-10 of a standard deviation. 1e-9 of the largest number of a kind is what is
    // promised.
    Loop loop;
    JointFilter dense = filterWith(JointEngine::Kind::dense, GetParam()),
                compressed = filterWith(JointEngine::Kind::compressed, GetParam());
    const auto& bank = dynamic_cast<const CompressedJointBank&>(compressed.state());
    std::set<BlockId> been_away, came_back;
    double worst = 0;
    const auto compare = [&worst](const Eigen::MatrixXd& value, const Eigen::MatrixXd& expected) {
        ASSERT_EQ(value.rows(), expected.rows());
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
    EXPECT_LT(bank.activeDimension(), dense.state().dimension() / 2);
}

INSTANTIATE_TEST_SUITE_P(Both, JointEngines, testing::Values(Consistency::classic, Consistency::invariant),
                         [](const auto& each) {
                             return each.param == Consistency::classic ? "classic" : "invariant";
                         });

}  // namespace
}  // namespace slamot
