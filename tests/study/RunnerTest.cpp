// Rows do not depend on how they came to be.
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "../../libs/study/src/FigureNames.h"
#include "StudyFolder.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/RawlogWriter.h"
#include "slamot/run/RunJob.h"
#include "slamot/sim/Simulation.h"
#include "slamot/study/Runner.h"
#include "support/Expect.h"

namespace slamot::study {
namespace runner_test {

using testing::HasSubstr;

class RunnerTest : public StudyFolder {
  protected:
    /// Writes world `w` of a plan of scenarios as a rawlog with its truth.
    std::string writeWorld(const Plan& plan, std::size_t w, const std::string& name) const {
        const PlannedWorldKind& kind = plan.kinds[plan.worlds[w].kind];
        const auto logs = sim::simulate(sim::loadScenario(*kind.scenario), plan.worlds[w].world_seed);
        const std::string file = folder.path(name);
        RawlogWriter writer(file);
        for (const auto& observation : logs.at(0).observations()) writer.write(*observation);
        writer.close();
        writeTruth(logs[0].truth, truthFolderOf(file));
        return file;
    }
};

TEST_F(RunnerTest, RowsHaveMetricsSeriesAndCosts) {
    const Plan laid = plan(usual("1"));
    RunnerOptions options;
    options.unit.measure_memory = true;
    const std::vector<Row> rows = run(laid, options);
    ASSERT_EQ(rows.size(), 4u);
    for (const Row& row : rows) {
        EXPECT_EQ(row.status, "complete") << row.reason;
        EXPECT_GT(row.metrics.at("robot.position.rmse"), 0);
        EXPECT_GT(row.metrics.at("counts.landmarks"), 2);
        EXPECT_EQ(row.metrics.count("nis.landmarks.landmark.mean_per_degree"), 1u);
        const Series& nees = row.series.at("robot_nees");
        ASSERT_EQ(nees.value.size(), 16u);  // steps 0 to 15
        EXPECT_EQ(nees.dimension.size(), 16u);
        EXPECT_DOUBLE_EQ(nees.seconds.back(), 3.0);  // 15 x 0.2 s
        double sum = 0;
        int steps = 0;
        for (std::size_t i = 0; i < 16; ++i)
            if (nees.dimension[i] > 0) sum += nees.value[i], ++steps;
        EXPECT_NEAR(sum / steps, row.metrics.at("robot_nees.average"), 1e-12 * sum);
        EXPECT_EQ(row.series.at("landmark_count").value.back(), row.metrics.at("counts.landmarks"));
        EXPECT_GT(row.cost.wall_s, 0);
        EXPECT_GT(row.cost.simulate_s, 0);
        EXPECT_GT(row.cost.cpu_s, 0);
        EXPECT_LE(row.cost.step_ms_p50, row.cost.step_ms_p99);
        EXPECT_LE(row.cost.step_ms_p99, row.cost.step_ms_max);
        EXPECT_LE(row.cost.step_ms_mean, row.cost.step_ms_max);
        EXPECT_GE(row.cost.memory_mb, 0);
        EXPECT_FALSE(row.cost.host.empty());
    }
    EXPECT_NE(rows[0].estimate_hash, rows[1].estimate_hash);
}

TEST_F(RunnerTest, EveryMetricOfARowIsAFigure) {
    const std::vector<Row> rows = run(plan(usual("1")));
    ASSERT_FALSE(rows.empty());
    for (const Row& row : rows) {
        EXPECT_EQ(row.metrics.count("counts.detections_used"), 1u);
        for (const auto& [name, value] : row.metrics) EXPECT_TRUE(isFigure(name)) << name;
    }
    EXPECT_FALSE(isFigure("counts.landmark"));
    EXPECT_EQ(nearestFigure("counts.landmark"), "counts.landmarks");
}

TEST_F(RunnerTest, ThreadsShardsAndInterruptionsGiveTheSameRows) {
    const Plan laid = plan(usual("6"));
    const auto serial = identities(run(laid));
    ASSERT_EQ(serial.size(), 24u);
    for (const int threads : {2, 5}) {
        RunnerOptions options;
        options.threads = threads;
        EXPECT_EQ(identities(run(laid, options)), serial) << threads;
    }
    std::vector<Row> shards;
    for (int k = 1; k <= 4; ++k)
        for (const Row& row : run(laid, unitsOf(laid, {}, {k, 4}))) shards.push_back(row);
    EXPECT_EQ(shards.size(), 24u);
    EXPECT_EQ(identities(shards), serial);

    // Stopped after seven rows, and then the rest.
    std::atomic<bool> stop{false};
    RunnerOptions options;
    options.unit.stop = &stop;
    options.progress = [&](const StudyProgress& now) { stop = now.done >= 7; };
    std::vector<Row> rows = run(laid, options);
    EXPECT_GE(rows.size(), 7u);
    EXPECT_LT(rows.size(), 12u);
    std::set<std::string> keys;
    for (const Row& row : rows) keys.insert(row.key);
    std::set<RunIndex> done;
    for (std::size_t w = 0; w < laid.worlds.size(); ++w)
        for (std::size_t r = 0; r < laid.runsOf(laid.worlds[w]).size(); ++r)
            if (keys.count(laid.keyOf(laid.worlds[w], laid.runsOf(laid.worlds[w])[r]))) done.insert({w, r});
    const auto rest = run(laid, unitsOf(laid, done, {}));
    EXPECT_EQ(rows.size() + rest.size(), 24u);
    rows.insert(rows.end(), rest.begin(), rest.end());
    EXPECT_EQ(identities(rows), serial);
}

TEST_F(RunnerTest, ShardsAreEqualPartsOfEveryScenario) {
    const Plan laid = plan(usual("6"));
    for (int k = 1; k <= 3; ++k) {
        std::map<std::string, int> worlds;
        for (const Unit& unit : unitsOf(laid, {}, {k, 3}))
            ++worlds[laid.sourceOf(laid.worlds[unit.world]).name];
        EXPECT_EQ(worlds["near"], 2);
        EXPECT_EQ(worlds["far"], 2);
    }
}

TEST_F(RunnerTest, PairedWorldsAreTheSameWorld) {
    // A config that only reads odometry, once more under another name: its errors show the world alone.
    const Plan laid = plan(
        "[study]\nreplicates = 2\n[scenario.s]\nfile = field.ini\n"
        "[config.a]\nfile = ekf.ini\nrun.estimator = dead_reckoning\n"
        "[config.b]\nfile = ekf.ini\nrun.estimator = dead_reckoning\nekf_slamot.consistency = classic\n");
    const std::vector<Row> rows = run(laid);
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_EQ(rows[0].metrics, rows[1].metrics);
    EXPECT_NE(rows[0].metrics.at("robot.position.rmse"), rows[2].metrics.at("robot.position.rmse"));
    EXPECT_NE(rows[0].key, rows[1].key);
}

TEST_F(RunnerTest, AWorldInMemoryGivesTheSameRunAsItsRawlog) {
    const Plan laid = plan(usual("1"));
    const std::vector<Row> rows = run(laid);
    const std::string file = writeWorld(laid, 0, "near.rawlog");
    const Truth truth = readTruth(truthFolderOf(file));
    for (std::size_t r = 0; r < 2; ++r) {
        run::RunRequest request;
        const RunPlan& one = laid.runsOf(laid.worlds[0])[r];
        request.config = laid.configs[one.config].config;
        request.config.set("run", "seed", std::to_string(laid.estimatorSeedOf(laid.worlds[0], one)));
        request.log_file = file;
        request.out_folder = folder.path("out");
        request.truth = &truth;
        const run::JobResult result = run::runLog(request, registry());
        EXPECT_EQ(result.estimate_hash, rows[r].estimate_hash);
        EXPECT_EQ(result.summary["metrics"]["robot"]["position"]["rmse"],
                  rows[r].metrics.at("robot.position.rmse"));
    }
}

TEST_F(RunnerTest, RecordedLogsAreWorldsToo) {
    const Plan simulated = plan(usual("2"));
    for (const std::size_t w : {0, 2}) writeWorld(simulated, w, "log_" + std::to_string(10 - w) + ".rawlog");
    const Plan laid = plan(
        "[study]\nseries = robot_nees\n[log.mine]\nfiles = log_*.rawlog\nconfig = ekf.ini\n"
        "[config.classic]\nekf_slamot.consistency = classic\n[config.invariant]\n");
    ASSERT_EQ(laid.worlds.size(), 2u);
    EXPECT_THAT(laid.kinds[0].log_file, HasSubstr("log_8.rawlog"));  // 8 before 10
    EXPECT_THAT(laid.kinds[1].log_file, HasSubstr("log_10.rawlog"));
    EXPECT_EQ(unitsOf(laid, {}, {}).size(), 4u);
    const std::vector<Row> rows = run(laid), from_simulation = run(simulated);
    ASSERT_EQ(rows.size(), 4u);
    RunnerOptions threads;
    threads.threads = 3;
    EXPECT_EQ(identities(run(laid, threads)), identities(rows)) << "logs are read in several threads";
    // log_10 is the simulation's first world; neither core draws random numbers.
    EXPECT_EQ(rows[2].estimate_hash, from_simulation[0].estimate_hash);
    EXPECT_EQ(rows[3].estimate_hash, from_simulation[1].estimate_hash);
    EXPECT_EQ(rows[2].metrics.at("robot.position.rmse"),
              from_simulation[0].metrics.at("robot.position.rmse"));
    EXPECT_EQ(rows[2].replicate, 2);
}

TEST_F(RunnerTest, ClutterIsAnotherInEveryReplicateOfALogAndTheSameForEveryConfig) {
    writeWorld(plan(usual("1")), 0, "mine.rawlog");
    const std::string study =
        "[study]\nseed = 4\n[log.mine]\nfiles = mine.rawlog\nconfig = ekf.ini\nreplicates = 3\n"
        "[config.classic]\nekf_slamot.consistency = classic\n[config.invariant]\n";
    const Plan laid = plan(study + "[grid]\nclutter.per_scan = 2 | 6\n");
    ASSERT_EQ(laid.worlds.size(), 3u);
    const std::vector<Row> rows = run(laid);
    ASSERT_EQ(rows.size(), 12u);
    EXPECT_EQ(keysOf(laid).size(), 12u);
    std::map<std::pair<int, std::string>, std::set<double>> added;  // by replicate and per_scan
    for (const Row& row : rows) {
        EXPECT_EQ(row.status, "complete") << row.reason;
        added[{row.replicate, row.config_point.at(0).second}].insert(row.metrics.at("counts.clutter_added"));
    }
    std::set<double> at_two, at_six;
    for (const auto& [which, counts] : added) {
        EXPECT_EQ(counts.size(), 1u) << "both configs of a comparison get the same clutter";
        (which.second == "2" ? at_two : at_six).insert(*counts.begin());
    }
    // Equal sums would not mean equal draws, but these differ.
    EXPECT_EQ(at_two.size(), 3u);
    EXPECT_EQ(at_six.size(), 3u);
    EXPECT_GT(*at_six.begin(), *at_two.rbegin());
    EXPECT_EQ(identities(run(laid)), identities(rows));

    // Without clutter, replicates of a log are the same run under other keys.
    const std::vector<Row> plain = run(plan(study));
    ASSERT_EQ(plain.size(), 6u);
    for (const Row& row : plain) EXPECT_EQ(row.metrics.at("counts.clutter_added"), 0);
}

TEST_F(RunnerTest, AFailingRunIsARowWithItsReason) {
    const Plan laid = plan(
        "[study]\nreplicates = 2\n[scenario.s]\nfile = field.ini\n"
        "[config.good]\nfile = ekf.ini\n"
        "[config.blind]\nfile = ekf.ini\nidentities.landmarks = hidden\n"
        "ekf_slamot.association.landmarks = known\n");
    const std::vector<Row> rows = run(laid);
    ASSERT_EQ(rows.size(), 4u);
    for (const Row& row : rows) {
        EXPECT_EQ(row.status, row.variant == "good" ? "complete" : "failed");
        if (row.variant == "good") continue;
        EXPECT_THAT(row.reason, HasSubstr("identities"));
        EXPECT_THAT(row.reason, Not(HasSubstr(folder.path())));
    }
    std::filesystem::remove(folder.path("field.ini"));  // read when the plan was made
    EXPECT_EQ(identities(run(laid)), identities(rows));
}

TEST_F(RunnerTest, ReasonsNameNeitherTheWorldNorTheLogsFolder) {
    const Plan simulated = plan(usual("1"));
    const std::string log = writeWorld(simulated, 0, "cut.rawlog");
    std::filesystem::resize_file(log, std::filesystem::file_size(log) * 2 / 3);
    const Plan laid = plan(
        "[study]\n[log.mine]\nfiles = cut.rawlog\nconfig = ekf.ini\n"
        "[config.seeing]\n[config.blind]\nidentities.landmarks = hidden\n"
        "ekf_slamot.association.landmarks = known\n");
    const std::vector<Row> rows = run(laid);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_THAT(rows[0].reason, testing::StartsWith("cut.rawlog: "));
    EXPECT_EQ(rows[1].status, "failed");
    EXPECT_THAT(rows[1].reason, testing::StartsWith("ekf_slamot had no use"));
}

TEST_F(RunnerTest, MemoryThatRunsShortEndsTheStudyWithTheRowsSoFar) {
    const PluginRegistry with_bad = [] {
        std::vector<std::string> folders = PluginRegistry::defaultFolders();
        folders.push_back(std::string(SLAMOT_BAD_PLUGINS) + "/out_of_memory");
        return PluginRegistry::discover(folders);
    }();
    const StudyFile study = load(
        "[study]\nreplicates = 2\n[scenario.s]\nfile = field.ini\n[config.good]\nfile = ekf.ini\n"
        "[config.greedy]\nfile = ekf.ini\nrun.estimator = out_of_memory\n");
    const Plan laid = layOut(study, {}, with_bad);
    for (const int threads : {1, 2}) {
        RunnerOptions options;
        options.threads = threads;
        EXPECT_THROW(runStudy(laid, unitsOf(laid, {}, {}), with_bad, options,
                              [](const Row& row) { ADD_FAILURE() << row.variant << ": " << row.status; }),
                     std::bad_alloc)
            << threads;
    }
}

TEST_F(RunnerTest, FilesInTheWayEndTheStudyInsteadOfBeingRows) {
    const Plan laid = plan(usual("1"));
    RunnerOptions options;
    options.unit.keep_folder = folder.path("kept");
    std::filesystem::create_directories(folder.path("kept/near-1"));
    folder.write("kept/near-1/invariant", "in the way");
    EXPECT_THAT(test::messageOf<LogError>([&] { run(laid, options); }), HasSubstr("kept/near-1/invariant"));
    folder.write("file", "in the way");
    options.unit.keep_folder = folder.path("file");
    EXPECT_THAT(test::messageOf<LogError>([&] { run(laid, options); }), HasSubstr("file"));
}

TEST_F(RunnerTest, ALogThatIsGoneEndsTheStudy) {
    const std::string log = writeWorld(plan(usual("1")), 0, "mine.rawlog");
    const Plan laid = plan("[study]\n[log.mine]\nfiles = mine.rawlog\nconfig = ekf.ini\n[config.a]\n");
    std::filesystem::remove(log);
    EXPECT_THAT(test::messageOf<LogError>([&] { run(laid); }), HasSubstr("mine.rawlog"));
}

TEST_F(RunnerTest, KeepsCompleteFoldersWhenAskedAndTheSameRows) {
    const Plan laid = plan(usual("1"));
    RunnerOptions options;
    options.unit.keep_folder = folder.path("kept");
    EXPECT_EQ(identities(run(laid, options)), identities(run(laid)));
    for (const char* file : {"near-1/classic/trajectory.csv", "near-1/invariant/summary.json",
                             "far-1/truth/robot.csv", "far-1/classic/estimate.rawlog"})
        EXPECT_TRUE(std::filesystem::exists(folder.path("kept/") + file)) << file;
    // The page of a kept run finds its truth there.
    const auto summary = nlohmann::json::parse(folder.read("kept/near-1/invariant/summary.json"));
    EXPECT_EQ(summary["truth"], folder.path("kept/near-1/truth"));
    EXPECT_EQ(readTruth(summary["truth"].get<std::string>()).robot.size(),
              readTruth(folder.path("kept/near-1/truth")).robot.size());
}

TEST_F(RunnerTest, ProgressCountsRuns) {
    const Plan laid = plan(usual("2"));
    std::vector<StudyProgress> told;
    RunnerOptions options;
    options.threads = 2;
    options.progress = [&](const StudyProgress& now) { told.push_back(now); };
    run(laid, options);
    ASSERT_EQ(told.size(), 4u);
    EXPECT_EQ(told.back().done, 8u);
    EXPECT_EQ(told.back().total, 8u);
    EXPECT_EQ(told.front().done, 2u);
}

}  // namespace runner_test
}  // namespace slamot::study
