// The scalable form against the exact one: the same logs of paper 1's world to both, ratio of errors over
// seeds.
#include <gtest/gtest.h>
#include <slamot/sim/Scenario.h>

#include <cmath>
#include <string>
#include <vector>

#include "conformance/Play.h"

namespace slamot {
namespace scalable_form_test {

/// Paper 1's scenario with another number of landmarks, and with a second mover.
sim::Scenario paperWorld(int landmarks, bool second_mover) {
    Config config = Config::fromFile(std::string(SLAMOT_SOURCE_DIR) + "/config/scenarios/paper1.ini");
    config.set("world", "landmarks", std::to_string(landmarks));
    if (second_mover) {
        for (const auto& [key, entry] : config.section("mover.0")) config.set("mover.1", key, entry.value);
        config.set("mover.1", "position", "25,-12");
        config.set("mover.1", "velocity", "2.5,-0.5");
    }
    return sim::loadScenario(config);
}

struct Errors {
    double robot = 0, targets = 0;  ///< RMSE of position [m]
};
Errors errorsOf(const std::string& form, const conformance::Play& play) {
    conformance::Options options;
    options.plugin = "imm_slamot";
    options.config =
        "[imm_slamot]\nform = " + form +
        "\n[imm_slamot.outliers]\ntreatment = accept\n"
        "[imm_slamot.modes]\nmodes = cv:cv:0.1, ca:ca:1.8\nnoise_interval = 0\ntransition_interval = 0\n";
    const auto estimator = conformance::subjectFor(options, play);
    Errors sum;
    int steps = 0, sights = 0;
    conformance::playAll(*estimator, play, [&](const Estimator& now, const UpdateReport* report) {
        if (!report) return;
        sum.robot += (now.robot().mean.position() - play.truth.robotAt(now.time())->position()).squaredNorm();
        ++steps;
        for (const TrackEstimate& track : now.tracks())
            if (const auto truth = play.truth.targetAt(track.source, now.time())) {
                sum.targets += (track.mean.head<2>() - truth->position).squaredNorm();
                ++sights;
            }
    });
    return {std::sqrt(sum.robot / steps), std::sqrt(sum.targets / sights)};
}

/// Geometric means over seeds of scalable / exact.
Errors ratio(const sim::Scenario& world, int seeds) {
    Errors logs;
    for (int seed = 1; seed <= seeds; ++seed) {
        const conformance::Play play = conformance::playOf(world, static_cast<std::uint64_t>(seed));
        const Errors exact = errorsOf("exact", play), scalable = errorsOf("scalable", play);
        logs.robot += std::log(scalable.robot / exact.robot) / seeds;
        logs.targets += std::log(scalable.targets / exact.targets) / seeds;
    }
    return {std::exp(logs.robot), std::exp(logs.targets)};
}

TEST(ScalableFormTest, IsAsGoodAsTheExactOneOnADenseMap) {
    // Measured over 30 seeds: 0.996 +- 0.011 and 0.997 +- 0.008. Ten seeds have deviations of 0.02 and 0.015;
    // three of them.
    const Errors r = ratio(paperWorld(800, false), 10);
    EXPECT_NEAR(r.robot, 1, 0.06);
    EXPECT_NEAR(r.targets, 1, 0.045);
}

TEST(ScalableFormTest, CostsATenthOnASparseMapWithTwoMovers) {
    // 40 landmarks. Measured over 200 seeds: 1.111 +- 0.027 and 1.087 +- 0.017; 60 seeds have deviations of
    // 0.05 and 0.03.
    const Errors r = ratio(paperWorld(40, true), 60);
    EXPECT_LT(r.robot, 1.111 + 3 * 0.05);
    EXPECT_LT(r.targets, 1.087 + 3 * 0.03);
    EXPECT_GT(r.targets, 0.95) << "better than exact is a fault in the comparison";
}

}  // namespace scalable_form_test
}  // namespace slamot
