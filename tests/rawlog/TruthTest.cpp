#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "rawlog/TestLogs.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/Truth.h"

namespace slamot::test {
namespace truth_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
class TruthFolder : public RawlogTest {};

Stamp at(double seconds) {
    return Stamp::fromSeconds(seconds);
}

Truth smallTruth() {
    Truth truth;
    truth.robot = {{at(1.0), {0, 0, 3.0}}, {at(1.1), {1, 2, -3.0}}, {at(1.5), {5, 5, 0}}};
    truth.targets[SourceId{4}] = {{at(1.0), {1, 1}, {nan, nan}, {0.5, 0}, "cv"},
                                  {at(1.04), {2, 3}, {1, 1}, {1.5, 0}, "ct"}};
    truth.landmarks[SourceId{7}] = {0.1, -0.3};
    truth.associations = {{at(1.0), 0, "landmark", SourceId{7}}, {at(1.0), 1, "clutter", SourceId{}}};
    truth.source = "by hand";
    truth.position_std = 0.25;
    return truth;
}

TEST(Truth, TheRobotIsInterpolatedTheShortWayRound) {
    const Truth truth = smallTruth();
    const auto pose = truth.robotAt(at(1.05));  // half way; from 3 to -3 over pi is 2 pi - 6 = 0.2832 rad
    ASSERT_TRUE(pose);
    EXPECT_DOUBLE_EQ(pose->x, 0.5);
    EXPECT_DOUBLE_EQ(pose->y, 1.0);
    EXPECT_NEAR(std::abs(pose->theta), pi, 1e-15);  // 3 + 0.2832 / 2 = pi, one rounding
}

TEST(Truth, NothingIsInterpolatedAcrossAGapOrBeyondTheEnds) {
    const Truth truth = smallTruth();
    EXPECT_FALSE(truth.robotAt(at(1.3)));  // neighbours 0.4 s apart
    EXPECT_TRUE(truth.robotAt(at(1.5)));   // a sample answers for its own stamp
    EXPECT_FALSE(truth.robotAt(at(0.99)));
    EXPECT_FALSE(truth.robotAt(at(1.5000001)));
    EXPECT_FALSE(Truth{}.robotAt(at(1)));
}

TEST(Truth, TargetsAreInterpolatedLinearly) {
    const Truth truth = smallTruth();
    const auto target = truth.targetAt(SourceId{4}, at(1.01));  // a quarter of the way
    ASSERT_TRUE(target);
    EXPECT_DOUBLE_EQ(target->position.x(), 1.25);
    EXPECT_DOUBLE_EQ(target->position.y(), 1.5);
    EXPECT_TRUE(std::isnan(target->velocity.x()));  // unknown at one end
    EXPECT_DOUBLE_EQ(target->acceleration.x(), 0.75);
    EXPECT_EQ(target->mode, "cv");
    EXPECT_FALSE(truth.targetAt(SourceId{5}, at(1.01)));
}

TEST_F(TruthFolder, ComesBackAsItWasWritten) {
    const Truth truth = smallTruth();
    writeTruth(truth, path("a.truth"));
    const Truth back = readTruth(path("a.truth"));
    ASSERT_EQ(back.robot.size(), 3u);
    EXPECT_EQ(back.robot[1].stamp, at(1.1));
    EXPECT_EQ(back.robot[1].pose.vector(), truth.robot[1].pose.vector());
    const auto& samples = back.targets.at(SourceId{4});
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_TRUE(samples[0].velocity.array().isNaN().all());
    EXPECT_EQ(samples[1].acceleration, Vector2(1.5, 0));
    EXPECT_EQ(samples[1].mode, "ct");
    EXPECT_EQ(back.landmarks.at(SourceId{7}), Vector2(0.1, -0.3));
    ASSERT_EQ(back.associations.size(), 2u);
    EXPECT_EQ(back.associations[1].kind, "clutter");
    EXPECT_FALSE(back.associations[1].id.valid());
    EXPECT_EQ(back.source, "by hand");
    EXPECT_EQ(back.position_std, 0.25);

    // Steps of the robot: 0.1 s (no gap) and 0.4 s (a gap).
    const auto notes = nlohmann::json::parse(readBytes(path("a.truth/truth.json")));
    EXPECT_EQ(notes["robot"]["gaps"], 1);
    EXPECT_EQ(notes["robot"]["largest_step_seconds"], 0.4);
    EXPECT_THAT(readBytes(path("a.truth/target_4.csv")), HasSubstr("1.0000000,1,1,,,0.5,0,cv\n"));
}

TEST_F(TruthFolder, TellsHowFarApartItsSamplesMayBe) {
    Truth truth = smallTruth();
    truth.max_interpolation_gap = 0.5;
    EXPECT_TRUE(truth.robotAt(at(1.3)));  // neighbours 0.4 s apart
    writeTruth(truth, path("a.truth"));
    EXPECT_TRUE(readTruth(path("a.truth")).robotAt(at(1.3)));
    EXPECT_EQ(nlohmann::json::parse(readBytes(path("a.truth/truth.json")))["robot"]["gaps"], 0);
}

TEST_F(TruthFolder, MayBeMeasuredBesideTheRobotsOrigin) {
    Truth truth;
    truth.point = {2, 1};
    truth.robot = {{at(1), {9, 2, pi / 2}}, {at(2), {9, 2, std::nan("")}}};
    writeTruth(truth, path("a.truth"));
    const Truth back = readTruth(path("a.truth"));
    EXPECT_EQ(back.point, Vector2(2, 1));
    EXPECT_EQ(back.pointAt(at(1))->position(), Vector2(9, 2));
    // Two metres ahead and one to the left of (10, 0), looking along y.
    EXPECT_NEAR((back.robotAt(at(1))->position() - Vector2(10, 0)).norm(), 0, 1e-14);
    EXPECT_TRUE(std::isnan(back.robotAt(at(2))->x));
    EXPECT_EQ(back.pointAt(at(2))->position(), Vector2(9, 2));
}

TEST_F(TruthFolder, AHeadingMayBeUnknown) {
    Truth truth = smallTruth();
    for (TruePose& sample : truth.robot) sample.pose.theta = std::nan("");
    writeTruth(truth, path("a.truth"));
    EXPECT_THAT(readBytes(path("a.truth/robot.csv")), HasSubstr(",\n"));
    const auto pose = readTruth(path("a.truth")).robotAt(at(1.05));
    ASSERT_TRUE(pose);
    EXPECT_TRUE(std::isnan(pose->theta));
    EXPECT_DOUBLE_EQ(pose->x, 0.5);
}

TEST_F(TruthFolder, WritingAgainRemovesWhatTheNewTruthLacks) {
    writeTruth(smallTruth(), path("a.truth"));
    Truth less = smallTruth();
    less.targets.clear();
    less.landmarks.clear();
    writeTruth(less, path("a.truth"));
    const Truth back = readTruth(path("a.truth"));
    EXPECT_TRUE(back.targets.empty());
    EXPECT_TRUE(back.landmarks.empty());
}

std::string messageOf(const std::string& folder) {
    try {
        readTruth(folder);
    } catch (const LogError& error) {
        return error.what();
    }
    return "no LogError";
}

TEST_F(TruthFolder, BadFilesAreNamed) {
    EXPECT_THAT(messageOf(path("none")), HasSubstr("is no folder"));
    EXPECT_THAT(messageOf(folder_.string()), HasSubstr("holds no truth"));
    writeBytes(path("robot.csv"), "t,x,y,theta\n1,0,0,0\n1,0,0,0\n");
    EXPECT_THAT(messageOf(folder_.string()), AllOf(HasSubstr("robot.csv:3"), HasSubstr("later")));
    writeBytes(path("robot.csv"), "t,x,y,theta\n1,0,0,0\n2,0,0");  // cut off
    EXPECT_THAT(messageOf(folder_.string()), AllOf(HasSubstr("robot.csv:3"), HasSubstr("3 fields")));
    writeBytes(path("robot.csv"), "t,x,y,theta\n1,0,nan,0\n");
    EXPECT_THAT(messageOf(folder_.string()), AllOf(HasSubstr("robot.csv:2"), HasSubstr("finite")));
    writeBytes(path("robot.csv"), "t,x,y,theta\n");
    writeBytes(path("target_a.csv"), "t,x,y\n");
    EXPECT_THAT(messageOf(folder_.string()), HasSubstr("target_a.csv"));
    std::filesystem::remove(path("target_a.csv"));
    writeBytes(path("associations.csv"), "t,index,kind,id\n1,0,tree,3\n");
    EXPECT_THAT(messageOf(folder_.string()), AllOf(HasSubstr("associations.csv:2"), HasSubstr("clutter")));
    std::filesystem::remove(path("associations.csv"));
    writeBytes(path("truth.json"), "{");
    EXPECT_THAT(messageOf(folder_.string()), HasSubstr("truth.json"));
    writeBytes(path("truth.json"), R"({"gap_means_longer_than_seconds": 0})");
    EXPECT_THAT(messageOf(folder_.string()),
                AllOf(HasSubstr("truth.json"), HasSubstr("is 0"), HasSubstr("positive number of seconds")));
}

TEST(Truth, FolderBesideTheLog) {
    EXPECT_EQ(truthFolderOf("a/b.rawlog"), "a/b.truth");
}

}  // namespace truth_test
}  // namespace slamot::test
