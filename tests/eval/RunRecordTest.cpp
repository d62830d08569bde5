#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "Builders.h"
#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::eval {
namespace run_record_test {

using testing::AllOf;
using testing::HasSubstr;

template <class Function>
std::string messageOf(Function&& function) {
    try {
        function();
    } catch (const LogError& e) {
        return e.what();
    }
    return "no LogError";
}

const char* const trajectory_head = "t,x,y,theta,c_xx,c_xy,c_xt,c_yy,c_yt,c_tt\n";

TEST(ReadRun, TakesColumnsByName) {
    const TemporaryFolder folder;
    folder.write("trajectory.csv", std::string(trajectory_head) +
                                       "1.5,1,2,0.25,11,12,13,22,23,33\n"
                                       "1.6,3,4,0.5,0,0,0,0,0,0\n");
    std::string head = "t,track,x,y,vx,vy,ax,ay", values = "1.5,4,1,2,3,4,5,6";
    for (int r = 0; r < 6; ++r)
        for (int c = r; c < 6; ++c) {
            head += ",c_" + std::to_string(r) + "_" + std::to_string(c);
            values += "," + std::to_string(10 * r + c);
        }
    folder.write("tracks.csv", head + ",existence,p_cv,p_ct,source_id\n" + values + ",0.75,0.25,0.5,42\n");
    // Columns in another order than written today.
    folder.write("landmarks.csv",
                 "source_id,id,x,y,c_xx,c_xy,c_yy,seen,first_t,last_t\n-1,3,7,8,1,0.5,2,12,1.5,1.6\n");
    folder.write("innovations.csv",
                 "t,sensor,kind,landmark,track,outcome,r_range,r_bearing,s_rr,s_rb,s_bb,nis,detection\n"
                 "1.6,cam,mover,-1,4,updated,0.1,0.2,1,0.5,2,0.0625,1\n"
                 "1.6,cam,landmark,3,-1,initiated,nan,nan,nan,nan,nan,nan,0\n");
    const RunRecord run = readRun(folder.path());
    ASSERT_EQ(run.trajectory.size(), 2u);
    EXPECT_EQ(run.trajectory[0].stamp.ticks, 15'000'000);
    EXPECT_EQ(run.trajectory[0].robot.mean.theta, 0.25);
    EXPECT_EQ(run.trajectory[0].robot.covariance(2, 1), 23);
    ASSERT_EQ(run.tracks.size(), 1u);
    const TrackEstimate& t = run.tracks.at(at(1.5)).at(0);
    EXPECT_EQ(t.id, TrackId{4});
    EXPECT_EQ(t.source, SourceId{42});
    EXPECT_EQ(t.mean(5), 6);
    EXPECT_EQ(t.covariance(3, 1), 13);
    EXPECT_EQ(t.existence, 0.75);
    EXPECT_EQ(t.mode_probabilities, (std::vector<double>{0.25, 0.5}));
    EXPECT_EQ(run.mode_names, (std::vector<std::string>{"cv", "ct"}));
    ASSERT_EQ(run.landmarks.size(), 1u);
    EXPECT_FALSE(run.landmarks[0].source.valid());
    EXPECT_EQ(run.landmarks[0].covariance(1, 0), 0.5);
    EXPECT_EQ(run.landmarks[0].last_seen, at(1.6));
    ASSERT_EQ(run.innovations.size(), 2u);
    EXPECT_EQ(run.innovations[0].innovation.outcome, Outcome::updated);
    EXPECT_EQ(run.innovations[0].innovation.kind, ObjectKind::mover);
    EXPECT_EQ(run.innovations[0].innovation.nis, 0.0625);
    EXPECT_EQ(run.innovations[0].innovation.detection, 1);
    EXPECT_TRUE(std::isnan(run.innovations[1].innovation.nis));
    EXPECT_EQ(run.innovations[1].innovation.landmark, LandmarkId{3});
}

TEST(ReadRun, WhatIsMovingExistsAndIsTentativeIsReadWhereItIsTold) {
    const TemporaryFolder folder;
    folder.write("trajectory.csv", std::string(trajectory_head) + "1.5,0,0,0,0,0,0,0,0,0\n");
    std::string covariance_names, zeros;
    for (int r = 0; r < 6; ++r)
        for (int c = r; c < 6; ++c) {
            covariance_names += ",c_" + std::to_string(r) + "_" + std::to_string(c);
            zeros += ",0";
        }
    const std::string innovation_head =
        "t,sensor,kind,landmark,track,outcome,r_range,r_bearing,s_rr,s_rb,s_bb,nis,detection";
    const std::string innovation = "1.5,cam,unknown,-1,-1,tentative,nan,nan,nan,nan,nan,nan,1";
    // As written before these columns came.
    folder.write("tracks.csv", "t,track,x,y,vx,vy,ax,ay" + covariance_names +
                                   ",existence,source_id\n1.5,4,1,2,3,4,5,6" + zeros + ",0.75,-1\n");
    folder.write("landmarks.csv",
                 "id,x,y,c_xx,c_xy,c_yy,seen,first_t,last_t,source_id\n3,7,8,1,0.5,2,12,1.5,1.5,-1\n");
    folder.write("innovations.csv", innovation_head + "\n" + innovation + "\n");
    const RunRecord old = readRun(folder.path());
    EXPECT_EQ(old.tracks.at(at(1.5)).at(0).moving, 1);
    EXPECT_EQ(old.landmarks.at(0).existence, 1);
    EXPECT_EQ(old.landmarks.at(0).moving, 0);
    EXPECT_EQ(old.innovations.at(0).innovation.outcome, Outcome::tentative);
    EXPECT_FALSE(old.innovations[0].log);

    folder.write("tracks.csv", "t,track,x,y,vx,vy,ax,ay" + covariance_names +
                                   ",existence,moving,source_id\n1.5,4,1,2,3,4,5,6" + zeros +
                                   ",0.75,0.625,-1\n");
    folder.write("landmarks.csv",
                 "id,x,y,c_xx,c_xy,c_yy,seen,first_t,last_t,existence,moving,source_id\n"
                 "3,7,8,1,0.5,2,12,1.5,1.5,0.875,0.125,-1\n");
    folder.write("innovations.csv", innovation_head + ",log_number,log_count\n" + innovation + ",-1,6\n");
    const RunRecord run = readRun(folder.path());
    EXPECT_EQ(run.tracks.at(at(1.5)).at(0).moving, 0.625);
    EXPECT_EQ(run.landmarks.at(0).existence, 0.875);
    EXPECT_EQ(run.landmarks.at(0).moving, 0.125);
    ASSERT_TRUE(run.innovations.at(0).log);
    EXPECT_EQ(run.innovations[0].log->number, -1);
    EXPECT_EQ(run.innovations[0].log->count, 6);
}

TEST(ReadRun, OnlyTheTrajectoryMustBeThere) {
    const TemporaryFolder folder;
    EXPECT_THAT(messageOf([&] { readRun(folder.path()); }), HasSubstr("trajectory.csv"));
    folder.write("trajectory.csv", std::string(trajectory_head) + "0,0,0,0,0,0,0,0,0,0\n");
    const RunRecord run = readRun(folder.path());
    EXPECT_EQ(run.trajectory.size(), 1u);
    EXPECT_TRUE(run.tracks.empty() && run.landmarks.empty() && run.innovations.empty());
}

TEST(ReadRun, ALineThatACrashCutOffEndsTheTable) {
    const TemporaryFolder folder;
    folder.write("trajectory.csv", std::string(trajectory_head) + "0,0,0,0,0,0,0,0,0,0\n1,0,0");
    EXPECT_EQ(readRun(folder.path()).trajectory.size(), 1u);
}

TEST(ReadRun, BadRowsAreNamed) {
    const TemporaryFolder folder;
    folder.write("trajectory.csv",
                 std::string(trajectory_head) + "0,0,0,0,0,0,0,0,0,0\n1,nan,0,0,0,0,0,0,0,0\n");
    EXPECT_THAT(messageOf([&] { readRun(folder.path()); }),
                AllOf(HasSubstr("trajectory.csv"), HasSubstr("3"), HasSubstr("finite number")));
    folder.write("trajectory.csv",
                 std::string(trajectory_head) + "1,0,0,0,0,0,0,0,0,0\n1,0,0,0,0,0,0,0,0,0\n");
    EXPECT_THAT(messageOf([&] { readRun(folder.path()); }), HasSubstr("a time after the row before"));
    folder.write("trajectory.csv", std::string(trajectory_head) + "1,0,0,0,0,0,0,0,0,0\n");
    folder.write("innovations.csv",
                 "t,sensor,kind,landmark,track,outcome,r_range,r_bearing,s_rr,s_rb,s_bb,nis\n"
                 "1,cam,mover,-1,4,lost,0,0,1,0,1,0\n");
    EXPECT_THAT(messageOf([&] { readRun(folder.path()); }),
                HasSubstr("one of updated, inflated, rejected, initiated, tentative, ignored"));
}

TEST(ReadTum, ReadsYawAndExactStamps) {
    const TemporaryFolder folder;
    // Yaw 2 atan2(0.6, 0.8); then a half turn. Comments and exponents occur in the wild.
    const RunRecord run = readTum(folder.write(
        "a.tum",
        "# t x y z qx qy qz qw\n1400000000.1234567 1 2 3 0 0 0.6 0.8\n1.4000000005e9 4 5 6 0 0 1 0\n"));
    ASSERT_EQ(run.trajectory.size(), 2u);
    EXPECT_EQ(run.trajectory[0].stamp.ticks, 14'000'000'001'234'567);
    EXPECT_NEAR(run.trajectory[0].robot.mean.theta, 2 * std::atan2(0.6, 0.8), 1e-14);
    EXPECT_EQ(run.trajectory[1].stamp, at(1400000000.5));
    EXPECT_NEAR(run.trajectory[1].robot.mean.theta, pi, 1e-14);
    EXPECT_TRUE(run.trajectory[0].robot.covariance.isZero());
}

TEST(ReadTum, ProjectsATiltedFrameToThePlane) {
    // A half turn about (0.6, 0.8, 0) takes the x axis to 2 (0.6) (0.6, 0.8, 0) - (1, 0, 0) = (-0.28, 0.96,
    // 0).
    const TemporaryFolder folder;
    const RunRecord run = readTum(folder.write("c.tum", "1 0 0 0 0.6 0.8 0 0\n"));
    EXPECT_NEAR(run.trajectory.at(0).robot.mean.theta, std::atan2(0.96, -0.28), 1e-14);
}

TEST(ReadTum, RefusesWithASentence) {
    const TemporaryFolder folder;
    const auto refuse = [&](const std::string& text) {
        const std::string file = folder.write("b.tum", text);
        return messageOf([&] { readTum(file); });
    };
    EXPECT_THAT(refuse("1 2 3\n"), HasSubstr("line 1: 3 numbers, expected the 8"));
    EXPECT_THAT(refuse("1 0 0 0 0 0 0 1\n2 0 x 0 0 0 0 1\n"),
                HasSubstr("line 2: 'x', expected a finite number"));
    EXPECT_THAT(refuse("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
                HasSubstr("line 2: time 1, expected one after"));
    EXPECT_THAT(refuse("1400000000123456789 0 0 0 0 0 0 1\n"), HasSubstr("nanoseconds; expected seconds"));
    EXPECT_THAT(refuse("1 0 0 0 0 0 0 0\n"), HasSubstr("unit quaternion"));
    EXPECT_THAT(refuse("# nothing\n"), HasSubstr("no rows"));
    EXPECT_THAT(messageOf([] { readTum("/no/such/file.tum"); }), HasSubstr("cannot be opened"));
}

}  // namespace run_record_test
}  // namespace slamot::eval
