#include <gmock/gmock.h>

#include <cmath>

#include "rawlog/TestLogs.h"
#include "slamot/rawlog/LogConvert.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::test {
namespace log_convert_test {

class Convert : public RawlogTest {
  protected:
    ConvertResult convert(const std::string& in, const std::string& out, const ConvertOptions& options = {}) {
        return convertLog(path(in), path(out), {}, options);
    }
    static ConvertOptions to(LogFormat format) {
        ConvertOptions options;
        options.format = format;
        return options;
    }
};

TEST_F(Convert, ObservationsBecomeFramesWithTheWayBetweenThem) {
    // 1 m/s along x: at t = 0.5, 1.25 and 2 the robot is at 0.5, 1.25 and 2 m. The last reading is at 2.5 s.
    writeLog(path("a.rawlog"),
             {odometryAt(0, 0), detectionsAt(0.5, "landmarks", {1}), odometryAt(1, 1), scanAt(1.25),
              detectionsAt(1.25, "landmarks", {2}), odometryAt(2, 2), scanAt(2), odometryAt(2.5, 2.5)});
    const ConvertResult result = convert("a.rawlog", "b.rawlog", to(LogFormat::action_frames));
    EXPECT_EQ(result.observations, 4);
    EXPECT_EQ(result.odometry, 4);  // one action a frame, and the rest of the way
    EXPECT_EQ(result.without_odometry, 0);

    const ReadLog log = readLog(path("b.rawlog"));
    EXPECT_EQ(log.format, LogFormat::action_frames);
    std::vector<double> stamps, ways;
    for (const auto& entry : log.entries)
        if (entry.increment) {
            stamps.push_back(entry.stamp.seconds());
            ways.push_back(entry.increment->increment.x);
        }
    ASSERT_EQ(ways.size(), 4u);
    EXPECT_THAT(stamps, ::testing::ElementsAre(0.5, 1.25, 2, 2.5));
    const double expected[] = {0.5, 0.75, 0.75, 0.5};
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(ways[i], expected[i], 1e-12) << i;  // a few roundings of numbers near 1
    EXPECT_EQ(log.entries[3].observation->sensorLabel, "laser");
    EXPECT_EQ(log.entries[4].observation->sensorLabel, "landmarks");
}

TEST_F(Convert, ThereAndBackKeepsStampsAndPoses) {
    writeLog(path("a.rawlog"), {odometryAt(0, 3), scanAt(1), odometryAt(1, 4), scanAt(2), odometryAt(2, 6)});
    convert("a.rawlog", "b.rawlog", to(LogFormat::action_frames));
    convert("b.rawlog", "c.rawlog", to(LogFormat::observations));
    const ReadLog log = readLog(path("c.rawlog"));
    // Odometry starts at zero, [log] step before the first frame: 0 at 0.9 s, 1 at 1 s, 3 at 2 s.
    std::vector<std::pair<double, double>> poses;
    for (const auto& entry : log.entries)
        if (const auto* o = dynamic_cast<const mrpt::obs::CObservationOdometry*>(entry.observation.get()))
            poses.emplace_back(entry.stamp.seconds(), o->odometry.x());
    ASSERT_EQ(poses.size(), 3u);
    const std::pair<double, double> expected[] = {{0.9, 0}, {1, 1}, {2, 3}};
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(poses[i].first, expected[i].first);
        EXPECT_NEAR(poses[i].second, expected[i].second, 1e-12);
    }
    EXPECT_EQ(log.entries.size(), 5u);
}

TEST_F(Convert, CutsInTimeAndChoosesLabels) {
    writeLog(path("a.rawlog"),
             {odometryAt(0, 0), scanAt(1), detectionsAt(1, "landmarks", {1}), odometryAt(1, 1), scanAt(2),
              detectionsAt(2, "movers", {1}), odometryAt(2, 2), scanAt(3)});
    ConvertOptions options;
    options.labels = {"laser"};
    options.from = Stamp::fromSeconds(1);
    options.to = Stamp::fromSeconds(2);
    const ConvertResult result = convert("a.rawlog", "b.rawlog", options);
    EXPECT_EQ(result.format, LogFormat::observations);
    EXPECT_EQ(result.odometry, 2);
    EXPECT_EQ(result.observations, 2);
    EXPECT_EQ(result.left_out, 4);
    EXPECT_EQ(readLog(path("b.rawlog")).entries.size(), 4u);
}

TEST_F(Convert, FramesKeepTheirCovariance) {
    mrpt::obs::CActionRobotMovement2D movement;
    mrpt::obs::CActionRobotMovement2D::TMotionModelOptions model;
    model.gaussianModel = {0, 0, 0, 0, 0.5, 0.25};
    movement.computeFromOdometry(mrpt::poses::CPose2D(1, 0.5, 0.1), model);
    mrpt::obs::CActionCollection actions;
    actions.insert(movement);
    mrpt::obs::CSensoryFrame frame;
    frame.insert(scanAt(1));
    RawlogWriter writer(path("a.rawlog"));
    writer.writeFrame(actions, frame);
    writer.close();
    convert("a.rawlog", "b.rawlog");
    const ReadLog log = readLog(path("b.rawlog"));
    ASSERT_EQ(log.entries.size(), 2u);
    // MRPT wraps the heading on its way, a rounding of numbers near 2 pi.
    EXPECT_LT((log.entries[0].increment->increment.vector() - Vector3(1, 0.5, 0.1)).norm(), 1e-15);
    EXPECT_EQ((*log.entries[0].increment->covariance)(2, 2), 0.0625);
}

TEST_F(Convert, ObservationsOutsideOdometryAreCounted) {
    writeLog(path("a.rawlog"), {scanAt(0), odometryAt(1, 1), odometryAt(2, 2), scanAt(3)});
    const ConvertResult result = convert("a.rawlog", "b.rawlog", to(LogFormat::action_frames));
    EXPECT_EQ(result.observations, 2);
    EXPECT_EQ(result.without_odometry, 2);
}

TEST_F(Convert, ABrokenLogIsConvertedUpToTheBreak) {
    writeBytes(path("a.rawlog"), bytesOf(*odometryAt(1, 0)) + bytesOf(*scanAt(2)).substr(0, 20));
    const ConvertResult result = convert("a.rawlog", "b.rawlog");
    EXPECT_EQ(result.end, LogEnd::truncated);
    EXPECT_EQ(readLog(path("b.rawlog")).entries.size(), 1u);
}

TEST_F(Convert, ALogIsNotWrittenOverItself) {
    writeLog(path("a.rawlog"), {odometryAt(1, 0)});
    EXPECT_THROW(convert("a.rawlog", "a.rawlog"), LogError);
    EXPECT_EQ(readLog(path("a.rawlog")).entries.size(), 1u);
}

TEST_F(Convert, CanBeStopped) {
    writeLog(path("a.rawlog"), {odometryAt(1, 0)});
    EXPECT_THROW(convertLog(path("a.rawlog"), path("b.rawlog"), {}, {}, [](double) { return false; }),
                 LogError);
    EXPECT_FALSE(std::filesystem::exists(path("b.rawlog")));
}

}  // namespace log_convert_test
}  // namespace slamot::test
