// Whole runs of the joint filter on logs without identities.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <string>
#include <tuple>

#include "../estimation/ImmScenes.h"
#include "HiddenWorld.h"
#include "slamot/core/estimation/CompressedJointBank.h"
#include "support/Expect.h"

namespace slamot {
namespace unlabelled_runs_test {

using test::HiddenWorld;
using test::near;

enum class Movers { ekf, exact, scalable };

JointFilterParameters parametersOf(Movers movers, Consistency consistency, JointEngine::Kind engine) {
    JointFilterParameters p = HiddenWorld::parameters();
    p.consistency = consistency;
    p.engine.kind = engine;
    if (movers == Movers::ekf) return p;
    p.imm = test::immModes("cv:cv:0.1, ca:ca:1");
    p.imm.form = movers == Movers::exact ? ImmForm::exact : ImmForm::scalable;
    p.imm.max_exact_targets = 3;
    return p;
}

JointFilter started(const JointFilterParameters& parameters, const HiddenWorld& world) {
    JointFilter filter(parameters, HiddenWorld::motion());
    filter.start({}, world.start());
    return filter;
}

UpdateReport step(JointFilter& filter, const HiddenWorld::Step& step) {
    filter.predict(step.odometry);
    return filter.update(step.hidden);
}

/// All that a run says in ids.
std::vector<std::int64_t> decisions(const UpdateReport& report) {
    std::vector<std::int64_t> out;
    for (const Innovation& i : report.innovations)
        for (const std::int64_t v : {static_cast<std::int64_t>(i.outcome), i.landmark.value, i.track.value})
            out.push_back(v);
    return out;
}

std::string nameOf(Movers movers) {
    return movers == Movers::ekf ? "ekf" : movers == Movers::exact ? "exact" : "scalable";
}

class UnlabelledRuns : public testing::TestWithParam<std::tuple<Movers, Consistency>> {
  protected:
    JointFilterParameters parameters(JointEngine::Kind engine = JointEngine::Kind::compressed) const {
        return parametersOf(std::get<0>(GetParam()), std::get<1>(GetParam()), engine);
    }
};

void expectSameNumbers(const JointFilter& a, const JointFilter& b, double tolerance) {
    const PoseGaussian ours = a.robot(), theirs = b.robot();
    ASSERT_TRUE(near(ours.mean.vector(), theirs.mean.vector(), tolerance));
    // Relative to the largest entry, which lies below the 1 that `near` counts from.
    const double scale = 1 / theirs.covariance.cwiseAbs().maxCoeff();
    ASSERT_TRUE(near(scale * ours.covariance, scale * theirs.covariance, tolerance));
}

TEST_P(UnlabelledRuns, EnginesAgree) {
    // A sensor that reaches half as far, in a larger world, leaves most of the map behind.
    test::HiddenWorldOptions options;
    options.landmarks = 120;
    options.radius = 24;  // 603 steps a round
    options.range = 5;
    options.steps = 700;
    const HiddenWorld world(options);
    JointFilterParameters compressed = parameters();
    // Without commits the engines do the same sums. With them one mode stays exact but for rounding; the
    // exact IMM's modes are merged then, which EngineTwins has tests of.
    const bool commits = std::get<0>(GetParam()) != Movers::exact;
    compressed.engine.active_set.keep_at_least = commits ? 3 : 1000;
    compressed.engine.active_set.base_growth = commits ? 4 : 1e9;
    compressed.engine.active_set.activate_margin = 0.2;
    compressed.engine.active_set.keep_margin = 0.2;
    compressed.engine.active_set.retirable_part = 0.1;
    JointFilter a = started(compressed, world), b = started(parameters(JointEngine::Kind::dense), world);
    for (const HiddenWorld::Step& now : world.steps) {
        SCOPED_TRACE(toText(now.hidden.stamp));
        ASSERT_EQ(decisions(step(a, now)), decisions(step(b, now)));
        expectSameNumbers(a, b, 1e-9);
        if (HasFatalFailure()) return;
    }
    const auto ours = a.landmarks(), theirs = b.landmarks();
    ASSERT_EQ(ours.size(), theirs.size());
    for (std::size_t i = 0; i < ours.size(); ++i) {
        EXPECT_EQ(ours[i].id, theirs[i].id);
        EXPECT_EQ(ours[i].seen, theirs[i].seen);
        EXPECT_TRUE(near(ours[i].mean, theirs[i].mean, 1e-9));
    }
    const auto movers = a.tracks(), expected = b.tracks();
    ASSERT_EQ(movers.size(), expected.size());
    for (std::size_t i = 0; i < movers.size(); ++i) {
        EXPECT_EQ(movers[i].id, expected[i].id);
        EXPECT_TRUE(near(movers[i].mean, expected[i].mean, 1e-9));
        EXPECT_TRUE(near(movers[i].covariance, expected[i].covariance, 1e-9));
    }
    const auto& bank = dynamic_cast<const CompressedJointBank&>(a.state());
    EXPECT_EQ(bank.commits() > 5, commits) << bank.commits();
}

TEST_P(UnlabelledRuns, TheSameLogTwiceGivesTheSameBits) {
    const HiddenWorld world;
    JointFilter first = started(parameters(), world), again = started(parameters(), world);
    // The second has a past, which `start` wipes out.
    for (const HiddenWorld::Step& now : HiddenWorld({9}).steps) step(again, now);
    again.start({}, world.start());
    for (const HiddenWorld::Step& now : world.steps)
        ASSERT_EQ(decisions(step(first, now)), decisions(step(again, now)));
    const JointCovariance P = first.jointCovariance(), Q = again.jointCovariance();
    EXPECT_EQ(P.landmarks, Q.landmarks);
    EXPECT_EQ(P.tracks, Q.tracks);
    EXPECT_EQ(P.matrix, Q.matrix);
    EXPECT_EQ(first.robot().mean.vector(), again.robot().mean.vector());
    EXPECT_EQ(first.state().dimension(), again.state().dimension());
}

struct SeedResult {
    double nees = 0, squared_error = 0, labelled_squared_error = 0;
    int landmarks = 0, tracks = 0;  ///< that are believed to be there
    int matched_landmarks = 0, matched_tracks = 0;
};

SeedResult runOf(const JointFilterParameters& p, std::uint64_t seed) {
    test::HiddenWorldOptions options;
    options.seed = seed;
    const HiddenWorld world(options);
    JointFilterParameters known = p;
    known.association.landmarks = LandmarkAssociation::known;
    known.association.movers = MoverAssociation::known;
    JointFilter filter = started(p, world), labelled = started(known, world);
    SeedResult out;
    for (const HiddenWorld::Step& now : world.steps) {
        step(filter, now);
        labelled.predict(now.odometry);
        labelled.update(now.labelled);
        const auto squared = [&](const JointFilter& f) {
            return (f.robot().mean.position() - now.robot.position()).squaredNorm() / world.steps.size();
        };
        out.squared_error += squared(filter);
        out.labelled_squared_error += squared(labelled);
    }
    const HiddenWorld::Step& last = world.steps.back();
    const PoseGaussian robot = filter.robot();
    Vector3 error = robot.mean.vector() - last.robot.vector();
    error.z() = wrapAngle(error.z());
    out.nees = error.dot(robot.covariance.llt().solve(error));
    // What comes and goes with clutter is in the map too, with the probability that says so.
    for (const LandmarkEstimate& landmark : filter.landmarks()) {
        if (landmark.existence < 0.5) continue;
        ++out.landmarks;
        for (const Vector2& truth : world.landmarks)
            out.matched_landmarks += (landmark.mean - truth).norm() < 1;
    }
    for (const TrackEstimate& track : filter.tracks()) {
        if (track.existence < 0.5) continue;
        ++out.tracks;
        for (const Vector2& truth : last.movers)
            out.matched_tracks += (track.mean.head<2>() - truth).norm() < 1;
    }
    return out;
}

TEST_P(UnlabelledRuns, FindWhatIsThereAndKnowHowWell) {
    constexpr int seeds = 12;
    double nees = 0, squared = 0, labelled = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        SCOPED_TRACE(seed);
        const SeedResult run = runOf(parameters(), static_cast<std::uint64_t>(seed));
        EXPECT_EQ(run.landmarks, 25);
        EXPECT_EQ(run.matched_landmarks, 25);
        EXPECT_EQ(run.tracks, 2);
        EXPECT_EQ(run.matched_tracks, 2);
        nees += run.nees;
        squared += run.squared_error;
        labelled += run.labelled_squared_error;
    }
    // 36 degrees of freedom, 1e-4 on either side: a consistent filter fails in 2 of 10,000.
    EXPECT_GT(nees, chiSquareQuantile(1e-4, 3 * seeds));
    EXPECT_LT(nees, chiSquareQuantile(1 - 1e-4, 3 * seeds));
    // The bound for hidden identities.
    EXPECT_LT(std::sqrt(squared), 1.2 * std::sqrt(labelled));
}

INSTANTIATE_TEST_SUITE_P(All, UnlabelledRuns,
                         testing::Combine(testing::Values(Movers::ekf, Movers::exact, Movers::scalable),
                                          testing::Values(Consistency::classic, Consistency::invariant)),
                         [](const auto& each) {
                             return nameOf(std::get<0>(each.param)) +
                                    (std::get<1>(each.param) == Consistency::classic ? "_classic"
                                                                                     : "_invariant");
                         });

}  // namespace unlabelled_runs_test
}  // namespace slamot
