// Whole runs: from a log to an output folder.
#include <gmock/gmock.h>
#include <mrpt/obs/CObservationBearingRange.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "run/Spy.h"
#include "slamot/rawlog/CsvTable.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/run/RunJob.h"
#include "support/Expect.h"

namespace slamot::test {
namespace run_job_test {

using testing::HasSubstr;
namespace fs = std::filesystem;

const PluginRegistry& registry() {
    static const PluginRegistry found = PluginRegistry::discover();
    return found;
}

class RunJobTest : public FolderTest {
  protected:
    run::JobResult runLog(const std::string& log, const std::string& config, std::string out = "out") const {
        run::RunRequest request;
        request.config = Config::fromText(config, "my.ini");
        request.log_file = path(log);
        request.out_folder = path(out);
        return run::runLog(request, registry());
    }
    std::vector<std::string> outputs(const std::string& out = "out") const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(path(out)))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }

    /// A drive along x at 1 m/s past two landmarks and beside a mover that drives along at (x + 3, 1).
    static std::vector<mrpt::obs::CObservation::Ptr> drive() {
        std::vector<mrpt::obs::CObservation::Ptr> log;
        const auto seen = [](double x, const Vector2& p, std::int64_t id) {
            return Seen{(p - Vector2(x, 0)).norm(), std::atan2(p.y(), p.x() - x), id};
        };
        for (int k = 0; k < 40; ++k) {
            const double t = 0.2 * k;
            log.push_back(odometry(t, {t, 0, 0}));
            const double u = t + 0.07;
            log.push_back(detections(u, "landmarks", {seen(u, {4, 3}, 1), seen(u, {9, -5}, 2)}));
            log.push_back(detections(u, "movers", {seen(u, {u + 3, 1}, 1)}));
        }
        log.push_back(odometry(8, {8, 0, 0}));
        return log;
    }
};

TEST_F(RunJobTest, ArrivalInAnotherOrderGivesTheSameRun) {
    auto log = drive();
    writeLog(path("a.rawlog"), log);
    const auto in_order = runLog("a.rawlog", "");
    EXPECT_EQ(in_order.status, run::RunStatus::complete);
    EXPECT_EQ(in_order.summary["counts"]["detections"], 120);
    EXPECT_GT(in_order.summary["time"]["update_cpu_s"], 0.0);

    // Every entry arrives up to half a second late, in an order made from a fixed seed.
    std::mt19937 engine(5);
    for (int round = 0; round < 5; ++round) {
        std::vector<std::pair<double, mrpt::obs::CObservation::Ptr>> late;
        for (const auto& o : log)
            late.emplace_back(
                toStamp(o->timestamp).seconds() + 0.5 * static_cast<double>(engine()) / 4294967296.0, o);
        std::sort(late.begin(), late.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        std::vector<mrpt::obs::CObservation::Ptr> shuffled;
        for (const auto& [arrival, o] : late) shuffled.push_back(o);
        ASSERT_NE(shuffled, log);
        writeLog(path("b.rawlog"), shuffled);
        EXPECT_EQ(runLog("b.rawlog", "").estimate_hash, in_order.estimate_hash);
    }
    writeLog(path("c.rawlog"), {log.begin(), log.end() - 4});
    EXPECT_NE(runLog("c.rawlog", "").estimate_hash, in_order.estimate_hash);
}

TEST_F(RunJobTest, TheSummaryListsTheSensorsThatDetectionsCameFrom) {
    writeLog(path("a.rawlog"), drive());
    const auto sensors = runLog("a.rawlog", "").summary["sensors"];
    ASSERT_EQ(sensors.size(), 2u);
    EXPECT_EQ(sensors[0]["label"], "landmarks");
    EXPECT_EQ(sensors[0]["kind"], "landmark");
    EXPECT_EQ(sensors[1]["label"], "movers");
    for (const char* number : {"x", "y", "theta", "min_range", "max_range", "field_of_view"})
        EXPECT_TRUE(sensors[0][number].is_number()) << number;
}

/// A window that a person pauses.
class PatientSink : public run::Sink {
  public:
    void step(const run::Step&) override {}
    double heldBack() const override { return 1000; }
};

TEST_F(RunJobTest, WaitingForWhoWatchesIsNoPartOfTheWallTime) {
    writeLog(path("a.rawlog"), drive());
    const double alone = runLog("a.rawlog", "").summary["time"]["wall_s"];
    EXPECT_GT(alone, 0);
    PatientSink window;
    run::RunRequest request;
    request.log_file = path("a.rawlog");
    request.out_folder = path("out");
    request.sinks = {&window};
    // It did not really wait: what is left is below 0, since no such run takes 1000 s.
    EXPECT_LT(run::runLog(request, registry()).summary["time"]["wall_s"].get<double>(), 0);
}

TEST_F(RunJobTest, ASensorWithoutALimitIsNullInTheSummary) {
    const auto log = drive();
    for (const auto& o : log)
        if (auto* seen = dynamic_cast<mrpt::obs::CObservationBearingRange*>(o.get()))
            seen->maxSensorDistance = std::numeric_limits<float>::infinity();
    writeLog(path("a.rawlog"), log);
    const auto sensors = runLog("a.rawlog", "").summary["sensors"];
    ASSERT_EQ(sensors.size(), 2u);
    EXPECT_TRUE(sensors[0]["max_range"].is_null()) << sensors;
    EXPECT_TRUE(sensors[0]["min_range"].is_number());
}

TEST_F(RunJobTest, WritesTheFilesOfTheDocumentationAndOnlyThose) {
    writeLog(path("a.rawlog"), drive());
    runLog("a.rawlog", "");
    EXPECT_THAT(outputs(),
                testing::ElementsAre("correlation.bin", "estimate.rawlog", "estimate.rawlog.sha256",
                                     "innovations.csv", "landmarks.csv", "landmarks_history.csv",
                                     "map.landmarks.gz", "scene.3Dscene", "steps.csv", "summary.json",
                                     "tracks.csv", "trajectory.csv", "trajectory.tum"));
    // Again into the same folder, with less: what the second run does not write must not stay.
    runLog("a.rawlog",
           "[output]\ncorrelation = false\nrawlog = false\ninnovations = false\nlandmarks_history = false\n"
           "map = false\nscene = false\nsteps = false\n");
    EXPECT_THAT(outputs(), testing::ElementsAre("landmarks.csv", "summary.json", "tracks.csv",
                                                "trajectory.csv", "trajectory.tum"));
}

TEST_F(RunJobTest, ParticlesAreWrittenOnRequestAndChangeNothing) {
    writeLog(path("a.rawlog"), drive());
    const std::string config = "[run]\nestimator = fastslam\n[fastslam]\nparticles = 20\n"
                               "[identities]\nlandmarks = hidden\n[output]\nmap = false\n";
    const auto plain = runLog("a.rawlog", config);
    const auto without = outputs();
    const std::string more = "particles = true\nmost_particles = 10\ntentative = true\n";
    const auto asked = runLog("a.rawlog", config + more);
    EXPECT_EQ(asked.estimate_hash, plain.estimate_hash);
    EXPECT_THAT(outputs(), testing::IsSupersetOf({"particles.csv", "tentative.csv"}));
    EXPECT_EQ(outputs().size(), without.size() + 2);
    std::map<std::int64_t, double> sums;  // of weights, by stamp
    CsvReader particles(path("out/particles.csv"));
    while (particles.next()) sums[particles.stamp(0).ticks] += particles.number(particles.column("weight"));
    EXPECT_EQ(sums.size(), asked.record.trajectory.size());
    for (const auto& [ticks, sum] : sums) EXPECT_NEAR(sum, 1, 1e-12);

    // Two landmarks, which became certain later.
    std::set<std::int64_t> candidates;
    CsvReader tentative(path("out/tentative.csv"));
    while (tentative.next()) {
        candidates.insert(tentative.integer(tentative.column("id")));
        EXPECT_LT(tentative.number(tentative.column("existence")), 1);
    }
    for (const auto& landmark : asked.record.landmarks) EXPECT_EQ(candidates.count(landmark.id.value), 1u);
    EXPECT_EQ(asked.record.landmarks.size(), 2u);
    runLog("a.rawlog", config);
    EXPECT_EQ(outputs(), without);
}

TEST_F(RunJobTest, TheFolderReadsBackAsTheResultsRecord) {
    writeLog(path("a.rawlog"), drive());
    const auto result = runLog("a.rawlog", "[output]\ninterval = 0.15\n");
    const eval::RunRecord read = eval::readRun(path("out"));
    ASSERT_EQ(read.trajectory.size(), result.record.trajectory.size());
    for (std::size_t i = 0; i < read.trajectory.size(); ++i) {
        EXPECT_EQ(read.trajectory[i].stamp, result.record.trajectory[i].stamp);
        EXPECT_EQ(read.trajectory[i].robot.mean.vector(), result.record.trajectory[i].robot.mean.vector());
        EXPECT_EQ(read.trajectory[i].robot.covariance, result.record.trajectory[i].robot.covariance);
    }
    EXPECT_EQ(read.tracks.size(), result.record.tracks.size());
    EXPECT_EQ(read.landmarks.size(), 2u);
    EXPECT_EQ(read.innovations.size(), 120u);
}

TEST_F(RunJobTest, AssociationsAreFoundByTheLogsNumbersThroughClutter) {
    writeLog(path("a.rawlog"), drive());
    Truth truth;
    for (int k = 0; k < 40; ++k) {
        truth.robot.push_back({at(0.2 * k), {0.2 * k, 0, 0}});
        const Stamp stamp = at(0.2 * k + 0.07);
        truth.associations.push_back({stamp, 0, "landmark", SourceId{1}});
        truth.associations.push_back({stamp, 1, "landmark", SourceId{2}});
        truth.associations.push_back({stamp, 2, "mover", SourceId{1}});
    }
    run::RunRequest request;
    request.config = Config::fromText(
        "[clutter]\nper_scan = 1.5\ndetection_probability = 0.7\n"
        "[ekf_slamot.association]\nlandmarks = known\nmovers = known\n",
        "my.ini");
    request.log_file = path("a.rawlog");
    request.out_folder = path("out");
    request.truth = &truth;
    request.truth_folder = "a.truth";
    const auto result = run::runLog(request, registry());
    const auto& counts = result.summary["counts"];
    const auto added = counts["clutter_added"].get<int>(),
               withheld = counts["detections_withheld"].get<int>();
    EXPECT_GT(added, 60);     // of 120 on average: 80 observations
    EXPECT_GT(withheld, 15);  // of 36 on average
    EXPECT_EQ(counts["detections"], 120 - withheld + added);
    EXPECT_EQ(counts["detections_ignored"], added) << "they have no identity";
    EXPECT_EQ(counts["detections_tentative"], 0);

    const auto read = eval::evaluate(eval::readRun(path("out")), truth, {});
    for (const eval::Metrics& metrics : {*result.metrics, read}) {
        ASSERT_TRUE(metrics.association);
        EXPECT_EQ(metrics.association->used, counts["detections"]);
        EXPECT_EQ(metrics.association->without_truth, 0);
        EXPECT_EQ(metrics.association->unnumbered, 0);
        EXPECT_EQ(metrics.association->all.detections, 120 - withheld);
        // A log without noise: nothing lies outside of a gate, so identities find all of it.
        EXPECT_EQ(metrics.association->all.recall, 1);
        EXPECT_EQ(metrics.association->all.precision, 1);
    }
    // Other draws, other numbers of detections.
    request.config.set("run", "seed", "2");
    request.out_folder = path("out2");
    EXPECT_NE(run::runLog(request, registry()).estimate_hash, result.estimate_hash);
}

TEST_F(RunJobTest, ALogInTheOutputFolderIsNotDestroyed) {
    writeLog(path("a.rawlog"), drive());
    runLog("a.rawlog", "");
    const std::string before = textOf(path("out/estimate.rawlog"));
    EXPECT_THAT(messageOf<LogError>([&] { runLog("out/estimate.rawlog", ""); }),
                HasSubstr("out/estimate.rawlog"));
    EXPECT_EQ(textOf(path("out/estimate.rawlog")), before);
}

TEST_F(RunJobTest, AnEstimateLogRunsAgainToTheSameEstimates) {
    writeLog(path("a.rawlog"), drive());
    const auto first = runLog("a.rawlog", "");
    const auto again = runLog("out/estimate.rawlog", "", "out2");
    EXPECT_EQ(again.estimate_hash, first.estimate_hash);
    for (const auto& drop : again.summary["drops"])
        EXPECT_EQ(drop["reason"], "unused-class-mrpt::obs::CObservationRobotPose");
}

TEST_F(RunJobTest, ALabelThatIsNoTextDoesNotLoseTheRun) {
    auto log = drive();
    log.insert(log.begin() + 3, detections(0.1, "caf\xe9", {{3, 0, 1}}));
    writeLog(path("a.rawlog"), log);
    runLog("a.rawlog", "");
    EXPECT_TRUE(fs::exists(path("out/summary.json")));
}

TEST_F(RunJobTest, LogsWithNothingToUseAreErrorsThatSayWhatWasFound) {
    writeLog(path("none.rawlog"), {detections(1, "landmarks", {{3, 0}}), scan(2, "laser")});
    auto error = messageOf<LogError>([&] { runLog("none.rawlog", ""); });
    EXPECT_THAT(error, HasSubstr("none.rawlog"));
    EXPECT_THAT(error, HasSubstr("no odometry"));
    EXPECT_THAT(error, HasSubstr("1 of 'landmarks' (before-odometry)"));

    writeLog(path("odo.rawlog"), {odometry(1, {}), odometry(2, {}), detections(1.5, "camera", {{3, 0}})});
    error = messageOf<LogError>([&] { runLog("odo.rawlog", ""); });
    EXPECT_THAT(error, HasSubstr("no detection that ekf_slamot can use"));
    EXPECT_THAT(error, HasSubstr("1 of 'camera' (no-role-in-[sensors])"));
    EXPECT_EQ(runLog("odo.rawlog", "[run]\nestimator = dead_reckoning\n").status, run::RunStatus::complete);

    error = messageOf<LogError>([&] { runLog("odo.rawlog", "[run]\nodometry = wheels\n"); });
    EXPECT_THAT(error, HasSubstr("2 of 'odometry' (other-odometry)"));
}

TEST_F(RunJobTest, ARunThatIgnoredEveryDetectionIsAnErrorWithoutFinishedOutputs) {
    writeLog(path("a.rawlog"), drive());
    const std::string hidden =
        "[identities]\nlandmarks = hidden\nmovers = hidden\n"
        "[ekf_slamot.association]\nlandmarks = known\nmovers = known\n";
    const auto error = messageOf<LogError>([&] { runLog("a.rawlog", hidden); });
    EXPECT_THAT(error, HasSubstr("any of the 120 detections"));  // 40 x (2 landmarks + 1 mover)
    EXPECT_THAT(error, HasSubstr("identities"));
    for (const std::string& name : outputs()) EXPECT_THAT(name, testing::EndsWith(".part"));

    EXPECT_EQ(runLog("a.rawlog", hidden + "[run]\nestimator = dead_reckoning\n").status,
              run::RunStatus::complete);
    EXPECT_EQ(runLog("a.rawlog", "[identities]\nmovers = hidden\n").status, run::RunStatus::complete);
}

TEST_F(RunJobTest, LabelsThatTheLogDoesNotHaveAreWarnedOf) {
    auto log = drive();
    log.push_back(detections(1, "late", {{3, 0, 1}}));  // 7 s late: met, though it never reaches the pipeline
    writeLog(path("a.rawlog"), log);
    const auto result = runLog("a.rawlog",
                               "[sensors]\nmovers = movers\nlandmark = landmarks\nlate = ignore\n"
                               "[noise.mover]\nrange_std = 0.1\n[noise.landmarks]\nrange_std = 0.1\n");
    ASSERT_EQ(result.warnings.size(), 2u);
    EXPECT_EQ(result.warnings[0],
              "[sensors] names sensor 'landmark', which the log does not have (did you mean 'landmarks'?)");
    EXPECT_EQ(result.warnings[1],
              "[noise.mover] names sensor 'mover', which the log does not have (did you mean 'movers'?)");
    EXPECT_EQ(result.summary["warnings"], nlohmann::json(result.warnings));
    EXPECT_TRUE(runLog("a.rawlog", "").warnings.empty());
}

TEST_F(RunJobTest, EveryPluginsFullConfigRuns) {
    writeLog(path("a.rawlog"), drive());
    for (const PluginInfo& plugin : registry().plugins()) {
        if (plugin.kind != "estimator") continue;
        EXPECT_EQ(runLog("a.rawlog", run::fullConfigText(plugin.name, registry())).status,
                  run::RunStatus::complete);
    }
}

TEST_F(RunJobTest, AStopKeepsWhatWasDone) {
    writeLog(path("a.rawlog"), drive());
    std::atomic<bool> stop{false};
    int calls = 0;
    run::RunRequest request;
    request.log_file = path("a.rawlog");
    request.out_folder = path("out");
    request.stop = &stop;
    request.progress = [&](double) { stop = ++calls > 0; };  // told every few entries
    const auto result = run::runLog(request, registry());
    EXPECT_EQ(result.status, run::RunStatus::stopped);
    EXPECT_EQ(result.summary["status"], "stopped");
    EXPECT_LT(result.summary["counts"]["detections"], 120);
    EXPECT_GT(eval::readRun(path("out")).trajectory.size(), 5u);
    for (const std::string& name : outputs()) EXPECT_EQ(name.find(".part"), std::string::npos) << name;
}

TEST_F(RunJobTest, AStopBeforeTheFirstOdometryIsAStopToo) {
    writeLog(path("a.rawlog"), {detections(1, "landmarks", {{3, 0, 1}}), odometry(2, {}), odometry(3, {})});
    const std::atomic<bool> stop{true};
    run::RunRequest request;
    request.log_file = path("a.rawlog");
    request.out_folder = path("out");
    request.stop = &stop;
    const auto result = run::runLog(request, registry());
    EXPECT_EQ(result.status, run::RunStatus::stopped);
    EXPECT_EQ(result.summary["counts"]["odometry"], 0);
    EXPECT_TRUE(eval::readRun(path("out")).trajectory.empty());
    EXPECT_FALSE(result.writes_figure);
    for (const std::string& name : outputs()) EXPECT_EQ(name.find(".part"), std::string::npos) << name;
}

TEST_F(RunJobTest, AnEstimatorThatFailsLeavesWhatCameBeforeWithStatusFailed) {
    auto log = drive();
    log.push_back(odometry(8.2, {1e200, 0, 0}));  // its variance, about (1e200)^2, is no double any more
    log.push_back(odometry(8.4, {1e200, 0, 0}));
    writeLog(path("a.rawlog"), log);
    const auto result = runLog("a.rawlog", "");
    ASSERT_TRUE(result.failure);
    const auto error = messageOf<EstimatorError>([&] { std::rethrow_exception(result.failure); });
    EXPECT_THAT(error, HasSubstr("ekf_slamot"));
    EXPECT_TRUE(result.writes_report);
    const auto summary = nlohmann::json::parse(textOf(path("out/summary.json")));
    EXPECT_EQ(summary["status"], "failed");
    EXPECT_EQ(summary["end_message"], error);
    EXPECT_EQ(summary["counts"]["detections"], 120);
    EXPECT_EQ(summary["counts"]["landmarks"], 2);
    for (const std::string& name : outputs()) EXPECT_EQ(name.find(".part"), std::string::npos) << name;
    // The last good step is that of the last odometry before the jump.
    EXPECT_EQ(eval::readRun(path("out")).trajectory.back().stamp, at(8));
}

using Table = std::vector<std::vector<double>>;

/// Paper 1's golden run (tests/data/golden/paper1): the same inputs as
/// tests/core/estimation/GoldenRunTest.cpp, but written into a rawlog and taken all the way through reader,
/// pipeline, plugin and files.
class GoldenImmRawlogTest : public RunJobTest {
  protected:
    static constexpr double dt = 0.15, wheelbase = 4;

    static Table golden(const std::string& name) {
        CsvReader csv(std::string(SLAMOT_SOURCE_DIR) + "/tests/data/golden/paper1/" + name);
        Table rows;
        while (csv.next()) {
            rows.emplace_back();
            for (std::size_t i = 0; i < csv.header().size(); ++i)
                rows.back().push_back(csv.number(static_cast<int>(i)));
        }
        return rows;
    }

    void writeGoldenLog() const {
        const Table truth = golden("truth.csv"), observations = golden("observations.csv");
        std::map<int, std::vector<Seen>> landmarks, targets;
        for (const auto& row : observations) {
            const bool target = row[1] < 0;
            (target ? targets : landmarks)[static_cast<int>(row[0])].push_back(
                {row[2], row[3], target ? 0 : static_cast<std::int64_t>(row[1])});
        }
        std::vector<mrpt::obs::CObservation::Ptr> log;
        for (int k = 0; k <= 200; ++k) {
            const double v = truth[k][10], gamma = truth[k][11];
            log.push_back(odometry(
                k * dt, {}, "odometry",
                BodyVelocity{v * std::cos(gamma), v * std::sin(gamma), v * std::sin(gamma) / wheelbase}));
            log.push_back(detections(k * dt, "landmarks", landmarks[k], 0.1, 0.05));
            if (!targets[k].empty()) log.push_back(detections(k * dt, "movers", targets[k], 0.1, 0.05));
        }
        writeLog(path("golden.rawlog"), log);
    }
};

class GoldenRawlogTest : public GoldenImmRawlogTest, public testing::WithParamInterface<const char*> {};

/// Ranges and bearings are floats in a log: the golden run's makers state 1e-4.
void expectNear(double value, double expected, const std::string& what) {
    EXPECT_NEAR(value, expected, 1e-4 * std::max(1.0, std::abs(expected))) << what;
}

TEST_P(GoldenRawlogTest, AgreesWithTheTrace) {
    writeGoldenLog();
    run::RunRequest request;
    request.config = Config::fromFile(std::string(SLAMOT_SOURCE_DIR) + "/config/runs/paper1_ekf.ini");
    request.config.set("ekf_slamot", "consistency", GetParam());
    // The log's claims are floats too: 0.1f is 1.5e-9 off, 0.05f 7.5e-10.
    request.log_file = path("golden.rawlog");
    request.out_folder = path("out");
    run::runLog(request, registry());

    const eval::RunRecord run = eval::readRun(path("out"));
    const Table expected = golden(std::string("expect_ekf_true_mode_") + GetParam() + ".csv");
    ASSERT_EQ(run.trajectory.size(), 201u);
    CsvReader steps(path("out/steps.csv"));
    const int landmark_count = steps.column("landmarks");
    for (std::size_t k = 0; k <= 200; ++k) {
        const auto& row = expected[k];
        const std::string where = "step " + std::to_string(k);
        const auto& [robot, covariance] = run.trajectory[k].robot;
        EXPECT_EQ(run.trajectory[k].stamp, at(static_cast<double>(k) * dt));
        for (int i = 0; i < 3; ++i) expectNear(robot.vector()(i), row[1 + i], where);
        for (int i = 0; i < 3; ++i) expectNear(covariance(i, i), row[10 + i], where);
        const TrackEstimate& target = run.tracks.at(run.trajectory[k].stamp).at(0);
        for (int i = 0; i < 6; ++i) expectNear(target.mean(i), row[4 + i], where);
        for (int i = 0; i < 6; ++i) expectNear(target.covariance(i, i), row[13 + i], where);
        ASSERT_TRUE(steps.next());
        EXPECT_EQ(9 + 2 * steps.integer(landmark_count), static_cast<std::int64_t>(row[21])) << where;
        if (HasFailure()) break;
    }

    std::map<std::int64_t, std::vector<double>> map;
    for (const auto& row : golden(std::string("expect_ekf_true_mode_") + GetParam() + "_map.csv"))
        map[static_cast<std::int64_t>(row[0])] = row;
    ASSERT_EQ(run.landmarks.size(), map.size());
    for (const LandmarkEstimate& l : run.landmarks) {
        const auto& row = map.at(l.source.value);
        const std::string where = "landmark " + std::to_string(l.source.value);
        expectNear(l.mean.x(), row[2], where);
        expectNear(l.mean.y(), row[3], where);
        expectNear(l.covariance(0, 0), row[4], where);
        expectNear(l.covariance(1, 1), row[5], where);
        expectNear(l.covariance(0, 1), row[6], where);
    }
}

TEST_F(GoldenImmRawlogTest, AgreesWithTheTrace) {
    writeGoldenLog();
    run::RunRequest request;
    request.config = Config::fromFile(std::string(SLAMOT_SOURCE_DIR) + "/config/runs/paper1_imm.ini");
    request.config.set("imm_slamot", "consistency", "classic");
    request.config.set("imm_slamot", "likelihood", "marginal");
    request.log_file = path("golden.rawlog");
    request.out_folder = path("out");
    run::runLog(request, registry());

    const eval::RunRecord run = eval::readRun(path("out"));
    EXPECT_EQ(run.mode_names, (std::vector<std::string>{"cv", "ca"}));
    const Table expected = golden("expect_imm_classic_marginal_likelihood.csv");
    ASSERT_EQ(run.trajectory.size(), 201u);
    for (std::size_t k = 0; k <= 200; ++k) {
        const auto& row = expected[k];
        const std::string where = "step " + std::to_string(k);
        const auto& [robot, covariance] = run.trajectory[k].robot;
        for (int i = 0; i < 3; ++i) expectNear(robot.vector()(i), row[1 + i], where);
        for (int i = 0; i < 3; ++i) expectNear(covariance(i, i), row[10 + i], where);
        const TrackEstimate& target = run.tracks.at(run.trajectory[k].stamp).at(0);
        for (int i = 0; i < 6; ++i) expectNear(target.mean(i), row[4 + i], where);
        for (int i = 0; i < 6; ++i) expectNear(target.covariance(i, i), row[13 + i], where);
        ASSERT_EQ(target.mode_probabilities.size(), 2u);
        expectNear(target.mode_probabilities[0], row[22], where);
        if (HasFailure()) break;
    }
}

INSTANTIATE_TEST_SUITE_P(Paper1, GoldenRawlogTest, testing::Values("classic", "invariant"));

}  // namespace run_job_test
}  // namespace slamot::test
