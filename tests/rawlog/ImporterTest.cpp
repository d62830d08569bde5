#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

#include "rawlog/TestLogs.h"
#include "slamot/core/config/Config.h"
#include "slamot/rawlog/Importer.h"
#include "slamot/rawlog/LogCheck.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/Truth.h"

namespace slamot::test {
namespace importer_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Import : public RawlogTest {
  protected:
    ImportResult import(const std::string& format, const std::string& in, const std::string& out) {
        for (const auto& importer : importers())
            if (importer.format == format) return importer.run(path(in), path(out), {});
        throw std::logic_error("no importer " + format);
    }
    std::string messageOf(const std::string& format) {
        try {
            import(format, "in", "out");
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "no error";
    }
    void file(const std::string& name, const std::string& text) {
        std::filesystem::create_directories(path("in"));
        writeBytes(path("in/" + name), text);
    }
};

std::vector<OdometryReading> odometryOf(const ReadLog& log) {
    std::vector<OdometryReading> readings;
    for (const auto& entry : log.entries)
        if (const auto* o = dynamic_cast<const mrpt::obs::CObservationOdometry*>(entry.observation.get()))
            readings.push_back(fromMrpt(*o));
    return readings;
}

std::vector<RangeBearingReading> detectionsOf(const ReadLog& log) {
    std::vector<RangeBearingReading> readings;
    for (const auto& entry : log.entries)
        if (const auto* o = dynamic_cast<const mrpt::obs::CObservationBearingRange*>(entry.observation.get()))
            readings.push_back(fromMrpt(*o));
    return readings;
}

class Mrclam : public Import {
  protected:
    /// Two robots (subjects 1 and 2, codes 5 and 14), one landmark (subject 6, code 63).
    void writeSet() {
        file("Barcodes.dat", "# Subject # Barcode #\n  1 \t 5\n 2 14\n 6 63\n");
        file("Landmark_Groundtruth.dat", "# comment\n 6 1.5 -2.5 0.1 0.1\n");
        // Straight for 2 s at 1 m/s, a quarter turn of radius 1 m, and a last command without an end.
        file("Robot1_Odometry.dat",
             "# t v w\n100.000 9 9\n100.000 1 0\n102.000 1.5707963267948966 1.5707963267948966\n103.000 5 "
             "5\n");
        file("Robot1_Measurement.dat",
             "# Subject\n101.000 14 3.0 0.1\n101.000 63 2.0 -0.1\n101.000 99 1.0 0.2\n101.5 5 1 0\n");
        file("Robot1_Groundtruth.dat", "100.000 0 0 0\n100.05 1 1 1\n101.000 2 2 2\n");
        file("Robot2_Odometry.dat", "100 0 0\n101 0 0\n");
        file("Robot2_Measurement.dat", "");
        file("Robot2_Groundtruth.dat", "100.000 7 8 0\n");
    }
};

TEST_F(Mrclam, CommandsBecomeOdometryOfTheIntervalThatEnded) {
    writeSet();
    import("mrclam", "in", "out");
    const auto odometry = odometryOf(readLog(path("out/robot_1.rawlog")));
    ASSERT_EQ(odometry.size(), 3u);
    EXPECT_EQ(odometry[0].stamp, Stamp::fromSeconds(100));
    EXPECT_EQ(odometry[0].pose.vector(), Vector3(0, 0, 0));
    EXPECT_EQ(odometry[1].stamp, Stamp::fromSeconds(102));
    EXPECT_EQ(odometry[1].velocity->vx, 1);  // the later of the two commands at t = 100
    EXPECT_EQ(odometry[1].pose.x, 2);
    // A quarter turn of radius v / w = 1 m from (2, 0): to (3, 1), heading pi / 2.
    EXPECT_NEAR(odometry[2].pose.x, 3, 1e-15);
    EXPECT_NEAR(odometry[2].pose.y, 1, 1e-15);
    EXPECT_NEAR(odometry[2].pose.theta, pi / 2, 1e-15);
    EXPECT_EQ(odometry[2].velocity->omega, pi / 2);
}

TEST_F(Mrclam, CodesBecomeLandmarksMoversAndUnknown) {
    writeSet();
    const ImportResult result = import("mrclam", "in", "out");
    const auto readings = detectionsOf(readLog(path("out/robot_1.rawlog")));
    ASSERT_EQ(readings.size(), 2u);  // the robot's own code is dropped
    EXPECT_EQ(readings[0].sensor.label, "landmarks");
    ASSERT_EQ(readings[0].items.size(), 2u);
    EXPECT_EQ(readings[0].items[0].id, SourceId{6});
    EXPECT_EQ(readings[0].items[0].range, 2.0);
    EXPECT_FALSE(readings[0].items[1].id.valid());
    EXPECT_EQ(readings[1].sensor.label, "movers");
    EXPECT_EQ(readings[1].items.at(0).id, SourceId{1'000'002});
    EXPECT_EQ(readings[1].items[0].bearing, 0.1f);
    EXPECT_NEAR(std::sqrt(readings[1].items[0].covariance(0, 0)), 0.15, 1e-8);  // a float's precision
    EXPECT_THAT(result.notes.at(0), HasSubstr("1 detections of landmarks, 1 of robots, 1 of unknown codes"));
    EXPECT_THAT(result.notes.at(0), HasSubstr("1 of itself"));
}

TEST_F(Mrclam, TruthHasTheOtherRobotsAsTargets) {
    writeSet();
    import("mrclam", "in", "out");
    const Truth truth = readTruth(path("out/robot_1.truth"));
    EXPECT_EQ(truth.robot.size(), 3u);
    ASSERT_EQ(truth.targets.size(), 1u);
    EXPECT_EQ(truth.targets.at(SourceId{1'000'002}).at(0).position, Vector2(7, 8));
    EXPECT_EQ(truth.landmarks.at(SourceId{6}), Vector2(1.5, -2.5));
    // In the log's order: landmark 6, the unknown code, robot 2.
    ASSERT_EQ(truth.associations.size(), 3u);
    EXPECT_EQ(truth.associations[0].kind, "landmark");
    EXPECT_EQ(truth.associations[1].kind, "clutter");
    EXPECT_EQ(truth.associations[2].kind, "mover");
    EXPECT_EQ(truth.associations[2].index, 2);
    EXPECT_EQ(truth.associations[2].id, SourceId{1'000'002});
}

TEST_F(Mrclam, BadTablesAreNamed) {
    EXPECT_THAT(messageOf("mrclam"), HasSubstr("Barcodes.dat"));
    writeSet();
    file("Robot1_Odometry.dat", "100 1 0\n99 1 0\n");
    EXPECT_THAT(messageOf("mrclam"), AllOf(HasSubstr("Robot1_Odometry.dat"), HasSubstr("goes back")));
    file("Robot1_Odometry.dat", "100 1 nan\n");
    EXPECT_THAT(messageOf("mrclam"), AllOf(HasSubstr("Robot1_Odometry.dat:1"), HasSubstr("field 3")));
    file("Robot1_Odometry.dat", "100 1\n");
    EXPECT_THAT(messageOf("mrclam"), HasSubstr("has 2 fields"));
}

TEST_F(Mrclam, Set6) {
    const char* named = std::getenv("SLAMOT_DATASETS");
    const std::filesystem::path datasets = named ? named : SLAMOT_SOURCE_DIR "/../shared/datasets";
    if (!std::filesystem::exists(datasets / "mrclam_6"))
        GTEST_SKIP() << datasets / "mrclam_6"
                     << " is absent: set SLAMOT_DATASETS";
    for (const auto& importer : importers())
        if (importer.format == "mrclam") importer.run((datasets / "mrclam_6").string(), path("out"), {});
    // Counted in the files: readings by code, distinct times of odometry.
    struct {
        std::int64_t odometry, detections, movers, unknown;
    } const expected[] = {{61785, 1942, 407, 1},
                          {65004, 4031, 792, 0},
                          {61150, 5627, 1277, 2},
                          {52906, 2399, 373, 3},
                          {60563, 5378, 1139, 0}};
    for (int k = 1; k <= 5; ++k) {
        const LogSummary log = summarise(path("out/robot_" + std::to_string(k) + ".rawlog"), {});
        const auto& row = expected[k - 1];
        ASSERT_EQ(log.sensors.size(), 3u);
        EXPECT_EQ(log.end, LogEnd::clean);
        EXPECT_EQ(log.drops.total(), 0);
        const auto &landmarks = log.sensors[0], &movers = log.sensors[1], &odometry = log.sensors[2];
        EXPECT_EQ(odometry.count, row.odometry) << k;
        EXPECT_TRUE(odometry.has_velocities);
        EXPECT_EQ(landmarks.detections + movers.detections, row.detections) << k;
        EXPECT_EQ(movers.detections, row.movers) << k;
        EXPECT_EQ(landmarks.detections - landmarks.identified, row.unknown) << k;
    }
    const Truth truth = readTruth(path("out/robot_1.truth"));
    EXPECT_EQ(truth.robot.size(), 49241u);
    EXPECT_EQ(truth.landmarks.size(), 15u);
    EXPECT_EQ(truth.targets.size(), 4u);
    EXPECT_EQ(truth.associations.size(), 1942u);
}

class CsvImport : public Import {
  protected:
    void writeSmall(const std::string& vehicle) {
        file("sensor.ini",
             "[sensor]\nrange_std = 0.5\nbearing_std_deg = 3\nmax_range = 100\n"
             "field_of_view_deg = 180\n[vehicle]\n" +
                 vehicle);
        file("observations.csv",
             "t,kind,id,range,bearing\n0.15,mover,2,10,0.5\n0.15,landmark,7,20,-0.5\n"
             "0.15,landmark,,nan,0\n");
    }
};

TEST_F(CsvImport, SteeredOdometryIsWrittenAsBodyVelocity) {
    writeSmall("model = steered\nwheelbase = 4\n");
    file("odometry.csv", "t,v,gamma,omega\n0,0,0,\n0.15,10,0.5,\n");
    import("csv", "in", "a.rawlog");
    const ReadLog log = readLog(path("a.rawlog"));
    const auto odometry = odometryOf(log);
    ASSERT_EQ(odometry.size(), 2u);
    EXPECT_EQ(odometry[1].velocity->vx, 10 * std::cos(0.5));
    EXPECT_EQ(odometry[1].velocity->vy, 10 * std::sin(0.5));
    EXPECT_EQ(odometry[1].velocity->omega, 10 * std::sin(0.5) / 4);
    const auto readings = detectionsOf(log);
    ASSERT_EQ(readings.size(), 2u);
    EXPECT_EQ(readings[0].sensor.label, "landmarks");
    EXPECT_EQ(readings[0].items.size(), 2u);
    EXPECT_TRUE(std::isnan(readings[0].items[1].range));
    EXPECT_EQ(readings[0].sensor.max_range, 100);
    EXPECT_NEAR(readings[0].sensor.field_of_view, pi, 1e-6);  // a float's precision
    EXPECT_NEAR(readings[0].items[0].covariance(1, 1), std::pow(radians(3), 2), 1e-9);
    EXPECT_EQ(readings[1].items.at(0).id, SourceId{2});
}

TEST_F(CsvImport, DifferentialOdometryNeedsNoGamma) {
    writeSmall("model = differential\n");
    file("odometry.csv", "t,v,omega\n0,0,0\n0.5,2,0\n");
    import("csv", "in", "a.rawlog");
    EXPECT_EQ(odometryOf(readLog(path("a.rawlog")))[1].pose.vector(), Vector3(1, 0, 0));
}

TEST_F(CsvImport, PosesGoThrough) {
    writeSmall("");
    file("odometry.csv", "t,x,y,theta\n0,1,2,3\n");
    import("csv", "in", "a.rawlog");
    const auto odometry = odometryOf(readLog(path("a.rawlog")));
    EXPECT_EQ(odometry.at(0).pose.vector(), Vector3(1, 2, 3));
    EXPECT_FALSE(odometry[0].velocity);
}

TEST_F(CsvImport, AssociationsFollowTheOrderOfTheLog) {
    writeSmall("");
    file("odometry.csv", "t,x,y,theta\n0,1,2,3\n");
    // Rows of observations.csv at 0.15: mover (0), landmark (1), landmark (2). In the log landmarks come
    // first.
    file("associations.csv", "t,index,kind,id\n0.15,0,mover,2\n0.15,1,landmark,7\n0.15,2,clutter,-1\n");
    import("csv", "in", "a.rawlog");
    const Truth truth = readTruth(path("a.truth"));
    ASSERT_EQ(truth.associations.size(), 3u);
    EXPECT_EQ(truth.associations[0].kind, "landmark");
    EXPECT_EQ(truth.associations[1].kind, "clutter");
    EXPECT_EQ(truth.associations[2].kind, "mover");
    EXPECT_EQ(truth.associations[2].index, 2);
}

TEST_F(CsvImport, MistakesAreNamed) {
    EXPECT_THAT(messageOf("csv"), HasSubstr("no folder"));
    writeSmall("model = steered\n");
    file("odometry.csv", "t,v,gamma\n0,0,0\n0,1,0\n");
    EXPECT_THAT(messageOf("csv"), AllOf(HasSubstr("odometry.csv:3"), HasSubstr("later")));
    file("odometry.csv", "t,v,gamma\n0,1,0\n1,1");  // cut off
    EXPECT_THAT(messageOf("csv"), AllOf(HasSubstr("odometry.csv:3"), HasSubstr("2 fields")));
    file("odometry.csv", "t,v,gamma\n0,1,\n");
    EXPECT_THAT(messageOf("csv"), AllOf(HasSubstr("odometry.csv:2"), HasSubstr("gamma")));
    file("odometry.csv", "t,v,gamma\n0,1,1.6\n");
    EXPECT_THAT(messageOf("csv"), HasSubstr("quarter turn"));
    file("odometry.csv", "t,v,gamma\n0,1,0\n");
    file("observations.csv", "t,kind,id,range,bearing\n0,tree,1,1,1\n");
    EXPECT_THAT(messageOf("csv"),
                AllOf(HasSubstr("observations.csv:2"), HasSubstr("landmark, mover or unknown")));
    writeSmall("modell = steered\n");
    EXPECT_THAT(messageOf("csv"), HasSubstr("modell"));
    file("sensor.ini", "[sensor]\nrange_std = 1\n");
    EXPECT_THAT(messageOf("csv"), HasSubstr("bearing_std_deg"));
}

}  // namespace importer_test
}  // namespace slamot::test
