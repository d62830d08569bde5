// The claim this program stands on, at 300 seeds: in paper 1's scenario the textbook EKF is many times over-confident
// and the invariant one is not; with little bearing noise both are consistent. Seeds are fixed, so the outcome is too.
// The invariant core's bounds for the robot are the ones the project promises (ANEES 2.1-3.2, RMSE 0.19-0.36 m). The
// others guard what was measured: classic 68 +- 8, target 2.1 of 2, quiet 3.1 and 3.3 of 3, where 3.7 is the upper end
// of the 95 % band of a mean over 50 runs. A run's averages are heavy-tailed: the mean of 50 runs still spreads over 2.9
// to 3.4 in ANEES and 0.33 to 0.39 m in RMSE, which is why there are 300 (standard errors 0.09 and 0.015 m).
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "conformance/Play.h"
#include "slamot/eval/Metrics.h"
#include "slamot/sim/Scenario.h"

namespace slamot {
namespace {

struct Averages {
    double robot_nees = 0, robot_rmse = 0, target_nees = 0;
};

/// Mean over seeds of the time average of a run, robot and target.
Averages study(const std::string& scenario_name, const std::string& core, int seeds) {
    const std::string root = SLAMOT_SOURCE_DIR;
    const sim::Scenario scenario =
        sim::loadScenario(Config::fromFile(root + "/config/scenarios/" + scenario_name + ".ini"));
    Config config = Config::fromFile(root + "/config/runs/paper1_ekf.ini");
    config.set("ekf_slamot", "consistency", core);

    Averages mean;
    for (int seed = 1; seed <= seeds; ++seed) {
        const conformance::Play play = conformance::playOf(scenario, static_cast<std::uint64_t>(seed));
        conformance::Options options;
        options.plugin = "ekf_slamot";
        const auto estimator = conformance::createSubject(options);
        estimator->initialize(config);

        eval::RunRecord record;
        estimator->start(play.start);
        const auto keep = [&record](const Estimator& e) {
            const Estimate estimate = e.estimate();
            record.trajectory.push_back({estimate.stamp, estimate.robot});
            record.tracks[estimate.stamp] = estimate.tracks;
        };
        conformance::playSteps(*estimator, play, 0, play.steps.size(),
                               [&](const Estimator& e, const UpdateReport* report) {
                                   if (report) keep(e);
                               });
        record.landmarks = estimator->landmarks();

        const eval::Metrics metrics = eval::evaluate(record, play.truth, {});
        mean.robot_nees += metrics.robot_nees->average / seeds;
        mean.robot_rmse += metrics.robot->position.rmse / seeds;
        mean.target_nees += metrics.targets->all.nees->average / seeds;
    }
    return mean;
}

constexpr int seeds = 300;

TEST(PaperOneConsistency, InvariantCoreTellsTheTruthAboutItself) {
    const Averages averages = study("paper1", "invariant", seeds);
    EXPECT_GT(averages.robot_nees, 2.1);
    EXPECT_LT(averages.robot_nees, 3.2);
    EXPECT_GT(averages.robot_rmse, 0.19);
    EXPECT_LT(averages.robot_rmse, 0.36);
    EXPECT_GT(averages.target_nees, 1.3);
    EXPECT_LT(averages.target_nees, 2.4);
}

TEST(PaperOneConsistency, ClassicCoreIsManyTimesOverconfident) {
    const Averages averages = study("paper1", "classic", seeds);
    EXPECT_GT(averages.robot_nees, 45);
    EXPECT_LT(averages.robot_nees, 90);
}

TEST(PaperOneConsistency, BothAreConsistentWithQuietBearings) {
    for (const char* core : {"classic", "invariant"}) {
        const Averages averages = study("quiet", core, seeds);
        EXPECT_GT(averages.robot_nees, 2.1) << core;
        EXPECT_LT(averages.robot_nees, 3.7) << core;
    }
}

}  // namespace
}  // namespace slamot
