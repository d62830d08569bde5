// What a whole config file must say, and what it may not.
#include <gmock/gmock.h>

#include "run/Spy.h"
#include "slamot/run/RunConfig.h"
#include "support/Expect.h"

namespace slamot::test {
namespace run_config_test {

using run::assembleRun;
using testing::HasSubstr;

const PluginRegistry& registry() {
    static const PluginRegistry found = PluginRegistry::discover();
    return found;
}

run::AssembledRun assembled(const std::string& text) {
    return assembleRun(Config::fromText(text, "my.ini"), registry());
}

std::string errorOf(const std::string& text) {
    return messageOf<ConfigError>([&] { assembled(text); });
}

TEST(RunConfigTest, AnEmptyConfigIsTheDefaults) {
    const auto run = assembled("");
    EXPECT_EQ(run.config.estimator, "ekf_slamot");
    EXPECT_EQ(run.estimator->name(), "ekf_slamot");
    EXPECT_EQ(run.detector, nullptr);
    EXPECT_EQ(run.config.odometry, "auto");
    EXPECT_EQ(run.config.max_odometry_gap, 1.0);
    EXPECT_EQ(run.config.start.kind, run::StartPose::zero);
    EXPECT_EQ(run.config.clutter.per_scan, 0);
    EXPECT_EQ(run.config.clutter.detection_probability, 1);
    EXPECT_EQ(run.config.clutter.seed, std::nullopt);
}

TEST(RunConfigTest, EverySectionIsRead) {
    const auto run = assembled(
        "[run]\nestimator = dead_reckoning\nseed = 18446744073709551615\nodometry = wheels\nmax_odometry_gap "
        "= 2.5\n"
        "[log]\nreorder_window = 3\nstep = 0.25\n"
        "[identities]\nlandmarks = hidden\nmovers = log\n"
        "[sensors]\nfront camera = mixed\nlandmarks = ignore\n"
        "[noise]\nrange_std = 0.5\n"
        "[noise.front camera]\nrange_std_per_m = 0.05\nbearing_std_deg = 180\n"
        "[clutter]\nper_scan = 5\ndetection_probability = 0.9\nseed = 18446744073709551615\n"
        "[start]\npose = 1, -2, 90\nposition_std = 0.1\nheading_std_deg = 90\n"
        "[output]\ninterval = 0.5\nscene = false\ntentative = true\nparticles = true\nmost_particles = 7\n"
        "[motion]\nmodel = arc\n[dead_reckoning]\nnoise_scale = 2\n");
    const run::RunConfig& c = run.config;
    EXPECT_EQ(run.estimator->name(), "dead_reckoning");
    EXPECT_EQ(c.seed, UINT64_MAX);
    EXPECT_EQ(c.odometry, "wheels");
    EXPECT_EQ(c.max_odometry_gap, 2.5);
    EXPECT_EQ(c.log.reorder_window, 3);
    EXPECT_EQ(c.log.step, 0.25);
    EXPECT_EQ(c.landmark_identities, run::Identities::hidden);
    EXPECT_EQ(c.mover_identities, run::Identities::log);
    EXPECT_EQ(c.sensors.of("front camera"), run::SensorRole::mixed);
    EXPECT_EQ(c.sensors.of("landmarks"), run::SensorRole::ignore);
    EXPECT_EQ(c.noise.range_std, 0.5);
    EXPECT_EQ(c.noise.bearing_std, std::nullopt);
    EXPECT_EQ(c.noise_by_label.at("front camera").range_std_per_m, 0.05);
    EXPECT_EQ(c.noise_by_label.at("front camera").bearing_std, pi);
    EXPECT_EQ(c.clutter.per_scan, 5);
    EXPECT_EQ(c.clutter.detection_probability, 0.9);
    EXPECT_EQ(c.clutter.seed, UINT64_MAX);
    EXPECT_EQ(c.start.kind, run::StartPose::given);
    EXPECT_TRUE(near(c.start.pose.vector(), Vector3(1, -2, pi / 2), 1e-15));
    EXPECT_EQ(c.start.heading_std, pi / 2);
    EXPECT_EQ(c.output.interval, 0.5);
    EXPECT_FALSE(c.output.scene);
    EXPECT_TRUE(c.output.tentative);
    EXPECT_TRUE(c.output.particles);
    EXPECT_EQ(c.output.most_particles, 7);
    EXPECT_TRUE(c.output.map);
}

TEST(RunConfigTest, RolesWithoutALine) {
    const run::SensorRoles roles;
    EXPECT_EQ(roles.of(""), run::SensorRole::landmarks);
    EXPECT_EQ(roles.of("landmarks"), run::SensorRole::landmarks);
    EXPECT_EQ(roles.of("movers"), run::SensorRole::movers);
    EXPECT_EQ(roles.of("mixed"), run::SensorRole::mixed);
    EXPECT_EQ(roles.of("ignore"), std::nullopt) << "a sensor of that name is not to be ignored by accident";
    EXPECT_EQ(roles.of("camera"), std::nullopt);
}

TEST(RunConfigTest, MistakesNameFileLineKeyAndWhatWasExpected) {
    const std::pair<const char*, std::vector<const char*>> cases[] = {
        {"[run]\nestimater = ekf_slamot\n",
         {"my.ini:2", "'estimater'", "[run]", "did you mean 'estimator'?"}},
        {"[run]\nmax_odometry_gap = 0\n", {"my.ini:2", "max_odometry_gap", "'0'", "above 0"}},
        {"[run]\nmax_odometry_gap = nan\n", {"my.ini:2", "above 0"}},
        {"[run]\nmax_odometry_gap = 1 s\n", {"my.ini:2", "'1 s'"}},
        {"[run]\nseed = -1\n", {"my.ini:2", "whole number"}},
        {"[identities]\nlandmarks = yes\n", {"my.ini:2", "log | hidden"}},
        {"[sensors]\ncamera = landmark\n",
         {"my.ini:2", "camera", "'landmark'", "landmarks | movers | mixed"}},
        {"[noise]\nrange_std = 0\n", {"my.ini:2", "above 0", "auto"}},
        {"[noise.movers]\nrange_sdt = 1\n", {"my.ini:2", "[noise.movers]", "did you mean 'range_std'?"}},
        {"[clutter]\nper_scan = -1\n", {"my.ini:2", "per_scan", "[0, 400]"}},
        {"[clutter]\nper_scan = 500\n", {"my.ini:2", "[0, 400]"}},
        {"[clutter]\ndetection_probability = 1.5\n", {"my.ini:2", "[0, 1]"}},
        {"[clutter]\nseed = -1\n", {"my.ini:2", "whole number", "auto"}},
        {"[start]\npose = 1,2\n", {"my.ini:2", "zero | truth | x,y,theta_deg"}},
        {"[start]\npose = 1,2,inf\n", {"my.ini:2", "x,y,theta_deg"}},
        {"[output]\nscene = maybe\n", {"my.ini:2", "true | false"}},
        {"[ekf_slamot]\nconsistency = none\n", {"my.ini:2", "invariant | classic"}},
        {"\n[ekf_slamot.outlier]\ngate_probability = 0.9\n",
         {"my.ini:2", "[ekf_slamot.outlier]", "outliers"}},
        {"[motions]\nmodel = arc\n", {"my.ini:1", "[motions]", "did you mean 'motion'?"}},
        {"[eval]\n[evals]\n", {"my.ini:2", "[evals]"}},
    };
    for (const auto& [text, parts] : cases)
        for (const char* part : parts) EXPECT_THAT(errorOf(text), HasSubstr(part)) << text;
}

TEST(RunConfigTest, SectionsOfPluginsThatAreNotRunAreCheckedToo) {
    EXPECT_NO_THROW(assembled("[run]\nestimator = dead_reckoning\n[ekf_slamot]\nconsistency = classic\n"));
    EXPECT_THAT(errorOf("[run]\nestimator = dead_reckoning\n[ekf_slamot]\nconsistancy = classic\n"),
                HasSubstr("did you mean 'consistency'?"));
    EXPECT_THAT(errorOf("[run]\nestimator = dead_reckoning\n[ekf_slamot.target]\nmodel = bicycle\n"),
                HasSubstr("my.ini:4"));
    EXPECT_THAT(errorOf("[run]\nestimator = ekf_slamot\n[dead_reckoning]\nnoise_scale = -1\n"),
                HasSubstr("above 0"));
}

TEST(RunConfigTest, UnknownPluginsAreNamedWithTheNearest) {
    const auto text = [](const char* line) {
        return Config::fromText(std::string("[run]\n") + line, "my.ini");
    };
    EXPECT_THAT(messageOf<PluginError>([&] { assembleRun(text("estimator = ekf_slamto\n"), registry()); }),
                HasSubstr("did you mean 'ekf_slamot'?"));
    EXPECT_THAT(messageOf<PluginError>([&] { assembleRun(text("detector = grid\n"), registry()); }),
                HasSubstr("no detector 'grid'"));
    EXPECT_ANY_THROW(assembleRun(text("estimator =\n"), registry()));
}

TEST(RunConfigTest, EqualConfigsGiveOneCanonicalText) {
    EXPECT_EQ(assembled("[run]\nseed = 5\nodometry = a\n[start]\npose = zero\n").canonical_config,
              assembled("[start]\npose=zero // here\n[run]\n odometry = a\nseed =5\n").canonical_config);
}

TEST(RunConfigTest, TheFullTextOfEveryPluginAssemblesToItsDefaults) {
    ASSERT_GE(registry().plugins().size(), 2u);
    for (const PluginInfo& plugin : registry().plugins()) {
        const std::string text = run::fullConfigText(plugin.name, registry());
        const auto run = assembled(text);
        if (plugin.kind == "estimator") {
            EXPECT_EQ(run.estimator->name(), plugin.name);
        }
        // Printing the read values again gives the same text: nothing is lost on the way.
        run::RunConfig config = run.config;
        for (const ParameterTable& table : describe(config)) {
            EXPECT_THAT(text, HasSubstr(toIni(table))) << plugin.name;
        }
        for (const ParameterTable& table : run.estimator->parameterTables())
            EXPECT_THAT(text, HasSubstr(toIni(table))) << plugin.name;
    }
    EXPECT_THROW(run::fullConfigText("none_such", registry()), PluginError);
}

}  // namespace run_config_test
}  // namespace slamot::test
