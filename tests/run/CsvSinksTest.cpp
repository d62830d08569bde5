// The CSV files: their columns, which steps get a row, and that they read back as they were.
#include <gmock/gmock.h>

#include <cmath>

#include "run/Spy.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/run/CsvSinks.h"
#include "slamot/run/RecordSinks.h"
#include "support/Expect.h"

namespace slamot::test {
namespace csv_sinks_test {

using run::Step;
using testing::HasSubstr;
namespace fs = std::filesystem;

class CsvSinksTest : public FolderTest {};

Step emptyStep(double t, bool has_detections = false) {
    Step step;
    step.estimate.stamp = at(t);
    step.has_detections = has_detections;
    return step;
}

/// Numbers with no short decimal form, so that a digit lost in writing shows.
double odd(int i) {
    return std::sin(1.0 + i) / 3.0;
}

Step fullStep(double t, int salt) {
    Step step = emptyStep(t, true);
    step.estimate.robot.mean = {odd(salt), -1e-9 * odd(salt + 1), 3 * odd(salt + 2)};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) step.estimate.robot.covariance(i, j) = odd(salt + i + j);
    TrackEstimate track;
    track.id = {salt};
    track.source = {salt % 2 ? 5 : -1};
    for (int i = 0; i < 6; ++i) track.mean(i) = 1e6 * odd(salt + i);
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) track.covariance(i, j) = odd(salt + i * j);
    track.existence = 0.1 + 0.2;
    track.moving = 0.1 + 0.7;
    track.mode_probabilities = {1.0 / 3.0, 2.0 / 3.0};
    step.estimate.tracks = {track};

    RangeBearingSet set;
    set.sensors.resize(2);
    set.sensors[0].label = "landmarks";
    set.sensors[1].label = "movers";
    set.detections.resize(3);
    set.detections[1].sensor = 1;
    step.detections = {at(t), set};
    Innovation used;
    used.detection = 0;
    used.kind = ObjectKind::landmark;
    used.landmark = {3};
    used.outcome = Outcome::updated;
    used.residual = {odd(1), odd(2)};
    used.covariance << odd(3), odd(4), odd(4), odd(5);
    used.nis = odd(6);
    Innovation born;
    born.detection = 1;
    born.kind = ObjectKind::mover;
    born.track = {salt};
    born.outcome = Outcome::initiated;
    Innovation kept;
    kept.detection = 2;
    kept.outcome = Outcome::tentative;
    step.report.innovations = {used, born, kept};
    step.log_numbers = {4, 0, -1};
    step.log_count = 6;
    LandmarkEstimate touched;
    touched.id = {3};
    touched.existence = 0.75;
    touched.moving = 0.25;
    step.touched = {touched};
    return step;
}

run::RunEnd fullEnd() {
    run::RunEnd end;
    LandmarkEstimate landmark;
    landmark.id = {3};
    landmark.source = {42};
    landmark.mean = {odd(1), odd(2)};
    landmark.covariance << odd(3), odd(4), odd(4), odd(5);
    landmark.existence = 0.1 + 0.2;
    landmark.moving = 0.1 + 0.7;
    landmark.seen = 12;
    landmark.first_seen = at(0.1);
    landmark.last_seen = at(1.7);
    end.landmarks = {landmark};
    return end;
}

/// Below its head.
std::string rowsOf(const std::string& text) {
    return text.substr(text.find('\n') + 1);
}

TEST_F(CsvSinksTest, ColumnsAreThoseOfTheDocumentation) {
    run::TrajectorySink trajectory(folder, 0);
    run::TracksSink tracks(folder, 0, {"cv", "ct"});
    run::LandmarksSink landmarks(folder);
    run::LandmarksHistorySink history(folder);
    run::InnovationsSink innovations(folder);
    run::StepsSink steps(folder);
    run::TentativeSink tentative(folder, 0);
    run::ParticlesSink particles(folder, 0, 10);
    for (run::Sink* sink : std::initializer_list<run::Sink*>{&trajectory, &tracks, &landmarks, &history,
                                                             &innovations, &steps, &tentative, &particles})
        sink->end({});
    EXPECT_EQ(firstLineOf(path("trajectory.csv")), "t,x,y,theta,c_xx,c_xy,c_xt,c_yy,c_yt,c_tt");
    EXPECT_EQ(firstLineOf(path("tracks.csv")),
              "t,track,x,y,vx,vy,ax,ay,c_0_0,c_0_1,c_0_2,c_0_3,c_0_4,c_0_5,c_1_1,c_1_2,c_1_3,c_1_4,c_1_5,c_2_"
              "2,c_2_3,"
              "c_2_4,c_2_5,c_3_3,c_3_4,c_3_5,c_4_4,c_4_5,c_5_5,existence,p_cv,p_ct,moving,source_id");
    EXPECT_EQ(firstLineOf(path("landmarks.csv")),
              "id,x,y,c_xx,c_xy,c_yy,seen,first_t,last_t,existence,moving,source_id");
    EXPECT_EQ(firstLineOf(path("landmarks_history.csv")),
              "t,id,x,y,c_xx,c_xy,c_yy,existence,moving,source_id");
    EXPECT_EQ(
        firstLineOf(path("innovations.csv")),
        "t,sensor,kind,landmark,track,outcome,r_range,r_bearing,s_rr,s_rb,s_bb,nis,detection,log_number,log_"
        "count");
    EXPECT_EQ(firstLineOf(path("steps.csv")), "t,landmarks,tracks,ms_predict,ms_detect,ms_update");
    EXPECT_EQ(firstLineOf(path("tentative.csv")), firstLineOf(path("landmarks_history.csv")));
    EXPECT_EQ(firstLineOf(path("particles.csv")), "t,particle,weight,x,y,theta");
}

TEST_F(CsvSinksTest, ARowReadsAsWritten) {
    run::TrajectorySink sink(folder, 0);
    Step step = emptyStep(1.25);
    step.estimate.robot.mean = {1.5, -2, pi / 2};
    step.estimate.robot.covariance << 1, 2, 3, 2, 4, 5, 3, 5, 6;
    sink.step(step);
    sink.end({});
    // 1577836800 is 2020-01-01, the epoch of these tests.
    EXPECT_EQ(textOf(path("trajectory.csv")).substr(firstLineOf(path("trajectory.csv")).size() + 1),
              "1577836801.2500000,1.5,-2,1.5707963267948966,1,2,3,4,5,6\n");
    // A quarter turn: qz = qw = sin 45 deg, the last digit being that of libm's sine and cosine.
    EXPECT_EQ(firstLineOf(path("trajectory.tum")),
              "1577836801.2500000 1.5 -2 0 0 0 0.7071067811865475 0.7071067811865476");
}

TEST_F(CsvSinksTest, TheHistoryTellsExistenceAndMovement) {
    run::LandmarksHistorySink sink(folder);
    sink.step(fullStep(1.25, 1));
    sink.end({});
    EXPECT_EQ(rowsOf(textOf(path("landmarks_history.csv"))), "1577836801.2500000,3,0,0,0,0,0,0.75,0.25,-1\n");
}

TEST_F(CsvSinksTest, ParticlesAreWrittenAtTheRowsOfTheTrajectoryAndThinnedByWeight) {
    Spy spy;
    const Matrix3 none = Matrix3::Zero();
    spy.cloud = {{0.5, {{1, 2, 3}, none}},
                 {0.25, {{1.5, 2, -3}, none}},
                 {0.125, {{4, 0, 0}, none}},
                 {0.125, {{5, 0, 0}, none}}};
    const auto take = [&](run::Sink& sink, Step step) {
        step.estimator = &spy;
        sink.step(step);
    };
    run::ParticlesSink all(folder, 1, 4);
    take(all, emptyStep(0.25));
    take(all, emptyStep(0.5));  // no row of the trajectory
    all.end({});
    EXPECT_EQ(rowsOf(textOf(path("particles.csv"))),
              "1577836800.2500000,0,0.5,1,2,3\n1577836800.2500000,1,0.25,1.5,2,-3\n"
              "1577836800.2500000,2,0.125,4,0,0\n1577836800.2500000,3,0.125,5,0,0\n");
    run::ParticlesSink two(folder, 1, 2);
    take(two, emptyStep(0.25));
    two.end({});
    EXPECT_EQ(rowsOf(textOf(path("particles.csv"))),
              "1577836800.2500000,0,0.5,1,2,3\n1577836800.2500000,1,0.5,1.5,2,-3\n");
}

TEST_F(CsvSinksTest, TentativeLandmarksAreAllWrittenAtEveryRow) {
    Spy spy;
    run::TentativeSink sink(folder, 0);
    for (const double t : {0.25, 0.5, 0.75}) {
        LandmarkEstimate candidate;
        candidate.id = {7};
        candidate.mean = {1, t};
        candidate.existence = t;
        spy.candidates.push_back(candidate);
        if (t == 0.75) spy.candidates.clear();
        Step step = emptyStep(t);
        step.estimator = &spy;
        sink.step(step);
    }
    sink.end({});
    EXPECT_EQ(rowsOf(textOf(path("tentative.csv"))),
              "1577836800.2500000,7,1,0.25,0,0,0,0.25,0,-1\n1577836800.5000000,7,1,0.25,0,0,0,0.25,0,-1\n"
              "1577836800.5000000,7,1,0.5,0,0,0,0.5,0,-1\n");
}

void expectEqual(const eval::RunRecord& read, const eval::RunRecord& kept) {
    ASSERT_EQ(read.trajectory.size(), kept.trajectory.size());
    for (std::size_t i = 0; i < kept.trajectory.size(); ++i) {
        EXPECT_EQ(read.trajectory[i].stamp, kept.trajectory[i].stamp);
        EXPECT_EQ(read.trajectory[i].robot.mean.vector(), kept.trajectory[i].robot.mean.vector());
        EXPECT_EQ(read.trajectory[i].robot.covariance, kept.trajectory[i].robot.covariance);
    }
    ASSERT_EQ(read.tracks.size(), kept.tracks.size());
    for (const auto& [stamp, tracks] : kept.tracks) {
        const auto& others = read.tracks.at(stamp);
        ASSERT_EQ(others.size(), tracks.size());
        for (std::size_t i = 0; i < tracks.size(); ++i) {
            EXPECT_EQ(others[i].id, tracks[i].id);
            EXPECT_EQ(others[i].source, tracks[i].source);
            EXPECT_EQ(others[i].mean, tracks[i].mean);
            EXPECT_EQ(others[i].covariance, tracks[i].covariance);
            EXPECT_EQ(others[i].existence, tracks[i].existence);
            EXPECT_EQ(others[i].moving, tracks[i].moving);
            EXPECT_EQ(others[i].mode_probabilities, tracks[i].mode_probabilities);
        }
    }
    ASSERT_EQ(read.landmarks.size(), kept.landmarks.size());
    for (std::size_t i = 0; i < kept.landmarks.size(); ++i) {
        EXPECT_EQ(read.landmarks[i].id, kept.landmarks[i].id);
        EXPECT_EQ(read.landmarks[i].source, kept.landmarks[i].source);
        EXPECT_EQ(read.landmarks[i].mean, kept.landmarks[i].mean);
        EXPECT_EQ(read.landmarks[i].covariance, kept.landmarks[i].covariance);
        EXPECT_EQ(read.landmarks[i].existence, kept.landmarks[i].existence);
        EXPECT_EQ(read.landmarks[i].moving, kept.landmarks[i].moving);
        EXPECT_EQ(read.landmarks[i].seen, kept.landmarks[i].seen);
        EXPECT_EQ(read.landmarks[i].first_seen, kept.landmarks[i].first_seen);
        EXPECT_EQ(read.landmarks[i].last_seen, kept.landmarks[i].last_seen);
    }
    const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    ASSERT_EQ(read.innovations.size(), kept.innovations.size());
    for (std::size_t i = 0; i < kept.innovations.size(); ++i) {
        EXPECT_EQ(read.innovations[i].stamp, kept.innovations[i].stamp);
        EXPECT_EQ(read.innovations[i].sensor, kept.innovations[i].sensor);
        const Innovation &a = read.innovations[i].innovation, &b = kept.innovations[i].innovation;
        ASSERT_TRUE(read.innovations[i].log && kept.innovations[i].log);
        EXPECT_EQ(read.innovations[i].log->number, kept.innovations[i].log->number);
        EXPECT_EQ(read.innovations[i].log->count, kept.innovations[i].log->count);
        EXPECT_EQ(a.detection, b.detection);
        EXPECT_EQ(a.kind, b.kind);
        EXPECT_EQ(a.landmark, b.landmark);
        EXPECT_EQ(a.track, b.track);
        EXPECT_EQ(a.outcome, b.outcome);
        EXPECT_TRUE(same(a.nis, b.nis)) << a.nis << " " << b.nis;
        for (int r = 0; r < 2; ++r) {
            EXPECT_TRUE(same(a.residual(r), b.residual(r)));
            for (int c = 0; c < 2; ++c) EXPECT_TRUE(same(a.covariance(r, c), b.covariance(r, c)));
        }
    }
    EXPECT_EQ(read.mode_names, kept.mode_names);
}

TEST_F(CsvSinksTest, AnOutputFolderReadsBackAsTheRecordBitForBit) {
    const double interval = 0.3;
    run::TrajectorySink trajectory(folder, interval);
    run::TracksSink tracks(folder, interval, {"cv", "ct"});
    run::LandmarksSink landmarks(folder);
    run::InnovationsSink innovations(folder);
    run::RunRecorder recorder(interval, {"cv", "ct"});
    const std::vector<run::Sink*> sinks{&trajectory, &tracks, &landmarks, &innovations, &recorder};
    for (int i = 0; i < 40; ++i)
        for (run::Sink* sink : sinks) sink->step(i % 3 ? emptyStep(0.1 * i) : fullStep(0.1 * i, i));
    for (run::Sink* sink : sinks) sink->end(fullEnd());
    ASSERT_EQ(recorder.record().innovations.size(), 42u);  // three for each i of 0, 3, ..., 39
    expectEqual(eval::readRun(folder), recorder.record());
}

TEST_F(CsvSinksTest, ASensorsNameCannotBreakTheTable) {
    run::InnovationsSink sink(folder);
    run::TrajectorySink trajectory(folder, 0);
    Step step = fullStep(1, 1);
    std::get<RangeBearingSet>(step.detections.measurements).sensors[0].label = "front, left\nand \"right\"";
    sink.step(step);
    sink.end({});
    trajectory.end({});
    const eval::RunRecord read = eval::readRun(folder);
    ASSERT_EQ(read.innovations.size(), 3u);
    EXPECT_EQ(read.innovations[0].sensor, "front, left and \"right\"");
    EXPECT_EQ(read.innovations[1].sensor, "movers");
}

TEST(RowClockTest, DetectionsAlwaysGetARowAndOthersOnePerInterval) {
    run::RowClock clock(1.0);
    EXPECT_TRUE(clock.due(emptyStep(0)));  // the first
    EXPECT_FALSE(clock.due(emptyStep(0.5)));
    EXPECT_TRUE(clock.due(emptyStep(0.75, true)));  // detections
    EXPECT_FALSE(clock.due(emptyStep(1.5)));        // 0.75 s after the last row
    EXPECT_TRUE(clock.due(emptyStep(1.75)));        // 1 s after it
    EXPECT_FALSE(clock.due(emptyStep(2.7)));
    run::RowClock every(0);
    EXPECT_TRUE(every.due(emptyStep(0)));
    EXPECT_TRUE(every.due(emptyStep(0.1)));
}

TEST_F(CsvSinksTest, AFileIsPartUntilItIsClosed) {
    {
        PartFile file(path("a.csv"));
        file.line("one");
        EXPECT_FALSE(fs::exists(path("a.csv")));
    }  // thrown away without close, as by an exception
    EXPECT_FALSE(fs::exists(path("a.csv")));
    EXPECT_EQ(textOf(path("a.csv.part")), "one\n");

    PartFile file(path("b.csv"));
    file.line("two");
    file.close();
    EXPECT_EQ(textOf(path("b.csv")), "two\n");
    EXPECT_FALSE(fs::exists(path("b.csv.part")));
}

TEST_F(CsvSinksTest, AFileThatCannotBeWrittenIsAnError) {
    EXPECT_THAT(messageOf<LogError>([&] { PartFile(path("none/a.csv")); }), HasSubstr("none/a.csv"));
    std::filesystem::create_directory(path("folder"));
    EXPECT_THAT(messageOf<LogError>([&] { PartFile(path("folder")); }), HasSubstr("is a folder"));
    EXPECT_FALSE(std::filesystem::exists(path("folder.part")));
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
    fs::create_symlink("/dev/full", path("full.csv.part"));
    PartFile file(path("full.csv"));
    file.line("one");
    EXPECT_THAT(messageOf<LogError>([&] { file.close(); }), HasSubstr("is the disk full?"));
    EXPECT_FALSE(fs::exists(path("full.csv")));
}

std::string hashOf(const std::vector<Step>& steps, const run::RunEnd& end) {
    run::EstimateHash hash;
    for (const Step& step : steps) hash.step(step);
    hash.end(end);
    return hash.hex();
}

TEST(EstimateHashTest, EqualForEqualRunsAndDifferentForAnyOther) {
    const std::string reference = hashOf({fullStep(1, 1), fullStep(2, 2)}, fullEnd());
    EXPECT_EQ(reference.size(), 64u);
    EXPECT_EQ(reference, hashOf({fullStep(1, 1), fullStep(2, 2)}, fullEnd()));

    const auto changed = [](const auto& change) {
        std::vector<Step> steps{fullStep(1, 1), fullStep(2, 2)};
        run::RunEnd end = fullEnd();
        change(steps, end);
        return hashOf(steps, end);
    };
    const auto bump = [](double& value) { value = std::nextafter(value, 1e9); };
    EXPECT_NE(reference, changed([&](auto& steps, auto&) { steps[0].estimate.stamp.ticks += 1; }));
    EXPECT_NE(reference, changed([&](auto& steps, auto&) { bump(steps[1].estimate.robot.mean.theta); }));
    EXPECT_NE(reference,
              changed([&](auto& steps, auto&) { bump(steps[1].estimate.robot.covariance(2, 1)); }));
    EXPECT_NE(reference, changed([&](auto& steps, auto&) { bump(steps[1].estimate.tracks[0].mean(5)); }));
    EXPECT_NE(reference, changed([&](auto& steps, auto&) { bump(steps[1].estimate.tracks[0].existence); }));
    EXPECT_NE(reference,
              changed([&](auto& steps, auto&) { bump(steps[1].estimate.tracks[0].mode_probabilities[1]); }));
    EXPECT_NE(reference, changed([&](auto& steps, auto&) { bump(steps[1].estimate.tracks[0].moving); }));
    EXPECT_NE(reference, changed([&](auto&, auto& end) { bump(end.landmarks[0].mean(1)); }));
    EXPECT_NE(reference, changed([&](auto&, auto& end) { bump(end.landmarks[0].existence); }));
    EXPECT_NE(reference, changed([&](auto&, auto& end) { bump(end.landmarks[0].moving); }));
    EXPECT_NE(reference, changed([&](auto& steps, auto&) { steps.pop_back(); }));
    EXPECT_NE(reference, changed([&](auto&, auto& end) { end.landmarks.clear(); }));
}

TEST(StepTimerTest, PercentilesOfTheTimeBetweenOutputs) {
    run::StepTimer timer;
    EXPECT_TRUE(std::isnan(timer.percentile(0.5)));
    EXPECT_TRUE(std::isnan(timer.mean()));
    for (int i = 1; i <= 4; ++i) {
        Step prediction = emptyStep(i), update = emptyStep(i + 0.5, true);
        prediction.times.predict = 1.0 * i;
        update.times.update = 0.5;
        timer.step(prediction);
        timer.step(update);
    }
    // 1.5, 2.5, 3.5, 4.5 s: the smallest value that a share q of them does not pass.
    EXPECT_EQ(timer.count(), 4u);
    EXPECT_EQ(timer.percentile(0.25), 1.5);
    EXPECT_EQ(timer.percentile(0.5), 2.5);
    EXPECT_EQ(timer.percentile(0.51), 3.5);
    EXPECT_EQ(timer.percentile(1), 4.5);
    EXPECT_EQ(timer.mean(), 3.0);
}

}  // namespace csv_sinks_test
}  // namespace slamot::test
