#include <gmock/gmock.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CRawlog.h>

#include <algorithm>
#include <limits>
#include <random>

#include "rawlog/TestLogs.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/MemoryLog.h"
#include "slamot/rawlog/RawlogReader.h"

namespace slamot::test {
namespace rawlog_reader_test {

using ::testing::ElementsAre;

class Reader : public RawlogTest {};

std::vector<std::string> sequence(const ReadLog& log) {
    std::vector<std::string> rows;
    for (const auto& e : log.entries)
        rows.push_back(toText(e.stamp) + " " + (e.increment ? "increment" : e.observation->sensorLabel));
    return rows;
}

TEST_F(Reader, RoundTripIsExact) {
    const Stamp stamp{12'484'441'871'560'001};
    const OdometryReading reading{stamp, {1.0 / 3, -2.0 / 7, 0.1}, BodyVelocity{0.1, 0.2, 0.3}};
    writeLog(path("a.rawlog"), {toMrpt(reading, "odometry")});
    const ReadLog log = readLog(path("a.rawlog"));
    ASSERT_EQ(log.entries.size(), 1u);
    EXPECT_EQ(log.end, LogEnd::clean);
    EXPECT_EQ(log.format, LogFormat::observations);
    EXPECT_EQ(log.entries[0].stamp, stamp);
    const auto back =
        fromMrpt(dynamic_cast<const mrpt::obs::CObservationOdometry&>(*log.entries[0].observation));
    EXPECT_EQ(back.pose.x, 1.0 / 3);
    EXPECT_EQ(back.pose.y, -2.0 / 7);
    EXPECT_EQ(back.velocity->omega, 0.3);
}

TEST_F(Reader, OneStampIsOrderedByRankThenLabelThenPosition) {
    auto other = mrpt::obs::CObservationComment::Create();  // counts as no sensor
    writeLog(path("a.rawlog"), {other, detectionsAt(1, "movers", {1}), detectionsAt(1, "landmarks", {2}),
                                scanAt(1), odometryAt(1, 0), detectionsAt(1, "landmarks", {3})});
    const ReadLog log = readLog(path("a.rawlog"));
    EXPECT_THAT(sequence(log), ElementsAre("1.0000000 odometry", "1.0000000 laser", "1.0000000 landmarks",
                                           "1.0000000 landmarks", "1.0000000 movers"));
    EXPECT_EQ(log.entries[2].position, 2);
    EXPECT_EQ(log.entries[3].position, 5);
    EXPECT_EQ(log.drops.rows().at({"", "comment"}), 1);
}

TEST_F(Reader, PermutedArrivalWithinTheWindowGivesTheSameSequence) {
    std::vector<mrpt::obs::CObservation::Ptr> in_order;
    for (int i = 0; i < 60; ++i) {
        in_order.push_back(odometryAt(0.1 * i, i));
        in_order.push_back(scanAt(0.1 * i));
        in_order.push_back(detectionsAt(0.1 * i, "landmarks", {i}));
    }
    writeLog(path("in_order.rawlog"), in_order);
    const auto expected = sequence(readLog(path("in_order.rawlog")));
    ASSERT_EQ(expected.size(), 180u);

    std::mt19937 generator(7);
    for (int trial = 0; trial < 5; ++trial) {
        // Shuffled within blocks of 1 s: nothing arrives more than 0.9 s behind the newest.
        auto permuted = in_order;
        for (std::size_t i = 0; i < permuted.size(); i += 30)
            std::shuffle(permuted.begin() + i, permuted.begin() + i + 30, generator);
        writeLog(path("permuted.rawlog"), permuted);
        const ReadLog log = readLog(path("permuted.rawlog"));
        EXPECT_EQ(sequence(log), expected);
        EXPECT_EQ(log.drops.total(), 0);
    }
}

TEST_F(Reader, WhatIsLaterThanTheWindowIsDropped) {
    writeLog(path("a.rawlog"),
             {odometryAt(2, 0), odometryAt(0.9999999, 1), odometryAt(1, 2), odometryAt(3, 3)});
    const ReadLog log = readLog(path("a.rawlog"));
    EXPECT_THAT(sequence(log), ElementsAre("1.0000000 odometry", "2.0000000 odometry", "3.0000000 odometry"));
    EXPECT_EQ(log.drops.rows().at({"odometry", "late"}), 1);

    LogParameters none;
    none.reorder_window = 0;
    EXPECT_EQ(readLog(path("a.rawlog"), none).drops.rows().at({"odometry", "late"}), 2);
}

std::vector<double> secondsOf(const ReadLog& log) {
    std::vector<double> seconds;
    for (const LogEntry& entry : log.entries)
        seconds.push_back(static_cast<double>(entry.stamp.ticks) * 1e-7);
    return seconds;
}

TEST_F(Reader, AWildStampIsDroppedAndNotTheRest) {
    // 5000 s is more than an hour ahead of 2 s, and 3 s would be late behind it.
    writeLog(path("a.rawlog"),
             {odometryAt(1, 0), odometryAt(2, 0), odometryAt(5000, 0), odometryAt(3, 0), odometryAt(4, 0)});
    const ReadLog log = readLog(path("a.rawlog"));
    EXPECT_EQ(secondsOf(log), (std::vector<double>{1, 2, 3, 4}));
    EXPECT_EQ(log.drops.rows().at({"odometry", "stamp-jump"}), 1);
    EXPECT_EQ(log.drops.total(), 1);

    writeLog(path("b.rawlog"), {odometryAt(5000, 0), odometryAt(3, 0), odometryAt(4, 0)});
    const ReadLog first = readLog(path("b.rawlog"));
    EXPECT_EQ(secondsOf(first), (std::vector<double>{3, 4}));
    EXPECT_EQ(first.drops.rows().at({"odometry", "stamp-jump"}), 1);
}

TEST_F(Reader, ALongPauseIsKept) {
    // Pauses of more than an hour, one before entries out of order within the window, one before the last.
    writeLog(path("a.rawlog"),
             {odometryAt(1, 0), odometryAt(5000.5, 0), odometryAt(5000, 0), odometryAt(10000, 0)});
    const ReadLog log = readLog(path("a.rawlog"));
    EXPECT_EQ(secondsOf(log), (std::vector<double>{1, 5000, 5000.5, 10000}));
    EXPECT_EQ(log.drops.total(), 0);
}

TEST_F(Reader, InvalidStampsAreDropped) {
    auto invalid = odometryAt(1, 0);
    invalid->timestamp = INVALID_TIMESTAMP;
    writeLog(path("a.rawlog"), {invalid, odometryAt(2, 0)});
    const ReadLog log = readLog(path("a.rawlog"));
    EXPECT_EQ(log.entries.size(), 1u);
    EXPECT_EQ(log.drops.rows().at({"odometry", "no-stamp"}), 1);
}

TEST_F(Reader, UncompressedLogsAreRead) {
    writeBytes(path("a.rawlog"), bytesOf(*odometryAt(1, 0)) + bytesOf(*scanAt(2)));
    const ReadLog log = readLog(path("a.rawlog"));
    EXPECT_THAT(sequence(log), ElementsAre("1.0000000 odometry", "2.0000000 laser"));
    EXPECT_EQ(log.end, LogEnd::clean);
}

TEST_F(Reader, ALogSavedAsOneObjectIsUnpacked) {
    mrpt::obs::CRawlog whole;
    whole.insert(mrpt::serialization::CSerializable::Ptr(odometryAt(1, 0)));
    whole.insert(mrpt::serialization::CSerializable::Ptr(scanAt(2)));
    writeBytes(path("a.rawlog"), bytesOf(whole));
    const ReadLog log = readLog(path("a.rawlog"));
    EXPECT_THAT(sequence(log), ElementsAre("1.0000000 odometry", "2.0000000 laser"));
    EXPECT_EQ(log.entries[1].position, 1);
}

mrpt::obs::CActionCollection action(double dx) {
    mrpt::obs::CActionRobotMovement2D movement;
    movement.timestamp = INVALID_TIMESTAMP;
    movement.computeFromOdometry(mrpt::poses::CPose2D(dx, 0, 0), {});
    mrpt::obs::CActionCollection actions;
    actions.insert(movement);
    return actions;
}

mrpt::obs::CSensoryFrame frame(const std::vector<mrpt::obs::CObservation::Ptr>& observations) {
    mrpt::obs::CSensoryFrame result;
    for (const auto& observation : observations) result.insert(observation);
    return result;
}

TEST_F(Reader, FramesWithoutUsableStampsAreTimedByTheirNumber) {
    RawlogWriter writer(path("a.rawlog"));
    for (int i = 0; i < 3; ++i) writer.writeFrame(action(i), frame({detectionsAt(5, "", {i}), scanAt(5)}));
    writer.close();
    LogParameters parameters;
    parameters.step = 0.5;
    RawlogReader reader(path("a.rawlog"), parameters);
    EXPECT_EQ(reader.format(), LogFormat::action_frames);
    EXPECT_TRUE(reader.timedByStep());
    for (int i = 0; i < 3; ++i) {
        const Stamp begin = later(action_frame_epoch, 0.5 * i),
                    end = later(action_frame_epoch, 0.5 * (i + 1));
        const auto increment = reader.next();
        ASSERT_TRUE(increment && increment->increment);
        EXPECT_EQ(increment->stamp, end);
        EXPECT_EQ(increment->increment->t0, begin);
        EXPECT_EQ(increment->increment->t1, end);
        EXPECT_EQ(increment->increment->entry_seconds, 0.5);
        EXPECT_EQ(increment->increment->increment.x, i);
        for (const char* label : {"laser", ""}) {  // lidar before detections
            const auto seen = reader.next();
            ASSERT_TRUE(seen && seen->observation);
            EXPECT_EQ(seen->observation->sensorLabel, label);
            EXPECT_EQ(seen->stamp, end);
            EXPECT_EQ(toStamp(seen->observation->timestamp), end);
        }
    }
    EXPECT_FALSE(reader.next());
    EXPECT_EQ(reader.end(), LogEnd::clean);
    EXPECT_EQ(reader.objects(), 6);
}

TEST_F(Reader, AFrameBeforeTheFirstActionLiesAtTheStart) {
    writeBytes(path("a.rawlog"),
               bytesOf(frame({scanAt(1)})) + bytesOf(action(1)) + bytesOf(frame({})) + bytesOf(action(2)));
    const ReadLog log = readLog(path("a.rawlog"));  // step 0.1 s
    ASSERT_EQ(log.entries.size(), 3u);
    EXPECT_EQ(log.entries[0].stamp, action_frame_epoch);
    EXPECT_EQ(log.entries[1].increment->t0, action_frame_epoch);
    EXPECT_EQ(log.entries[1].stamp, later(action_frame_epoch, 0.1));
    EXPECT_EQ(log.entries[2].increment->increment.x, 2);  // an action at the end has no frame
    EXPECT_EQ(log.entries[2].stamp, later(action_frame_epoch, 0.2));
}

TEST_F(Reader, FramesWithRisingStampsKeepThem) {
    RawlogWriter writer(path("a.rawlog"));
    for (int i = 1; i <= 3; ++i)
        writer.writeFrame(action(i), frame({scanAt(0.25 * i), odometryAt(0.25 * i, 0)}));
    writer.close();
    RawlogReader reader(path("a.rawlog"), {});
    EXPECT_FALSE(reader.timedByStep());
    const auto first = reader.next();
    EXPECT_EQ(first->increment->t0, Stamp::fromSeconds(0.15));  // nothing tells: [log] step before its end
    EXPECT_EQ(first->increment->t1, Stamp::fromSeconds(0.25));
    reader.next();
    const auto second = reader.next();
    EXPECT_EQ(second->increment->t0, Stamp::fromSeconds(0.25));
    EXPECT_EQ(second->increment->t1, Stamp::fromSeconds(0.5));
    while (reader.next()) {
    }
    EXPECT_EQ(reader.drops().rows().at({"odometry", "odometry-within-frame"}), 3);
}

TEST_F(Reader, AMovementThatIsNotFiniteIsAnError) {
    RawlogWriter writer(path("a.rawlog"));
    writer.writeFrame(action(1), frame({scanAt(1)}));
    writer.writeFrame(action(std::numeric_limits<double>::quiet_NaN()), frame({scanAt(2)}));
    writer.close();
    RawlogReader reader(path("a.rawlog"), {});
    EXPECT_TRUE(reader.next());
    EXPECT_TRUE(reader.next());
    try {
        reader.next();
        FAIL() << "expected a LogError";
    } catch (const LogError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("a.rawlog: object 2: "));
    }
}

TEST_F(Reader, MrptsOwnDemoLog) {
    const std::string demo = "/usr/share/mrpt/datasets/kf-slam_demo.rawlog";
    if (!std::filesystem::exists(demo)) GTEST_SKIP() << demo << " is absent: install mrpt-apps";
    const ReadLog log = readLog(demo);
    EXPECT_EQ(log.end, LogEnd::clean);
    EXPECT_EQ(log.format, LogFormat::action_frames);
    EXPECT_EQ(log.drops.total(), 0);
    const auto increments =
        std::count_if(log.entries.begin(), log.entries.end(), [](const LogEntry& e) { return e.increment; });
    // A sensory frame first, an action last, 249 pairs between (kf-slam runs 249 steps).
    EXPECT_EQ(increments, 250);
    EXPECT_EQ(log.entries.size() - increments, 250u);
    EXPECT_EQ(log.entries.front().stamp, action_frame_epoch);
    EXPECT_EQ(log.entries.back().stamp, later(action_frame_epoch, 25.0));  // 250 steps of 0.1 s
}

// What the reader makes of a file, a MemoryLog makes of the same observations: order, drops and all.
TEST_F(Reader, AMemoryLogGivesTheSameEntries) {
    auto observations = std::make_shared<std::vector<mrpt::obs::CObservation::Ptr>>();
    const auto add = [&](mrpt::obs::CObservation::Ptr observation) { observations->push_back(observation); };
    add(detectionsAt(10.0, "landmarks", {1}));
    add(odometryAt(10.0, 0));
    add(odometryAt(12.0, 2));
    add(odometryAt(11.5, 1));  // within the window
    add(odometryAt(10.5, 1));  // too late
    auto no_stamp = odometryAt(12.5, 1);
    no_stamp->timestamp = INVALID_TIMESTAMP;
    add(no_stamp);
    RawlogWriter writer(path("a.rawlog"));
    for (const auto& observation : *observations) writer.write(*observation);
    writer.close();

    RawlogReader file(path("a.rawlog"), {});
    MemoryLog memory(observations, {});
    int entries = 0;
    while (const auto expected = file.next()) {
        const auto entry = memory.next();
        ASSERT_TRUE(entry);
        EXPECT_EQ(entry->stamp, expected->stamp);
        EXPECT_EQ(entry->position, expected->position);
        EXPECT_EQ(entry->observation->sensorLabel, expected->observation->sensorLabel);
        ++entries;
    }
    EXPECT_EQ(entries, 4);
    EXPECT_FALSE(memory.next());
    EXPECT_EQ(memory.end(), LogEnd::clean);
    EXPECT_EQ(memory.drops().rows(), file.drops().rows());
    EXPECT_EQ(memory.drops().total(), 2);
}

}  // namespace rawlog_reader_test
}  // namespace slamot::test
