#include <gmock/gmock.h>

#include <csignal>
#include <cstdlib>

#include "rawlog/TestLogs.h"
#include "slamot/rawlog/LogCheck.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::test {
namespace log_check_test {

using ::testing::HasSubstr;

class LogCheck : public RawlogTest {
  protected:
    void SetUp() override {
        RawlogTest::SetUp();
        auto unstamped = odometryAt(1, 0);
        unstamped->timestamp = INVALID_TIMESTAMP;
        writeLog(path("a.rawlog"), {odometryAt(1, 0), unstamped, detectionsAt(1.5, "landmarks", {3, -1}),
                                    detectionsAt(2.5, "landmarks", {4}), scanAt(2), odometryAt(3, 1)});
    }

    static void expectRight(const LogSummary& summary) {
        EXPECT_EQ(summary.format, LogFormat::observations);
        EXPECT_EQ(summary.end, LogEnd::clean);
        EXPECT_EQ(summary.objects, 6);
        EXPECT_EQ(summary.drops.rows().at({"odometry", "no-stamp"}), 1);
        ASSERT_EQ(summary.sensors.size(), 3u);
        EXPECT_EQ(summary.sensors[0].class_name, "CObservation2DRangeScan");
        const SensorSummary& detections = summary.sensors[1];
        EXPECT_EQ(detections.class_name, "CObservationBearingRange");
        EXPECT_EQ(detections.label, "landmarks");
        EXPECT_EQ(detections.count, 2);
        EXPECT_EQ(detections.detections, 3);
        EXPECT_EQ(detections.identified, 2);
        EXPECT_TRUE(detections.has_noise);
        EXPECT_FALSE(detections.has_velocities);
        EXPECT_EQ(detections.first, Stamp::fromSeconds(1.5));
        EXPECT_EQ(detections.last, Stamp::fromSeconds(2.5));
        EXPECT_EQ(summary.sensors[2].count, 2);
        EXPECT_TRUE(summary.sensors[2].has_velocities);
    }
};

TEST_F(LogCheck, SummaryOfALog) {
    expectRight(summarise(path("a.rawlog"), {}));
}

TEST_F(LogCheck, JsonComesBack) {
    expectRight(logSummaryFromJson(toJson(summarise(path("a.rawlog"), {}))));
    EXPECT_THROW(logSummaryFromJson("{}"), LogError);
    EXPECT_THROW(logSummaryFromJson("no json"), LogError);
}

TEST_F(LogCheck, LabelsThatAreNoTextSurviveTheJson) {
    writeLog(path("b.rawlog"), {odometryAt(1, 0, "\xff\xfe")});
    EXPECT_EQ(logSummaryFromJson(toJson(summarise(path("b.rawlog"), {}))).sensors.at(0).count, 1);
}

TEST_F(LogCheck, OneReadingWithoutVelocityOrNoiseShows) {
    auto no_velocity = odometryAt(2, 0);
    no_velocity->hasVelocities = false;
    auto no_noise = detectionsAt(2, "movers", {1});
    no_noise->sensor_std_yaw = 0;
    writeLog(path("b.rawlog"), {odometryAt(1, 0), no_velocity, detectionsAt(1, "movers", {1}), no_noise});
    const LogSummary summary = summarise(path("b.rawlog"), {});
    EXPECT_FALSE(summary.sensors.at(0).has_noise);
    EXPECT_FALSE(summary.sensors.at(1).has_velocities);
}

TEST_F(LogCheck, TheChildsAnswerIsTheSame) {
    expectRight(summariseInChild(SLAMOT_CHECK_LOG_HELPER, path("a.rawlog"), {}));
}

TEST_F(LogCheck, TheChildHasTheParentsParameters) {
    LogParameters parameters;
    parameters.reorder_window = 0.25;  // the scan at 2 comes 0.5 s after the detections of 2.5
    const LogSummary summary = summariseInChild(SLAMOT_CHECK_LOG_HELPER, path("a.rawlog"), parameters);
    EXPECT_EQ(summary.drops.rows().at({"laser", "late"}), 1);
}

TEST_F(LogCheck, WhatTheChildRefusesIsAnError) {
    try {
        summariseInChild(SLAMOT_CHECK_LOG_HELPER, path("none.rawlog"), {});
        FAIL() << "expected a LogError";
    } catch (const LogError& error) {
        EXPECT_THAT(error.what(), HasSubstr("none.rawlog: there is no such file"));
    }
}

TEST_F(LogCheck, AChildThatDiesMeansACorruptLog) {
    const LogSummary summary = summariseInChild(SLAMOT_CHECK_LOG_HELPER, "die", {});
    EXPECT_EQ(summary.end, LogEnd::corrupt);
    EXPECT_THAT(summary.end_message, HasSubstr("signal 9"));
}

TEST_F(LogCheck, AChildOutOfTimeIsSaidToBe) {
    const LogSummary summary = summariseInChild(SLAMOT_CHECK_LOG_HELPER, "too_long", {});
    EXPECT_EQ(summary.end, LogEnd::corrupt);
    EXPECT_THAT(summary.end_message, HasSubstr("was not done within 600 s of CPU time"));
}

TEST_F(LogCheck, AnInterruptedChildSaysNothingOfTheLog) {
    EXPECT_THROW(summariseInChild(SLAMOT_CHECK_LOG_HELPER, "interrupted", {}), std::runtime_error);
}

TEST_F(LogCheck, TheChildHasATimeLimitOneBlasThreadAndTheDefaultInterrupt) {
    const auto before = std::signal(SIGINT, SIG_IGN);
    setenv("OPENBLAS_NUM_THREADS", "64", 1);
    std::string answer;
    try {
        summariseInChild(SLAMOT_CHECK_LOG_HELPER, "tell", {});
    } catch (const LogError& error) {
        answer = error.what();
    }
    unsetenv("OPENBLAS_NUM_THREADS");
    std::signal(SIGINT, before);
    EXPECT_EQ(answer, "cpu 600, threads 1, SIGINT default");
}

TEST_F(LogCheck, AProgramThatIsNotThereIsNamed) {
    EXPECT_THROW(summariseInChild(path("no_program"), path("a.rawlog"), {}), std::runtime_error);
}

}  // namespace log_check_test
}  // namespace slamot::test
