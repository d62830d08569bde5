// What a study file means, and what is wrong with bad ones.
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "StudyFolder.h"
#include "slamot/core/random/RandomStream.h"
#include "slamot/study/Plan.h"
#include "support/Expect.h"

namespace slamot::study {
namespace plan_test {

using test::messageOf;
using testing::ElementsAre;
using testing::HasSubstr;

class PlanTest : public StudyFolder {
  protected:
    std::string mistake(const std::string& text) const {
        return messageOf<ConfigError>([&] { plan(text); });
    }
    static std::vector<std::string> worldNames(const Plan& plan) {
        std::vector<std::string> names;
        for (const WorldPlan& world : plan.worlds) names.push_back(plan.nameOf(world));
        return names;
    }
};

TEST_F(PlanTest, WorldsGoReplicateByReplicateInTheOrderOfTheFile) {
    const Plan laid = plan(usual("2"));
    EXPECT_THAT(worldNames(laid), ElementsAre("near-1", "far-1", "near-2", "far-2"));
    EXPECT_EQ(laid.runCount(), 8u);
    EXPECT_EQ(keysOf(laid).size(), 8u);
    EXPECT_EQ(laid.nameOf(laid.runsOf(laid.worlds[0])[0]), "classic");
    EXPECT_EQ(laid.nameOf(laid.runsOf(laid.worlds[0])[1]), "invariant");
}

TEST_F(PlanTest, ALongerStudyBeginsWithTheShorterOnesRuns) {
    const Plan three = plan(usual("3"));
    PlanRequest request;
    request.short_form = true;
    const Plan two = plan(usual("3"), request);
    ASSERT_EQ(two.worlds.size(), 4u);
    for (std::size_t w = 0; w < two.worlds.size(); ++w)
        for (std::size_t r = 0; r < 2; ++r)
            EXPECT_EQ(two.keyOf(two.worlds[w], two.runsOf(two.worlds[w])[r]),
                      three.keyOf(three.worlds[w], three.runsOf(three.worlds[w])[r]));
    request.replicates = 1;
    EXPECT_EQ(plan(usual("3"), request).worlds.size(), 2u);
}

TEST_F(PlanTest, SeedsPairConfigsAndGridPointsButNotWorlds) {
    const Plan laid = plan(usual("2") +
                           "[grid]\nekf_slamot.target.noise_std = 0.1 | 0.2\n[grid.scenario]\n"
                           "sensor.landmarks.range_std = 0.1 | 0.3\n");
    // 2 replicates of (2 scenarios x 2 points); in each 2 configs x 2 points.
    EXPECT_THAT(worldNames(laid), ElementsAre("near-p1-1", "near-p2-1", "far-p1-1", "far-p2-1", "near-p1-2",
                                              "near-p2-2", "far-p1-2", "far-p2-2"));
    EXPECT_EQ(laid.runCount(), 32u);
    EXPECT_EQ(keysOf(laid).size(), 32u);
    EXPECT_EQ(laid.worlds[0].world_seed, laid.worlds[1].world_seed);
    EXPECT_NE(laid.worlds[0].world_seed, laid.worlds[2].world_seed);
    EXPECT_NE(laid.worlds[0].world_seed, laid.worlds[4].world_seed);
    std::set<std::uint64_t> seeds;
    for (const RunPlan& one : laid.runsOf(laid.worlds[0]))
        seeds.insert(laid.estimatorSeedOf(laid.worlds[0], one));
    EXPECT_EQ(seeds.size(), 4u);
    EXPECT_EQ(laid.nameOf(laid.runsOf(laid.worlds[0])[3]), "invariant-p2");
    EXPECT_EQ(laid.configs[3].config.section("ekf_slamot.target").at("noise_std").value, "0.2");
    EXPECT_EQ(laid.kinds[1].scenario->section("sensor.landmarks").at("range_std").value, "0.3");
    // The scenario's own override stands beside the grid's.
    EXPECT_EQ(laid.kinds[1].scenario->section("sensor.landmarks").at("max_range").value, "15");
}

TEST_F(PlanTest, KeysTellApartWhatGivesOtherRowsAndNothingElse) {
    const auto keys = [&](const std::string& text) { return keysOf(plan(text)); };
    const auto first = keys(usual());
    EXPECT_EQ(keys(usual() + "[labels]\nclassic = the old one\n[table.a]\nkind = means\n"), first);
    const auto none_of_first = [&](const std::set<std::string>& others) {
        for (const std::string& key : others) EXPECT_EQ(first.count(key), 0u);
    };
    std::string text = usual();
    none_of_first(keys(text.replace(text.find("seed = 4"), 8, "seed = 5")));
    text = usual();
    none_of_first(keys(text.replace(text.find("robot_nees"), 10, "robot_error")));
    folder.write("field.ini", folder.read("field.ini") + "phase = 0\n");
    none_of_first(keys(usual()));
}

TEST_F(PlanTest, VariantsRunWhereTheySayAndWithTheSourcesConfig) {
    const Plan laid = plan(
        "[study]\nreplicates = 1\n[scenario.a]\nfile = field.ini\nconfig = ekf.ini\n[scenario.b]\nfile = "
        "field.ini\n"
        "[config.own]\nekf_slamot.consistency = classic\non = a\n[config.file]\nfile = ekf.ini\non = b, a\n"
        "[config.b_only]\nfile = ekf.ini\nrun.estimator = dead_reckoning\non = b\n");
    ASSERT_EQ(laid.worlds.size(), 2u);
    std::vector<std::string> a, b;
    for (const RunPlan& one : laid.runsOf(laid.worlds[0])) a.push_back(laid.nameOf(one));
    for (const RunPlan& one : laid.runsOf(laid.worlds[1])) b.push_back(laid.nameOf(one));
    EXPECT_THAT(a, ElementsAre("own", "file"));
    EXPECT_THAT(b, ElementsAre("file", "b_only"));
    const Config& own = laid.configs[laid.runsOf(laid.worlds[0])[0].config].config;
    EXPECT_EQ(own.section("ekf_slamot").at("consistency").value, "classic");
    EXPECT_EQ(own.section("motion").at("wheelbase").value, "2");
    EXPECT_THAT(
        mistake("[study]\n[scenario.a]\nfile = field.ini\n[config.c]\nekf_slamot.consistency = classic\n"),
        HasSubstr("small.ini:4: [config.c] has no 'file' and source a no 'config'"));
}

TEST_F(PlanTest, LogsAreRunAsOftenAsTheySay) {
    for (const char* name : {"a.rawlog", "b.rawlog"}) folder.write(name, name);
    const std::string begin = "[study]\nshort_replicates = 2\n[log.l]\nfiles = *.rawlog\n",
                      config = "[config.c]\nfile = ekf.ini\n";
    const Plan once = plan(begin + config), thrice = plan(begin + "replicates = 3\n" + config);
    EXPECT_THAT(worldNames(once), ElementsAre("l-1", "l-2"));
    EXPECT_THAT(worldNames(thrice), ElementsAre("l-1", "l-2", "l-3", "l-4", "l-5", "l-6"));
    std::set<std::uint64_t> seeds;
    for (std::size_t w = 0; w < 6; ++w) {
        EXPECT_THAT(thrice.kinds[thrice.worlds[w].kind].log_file, HasSubstr(w % 2 ? "b.rawlog" : "a.rawlog"));
        seeds.insert(thrice.worlds[w].world_seed);
    }
    EXPECT_EQ(seeds.size(), 6u);
    for (std::size_t w = 0; w < 2; ++w)
        EXPECT_EQ(once.keyOf(once.worlds[w], once.runsOf(once.worlds[w])[0]),
                  thrice.keyOf(thrice.worlds[w], thrice.runsOf(thrice.worlds[w])[0]));
    PlanRequest request;
    request.short_form = true;
    EXPECT_EQ(plan(begin + "replicates = 3\n" + config, request).worlds.size(), 4u);
    EXPECT_EQ(plan(begin + config, request).worlds.size(), 2u);
    request.short_form = false;
    request.replicates = 5;
    EXPECT_EQ(plan(begin + "replicates = 3\n" + config, request).worlds.size(), 10u);
    EXPECT_EQ(plan(begin + config, request).worlds.size(), 2u) << "run once, says the file";
    EXPECT_THAT(mistake(begin + "replicates = 0\n" + config), HasSubstr("small.ini:5: replicates = '0'"));
}

TEST_F(PlanTest, TheSeedOfClutterIsTheStudysToSet) {
    EXPECT_THAT(mistake(usual() + "[grid]\nclutter.seed = 1 | 2\n"), HasSubstr("clutter.seed is derived"));
    // One in a config's file changes no run, so neither its key.
    const auto keys = [&](const std::string& seed) {
        folder.write("cluttered.ini", "[clutter]\nper_scan = 2\n" + seed);
        return keysOf(plan("[study]\n[scenario.s]\nfile = field.ini\n[config.c]\nfile = cluttered.ini\n"));
    };
    EXPECT_EQ(keys("seed = 5\n"), keys("seed = 6\n"));
}

TEST_F(PlanTest, AStudyFileMayBeginWithAByteOrderMark) {
    EXPECT_EQ(keysOf(plan("\xEF\xBB\xBF" + usual())), keysOf(plan(usual())));
}

TEST_F(PlanTest, AMillionReplicatesAreLaidOutInLittleMemory) {
    PlanRequest request;
    request.replicates = 1000000;
    const Plan laid = plan(usual(), request);
    EXPECT_EQ(laid.runCount(), 4000000u);
    // Per world, whatever it has of runs; keys are computed when asked for.
    EXPECT_LE(sizeof(WorldPlan), 24u);
    EXPECT_EQ(laid.worlds.capacity(), 2000000u);
    EXPECT_EQ(laid.nameOf(laid.worlds.back()), "far-1000000");
    const Plan small = plan(usual());
    for (std::size_t w = 0; w < small.worlds.size(); ++w)
        EXPECT_EQ(laid.keyOf(laid.worlds[w], laid.runsOf(laid.worlds[w])[1]),
                  small.keyOf(small.worlds[w], small.runsOf(small.worlds[w])[1]));
}

TEST_F(PlanTest, AMissingDatasetIsSkippedWithASentenceUnlessNothingRemains) {
    const std::string log = "[log.mine]\nimport = mrclam\nfolder = no_such_folder\nfiles = *.rawlog\n";
    const Plan laid = plan(usual("1") + log);
    EXPECT_EQ(laid.worlds.size(), 2u);
    EXPECT_THAT(laid.skipped, ElementsAre(HasSubstr("source mine is skipped: there is no no_such_folder")));
    EXPECT_THAT(mistake("[study]\n" + log + "[config.c]\nfile = ekf.ini\n"),
                HasSubstr("nothing remains to run"));
}

/// The datasets' folder of a test, put back at its end.
class DatasetsAt {
  public:
    explicit DatasetsAt(const std::string& folder) {
        if (const char* before = std::getenv(name)) before_ = before;
        setenv(name, folder.c_str(), 1);
    }
    ~DatasetsAt() { before_ ? setenv(name, before_->c_str(), 1) : unsetenv(name); }
    DatasetsAt(const DatasetsAt&) = delete;
    DatasetsAt& operator=(const DatasetsAt&) = delete;

  private:
    static constexpr const char* name = "SLAMOT_DATASETS";
    std::optional<std::string> before_;
};

TEST_F(PlanTest, AScenarioMayTakeItsFilesFromADataset) {
    const DatasetsAt datasets(folder.path());
    const std::string scenario =
        "[scenario.map]\nfile = field.ini\nfolder = map\nworld.kind = file\nworld.file = landmarks.csv\n"
        "robot.controller = waypoints\nrobot.path_file = way.csv\n";
    EXPECT_THAT(plan(usual("1") + scenario).skipped,
                ElementsAre(HasSubstr("source map is skipped: there is no map in the datasets' folder")));
    std::filesystem::create_directory(folder.path("map"));
    folder.write("map/landmarks.csv", "id,x,y\n0,4,1\n");
    folder.write("map/way.csv", "x,y\n9,0\n");
    const std::string study = "[study]\nreplicates = 1\n" + scenario + "[config.c]\nfile = ekf.ini\n";
    const Plan laid = plan(study);
    EXPECT_THAT(laid.skipped, testing::IsEmpty());
    const std::vector<Row> rows = run(laid);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].metrics.at("counts.landmarks"), 1);
    // What the files hold tells runs apart, where they lie does not.
    const std::set<std::string> keys = keysOf(laid);
    std::filesystem::create_directory(folder.path("elsewhere"));
    std::filesystem::rename(folder.path("map"), folder.path("elsewhere/map"));
    const DatasetsAt moved(folder.path("elsewhere"));
    EXPECT_EQ(keysOf(plan(study)), keys);
    folder.write("elsewhere/map/way.csv", "x,y\n9,1\n");
    EXPECT_NE(keysOf(plan(study)), keys);
}

TEST_F(PlanTest, WhatASourceTellsHoldsForEveryConfigThatDoesNotSayOtherwise) {
    const std::string
        begin =
            "[study]\nreplicates = 1\n[scenario.a]\nfile = field.ini\nconfig = ekf.ini\n[scenario.b]\n"
            "file = field.ini\nconfig = ekf.ini\n",
        configs =
            "[config.file]\nfile = ekf.ini\n[config.own]\n[config.firm]\nfile = ekf.ini\n"
            "motion.speed_std = 0.3\n";
    const Plan laid = plan(begin + "[told.b]\nmotion.speed_std = 0.2\n" + configs);
    const auto told = [&](std::size_t world, std::size_t run) {
        const Config::Section& motion =
            laid.configs[laid.runsOf(laid.worlds[world])[run].config].config.section("motion");
        const auto found = motion.find("speed_std");
        return found == motion.end() ? "" : found->second.value;
    };
    ASSERT_EQ(laid.worlds.size(), 2u);
    for (std::size_t world = 0; world < 2; ++world) ASSERT_EQ(laid.runsOf(laid.worlds[world]).size(), 3u);
    EXPECT_THAT((std::vector<std::string>{told(0, 0), told(0, 1), told(0, 2)}), ElementsAre("", "", "0.3"));
    EXPECT_THAT((std::vector<std::string>{told(1, 0), told(1, 1), told(1, 2)}),
                ElementsAre("0.2", "0.2", "0.3"));
    // Runs elsewhere are the ones they would be without it.
    const Plan without = plan(begin + configs);
    for (std::size_t run = 0; run < 3; ++run)
        EXPECT_EQ(laid.keyOf(laid.worlds[0], laid.runsOf(laid.worlds[0])[run]),
                  without.keyOf(without.worlds[0], without.runsOf(without.worlds[0])[run]));

    EXPECT_THAT(mistake(begin + "[told.c]\nmotion.speed_std = 0.2\n" + configs),
                HasSubstr("small.ini:9: [told.c] is about no source"));
    EXPECT_THAT(mistake(begin + "[told.b]\nspeed_std = 0.2\n" + configs),
                HasSubstr("small.ini:10: unknown key 'speed_std' in [told.b], expected section.key"));
    EXPECT_THAT(mistake(begin + "[told.b]\nmotion.sped_std = 0.2\n" + configs), HasSubstr("small.ini:10"));
    EXPECT_THAT(mistake(begin + "[told.b]\nmotion.speed_std = 0.2\n" + configs +
                        "[grid]\nmotion.speed_std = 1 | 2\n"),
                HasSubstr("is a key of [grid] too"));
}

TEST_F(PlanTest, MistakesNameFileLineKeyAndWhatWasExpected) {
    const std::string begin = "[study]\nseed = 1\n[scenario.s]\nfile = field.ini\n";  // lines 1 to 4
    const std::string config = "[config.c]\nfile = ekf.ini\n";                        // lines 5 and 6
    const auto line = [&](int number) { return "small.ini:" + std::to_string(number) + ": "; };
    const auto expect = [&](const std::string& text, int number, const std::string& says) {
        const std::string told = mistake(text);
        EXPECT_THAT(told, HasSubstr(line(number)));
        EXPECT_THAT(told, HasSubstr(says));
    };
    EXPECT_THAT(mistake("[scenario.s]\nfile = field.ini\n" + config), HasSubstr("no section [study]"));
    EXPECT_THAT(mistake("[study]\n" + config), HasSubstr("no worlds"));
    EXPECT_THAT(mistake(begin), HasSubstr("runs nothing"));
    expect(begin + config + "[grids]\n", 7, "did you mean 'grid'?");
    expect("[study]\nreplicate = 3\n", 2, "did you mean 'replicates'?");
    expect("[study]\nreplicates = 0\n", 2, "expected");
    expect("[study]\nseries = robot_nes\n", 2, "did you mean 'robot_nees'?");
    expect(begin + "fil = x\n" + config, 5, "did you mean 'file'?");
    expect(begin + "robot = -1\n" + config, 5, "robot = '-1'");
    expect(begin + "robot = 3\n" + config, 3, "has no robot 3");
    expect("[study]\n[scenario.s]\nfile = gone.ini\n" + config, 3, "gone.ini");
    expect("[study]\n[scenario.s]\n" + config, 2, "has no 'file'");
    expect("[study]\n[scenario.a b]\nfile = field.ini\n" + config, 2, "expected a name");
    expect(begin + config + "on = t\n", 7, "no source 't'");
    expect(begin + config + "run.seed = 3\n", 7, "[study] seed");
    expect(begin + config + "ekf_slamot.consistncy = classic\n", 7, "did you mean 'consistency'?");
    expect(begin + "world.landmark = 3\n" + config, 5, "did you mean 'landmarks'?");
    expect(begin + config + "[grid]\nnoise = 1\n", 8, "expected section.key");
    expect(begin + config + "[grid]\nekf_slamot.target.noise_std = 1 | | 2\n", 8, "separated by |");
    expect(begin + config + "[grid]\nekf_slamot.target.noise_std = 1 | 1\n", 8, "twice");
    expect(begin + config + "ekf_slamot.target.noise_std = 3\n[grid]\nekf_slamot.target.noise_std = 1 | 2\n",
           7, "is a key of [grid] too");
    expect(begin + config + "[grid]\nekf_slamot.target.noise_std = 1 | one\n", 8, "noise_std = 'one'");
    expect("[study]\n[log.l]\nfiles = *.rawlog\n" + config + "[grid.scenario]\nworld.landmarks = 1\n", 6,
           "changes nothing");
    expect(begin + config + "[log.s]\nfiles = *.rawlog\n", 7, "have one name");
    expect(begin + config + "[log.l]\nimport = mrclam\n", 7, "has no 'files'");
    expect(begin + config + "[log.l]\nimport = mrklam\nfiles = *.rawlog\nfolder = .\n", 8,
           "did you mean 'mrclam'?");
}

}  // namespace plan_test
}  // namespace slamot::study
