#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

#include "rawlog/TestLogs.h"
#include "slamot/rawlog/Importer.h"
#include "slamot/rawlog/LogCheck.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/Truth.h"

namespace slamot::test {
namespace victoria_park_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

ImportResult importPark(const std::string& in, const std::string& out) {
    for (const auto& importer : importers())
        if (importer.format == "victoria-park") return importer.run(in, out, {});
    throw std::logic_error("no importer victoria-park");
}

/// Four speeds over 3 s, five scans of which one is empty, six fixes of which one is wild.
class VictoriaPark : public RawlogTest {
  protected:
    void file(const std::string& name, const std::string& text) {
        std::filesystem::create_directories(path("in"));
        writeBytes(path("in/" + name), text);
    }
    void writeSet() {
        file("inputs.dat", "  1.000  0.000 -0.0035\n 2.000 2.000 0.000\n 3.000 2.000 0.5\n 4.000 0 0\n");
        file("measurements.dat",
             "  0.900  9 1.57 0.3\n"
             "  2.000  10.0 1.5707963267948966 0.3\n  2.000  20.0 0.5 0.4\n"
             "  3.000  8.0 1.5707963267948966 0.3\n  4.000 5.0 2.0 1\n");
        file("Sensors_manager.txt", "0.9 3 1\n1.0 1 1\n2.0 3 2\n2.5 3 3\n3.0 3 4\n4.0 3 5\n");
        file("gps.dat", "1.0 0 0\n1.2 0.5 0\n1.4 1 0\n1.6 100 0\n1.8 2 0\n3.0 4 1\n");
    }
    ImportResult import() { return importPark(path("in"), path("a.rawlog")); }
    std::string message() {
        try {
            import();
        } catch (const LogError& error) {
            return error.what();
        }
        return "no error";
    }
    std::vector<RangeBearingReading> scans() {
        std::vector<RangeBearingReading> readings;
        for (const auto& entry : readLog(path("a.rawlog")).entries)
            if (const auto* o =
                    dynamic_cast<const mrpt::obs::CObservationBearingRange*>(entry.observation.get()))
                readings.push_back(fromMrpt(*o));
        return readings;
    }
};

TEST_F(VictoriaPark, OdometryIsThatOfTheRearAxle) {
    writeSet();
    import();
    std::vector<OdometryReading> odometry;
    for (const auto& entry : readLog(path("a.rawlog")).entries)
        if (const auto* o = dynamic_cast<const mrpt::obs::CObservationOdometry*>(entry.observation.get()))
            odometry.push_back(fromMrpt(*o));
    ASSERT_EQ(odometry.size(), 4u);
    EXPECT_EQ(odometry[0].pose.vector(), Vector3(0, 0, 0));
    // Straight on at the wheel's speed for the second that ends at 2 s.
    EXPECT_EQ(odometry[1].stamp, Stamp::fromSeconds(2));
    EXPECT_EQ(odometry[1].velocity->vx, 2);
    EXPECT_EQ(odometry[1].pose.vector(), Vector3(2, 0, 0));
    // Turning left about a point L / tan(0.5) to the left of the axle's middle, the left wheel 0.76 m nearer
    // to it at 2 m/s: the middle moves faster by the ratio of the two.
    const double radius = 2.83 / std::tan(0.5), omega = 2 / (radius - 0.76);
    EXPECT_NEAR(odometry[2].velocity->omega, omega, 1e-12);
    EXPECT_NEAR(odometry[2].velocity->vx, omega * radius, 1e-12);
    EXPECT_EQ(odometry[2].velocity->vy, 0);
    EXPECT_NEAR(odometry[2].pose.theta, omega, 1e-12);
    EXPECT_NEAR(odometry[2].pose.x, 2 + radius * std::sin(omega), 1e-12);
    EXPECT_NEAR(odometry[2].pose.y, radius * (1 - std::cos(omega)), 1e-12);
}

TEST_F(VictoriaPark, ScansLookAheadAndAroundAndMayBeEmpty) {
    writeSet();
    const ImportResult result = import();
    const auto readings = scans();
    ASSERT_EQ(readings.size(), 5u);
    EXPECT_EQ(readings[0].stamp, Stamp::fromSeconds(0.9));
    ASSERT_EQ(readings[1].items.size(), 2u);
    EXPECT_EQ(readings[1].items[0].range, 10);
    EXPECT_NEAR(readings[1].items[0].bearing, 0, 1e-7);  // a float's precision
    EXPECT_NEAR(readings[1].items[1].bearing, 0.5 - pi / 2, 1e-7);
    EXPECT_FALSE(readings[1].items[0].id.valid());
    EXPECT_EQ(readings[1].sensor.label, "landmarks");
    EXPECT_NEAR(readings[1].sensor.pose.x, 3.78, 1e-12);
    EXPECT_NEAR(readings[1].sensor.pose.y, 0.5, 1e-12);
    EXPECT_NEAR(readings[1].sensor.field_of_view, pi, 1e-6);
    EXPECT_EQ(readings[1].sensor.max_range, 80);
    EXPECT_EQ(readings[2].stamp, Stamp::fromSeconds(2.5));
    EXPECT_TRUE(readings[2].items.empty());
    EXPECT_THAT(result.notes.at(0), HasSubstr("5 scans with 5 detections, 1 of the scans empty"));
    EXPECT_THAT(result.notes.at(2), HasSubstr("no isam_associations.txt"));
    std::filesystem::remove(path("in/Sensors_manager.txt"));
    import();
    EXPECT_EQ(scans().size(), 4u);
}

TEST_F(VictoriaPark, GpsIsWeakTruthWithoutHeadingsAndWildFixes) {
    writeSet();
    const ImportResult result = import();
    const Truth truth = readTruth(path("a.truth"));
    ASSERT_EQ(truth.robot.size(), 5u);  // but 100 m at 1.6 s
    EXPECT_TRUE(std::isnan(truth.robot[0].pose.theta));
    EXPECT_THAT(result.notes.at(1), HasSubstr("5 GPS fixes as weak truth, 1 wild ones left out (t = 1.6"));
    // Between fixes 0.2 s apart there is truth, across the 0.4 s around the wild one there is none.
    EXPECT_NEAR(truth.pointAt(Stamp::fromSeconds(1.1))->x, 0.25, 1e-12);
    EXPECT_FALSE(truth.pointAt(Stamp::fromSeconds(1.5)));
    EXPECT_FALSE(truth.pointAt(Stamp::fromSeconds(2)));
    EXPECT_EQ(truth.point, Vector2(3.78, 0.5));
    EXPECT_TRUE(truth.associations.empty());
}

TEST_F(VictoriaPark, AJumpThatStaysIsNoWildFix) {
    writeSet();
    file("gps.dat", "1.0 0 0\n1.2 0.5 0\n1.4 50 0\n1.6 51 0\n");
    import();
    EXPECT_EQ(readTruth(path("a.truth")).robot.size(), 4u);
}

TEST_F(VictoriaPark, IsamsLandmarkObservationsLabelDetectionsAtTheirPlace) {
    writeSet();
    // Ways between the scans at 0.9, 2.0, 2.5, 3.0 and 4.0 s, odometry before each: to (2, 0), none (not in
    // the graph), the arc, none. Landmarks in the axle's frame: 10 m ahead of the laser at 2 s is (13.78,
    // 0.5).
    const double radius = 2.83 / std::tan(0.5), angle = 2 / (radius - 0.76);
    const std::string arc = std::to_string(radius * std::sin(angle)) + " " +
                            std::to_string(radius * (1 - std::cos(angle))) + " " + std::to_string(angle);
    file("isam_associations.txt",
         "ODOMETRY 0 1 2 0 0 0.0001 0 0 4e-06 0 4e-06\n"
         "LANDMARK 1 7 13.9 0.4 0.4 0 0.4\n"   // 0.16 m off
         "LANDMARK 1 8 13.78 1.1 0.4 0 0.4\n"  // 0.6 m off, and the detection has its label
         "ODOMETRY 1 2 " +
             arc +
             " 0.0001 0 0 4e-06 0 4e-06\n"
             "LANDMARK 2 7 11.78 0.5 0.4 0 0.4\n");
    const ImportResult result = import();
    const auto readings = scans();
    EXPECT_EQ(readings[1].items[0].id, SourceId{7});
    EXPECT_FALSE(readings[1].items[1].id.valid());
    EXPECT_EQ(readings[3].items[0].id, SourceId{7});
    EXPECT_THAT(result.notes.at(2), HasSubstr("2 of the 3 landmark observations"));
    const Truth truth = readTruth(path("a.truth"));
    ASSERT_EQ(truth.associations.size(), 2u);
    EXPECT_EQ(truth.associations[1].stamp, Stamp::fromSeconds(3));
    EXPECT_EQ(truth.associations[1].index, 0);
    EXPECT_EQ(truth.associations[1].kind, "landmark");
    EXPECT_EQ(truth.associations[1].id, SourceId{7});
}

TEST_F(VictoriaPark, MistakesAreNamed) {
    EXPECT_THAT(message(), AllOf(HasSubstr("inputs.dat"), HasSubstr("Victoria Park")));
    writeSet();
    file("inputs.dat", "1 0 0\n1 0 0\n");
    EXPECT_THAT(message(), AllOf(HasSubstr("inputs.dat:2"), HasSubstr("later")));
    file("inputs.dat", "1 0 1.2\n");
    EXPECT_THAT(message(), AllOf(HasSubstr("inputs.dat:1: field 3 is '1.2'"), HasSubstr("steering")));
    file("inputs.dat", "# nothing\n");
    EXPECT_THAT(message(), HasSubstr("no rows"));
    writeSet();
    file("measurements.dat", "1 5 1 0.1\n0.5 5 1 0.1\n");
    EXPECT_THAT(message(), AllOf(HasSubstr("measurements.dat:2"), HasSubstr("not before")));
    file("measurements.dat", "1 5 -0.1 0.1\n");
    EXPECT_THAT(message(), AllOf(HasSubstr("measurements.dat:1: field 3"), HasSubstr("0 to pi")));
    file("measurements.dat", "1 0 1 0.1\n");
    EXPECT_THAT(message(), AllOf(HasSubstr("measurements.dat:1: field 2"), HasSubstr("above 0")));
    file("measurements.dat", "1 2 1\n");
    EXPECT_THAT(message(), HasSubstr("has 3 fields, expected 4"));
    writeSet();
    file("gps.dat", "1 0 x\n");
    EXPECT_THAT(message(), AllOf(HasSubstr("gps.dat:1"), HasSubstr("finite number")));
    writeSet();
    // 3 m where the car drove 2: not this log's odometry.
    file("isam_associations.txt", "ODOMETRY 0 1 3 0 0 0 0 0 0 0 0\n");
    EXPECT_THAT(message(),
                AllOf(HasSubstr("isam_associations.txt:1: field 4"), HasSubstr("way from one scan")));
    file("isam_associations.txt", "LANDMARK 4 7 1 1 0 0 0\n");
    EXPECT_THAT(message(), HasSubstr("a pose that an ODOMETRY row"));
    file("isam_associations.txt", "EDGE 4 7 1 1 0 0 0\n");
    EXPECT_THAT(message(), HasSubstr("ODOMETRY or LANDMARK"));
    EXPECT_FALSE(std::filesystem::exists(path("a.rawlog")));
}

TEST_F(VictoriaPark, TheRealOne) {
    const char* named = std::getenv("SLAMOT_DATASETS");
    const std::filesystem::path datasets = named ? named : SLAMOT_SOURCE_DIR "/../shared/datasets";
    if (!std::filesystem::exists(datasets / "victoria_park"))
        GTEST_SKIP() << datasets / "victoria_park"
                     << " is absent: set SLAMOT_DATASETS";
    importPark((datasets / "victoria_park").string(), path("a.rawlog"));
    // Counted in the files: rows of inputs.dat and measurements.dat; 7230 times of measurements.dat and 19
    // laser rows of Sensors_manager.txt with none.
    const LogSummary log = summarise(path("a.rawlog"), {});
    ASSERT_EQ(log.sensors.size(), 2u);
    EXPECT_EQ(log.end, LogEnd::clean);
    EXPECT_EQ(log.drops.total(), 0);
    EXPECT_EQ(log.sensors[0].count, 7249);
    EXPECT_EQ(log.sensors[0].detections, 52974);
    EXPECT_EQ(log.sensors[0].identified, 2909);
    EXPECT_EQ(log.sensors[1].count, 61945);
    EXPECT_TRUE(log.sensors[1].has_velocities);
    const Truth truth = readTruth(path("a.truth"));
    EXPECT_EQ(truth.robot.size(), 4465u);  // of 4466 fixes
    EXPECT_EQ(truth.associations.size(), 2909u);
    EXPECT_FALSE(truth.pointAt(Stamp::fromSeconds(1223.284)));  // 141 m from the fix before
}

}  // namespace victoria_park_test
}  // namespace slamot::test
