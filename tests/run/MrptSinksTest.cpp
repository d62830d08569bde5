// Files that MRPT's own programs open: read here with MRPT's own readers.
#include <gmock/gmock.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CLandmarksMap.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/COpenGLViewport.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/serialization/CArchive.h>

#include <Eigen/LU>
#include <cstring>

#include "run/Spy.h"
#include "slamot/run/MrptSinks.h"

namespace slamot::test {
namespace mrpt_sinks_test {

namespace fs = std::filesystem;

class MrptSinksTest : public FolderTest {
  protected:
    static LandmarkEstimate landmark(std::int64_t id, std::int64_t source, double x, double y) {
        LandmarkEstimate l;
        l.id = {id};
        l.source = {source};
        l.mean = {x, y};
        l.covariance << 0.25, 0.125, 0.125, 0.5;
        l.seen = 3;
        l.first_seen = at(1);
        l.last_seen = at(2);
        return l;
    }
    static run::Step step(double t) {
        run::Step out;
        out.estimate.stamp = at(t);
        out.estimate.robot.mean = {t, 2 * t, 0.5};
        out.estimate.robot.covariance << 1, 2, 3, 2, 5, 6, 3, 6, 9;
        out.has_detections = true;
        TrackEstimate track;
        track.id = {4};
        track.mean << 7, 8, 0, 2, 0, 0;
        track.covariance = Matrix6::Identity();
        out.estimate.tracks = {track};
        return out;
    }
};

TEST_F(MrptSinksTest, TheLandmarkMapLoadsAgain) {
    run::RunEnd end;
    end.landmarks = {landmark(0, 17, 1.5, -2.5), landmark(1, -1, 3, 4)};
    run::LandmarkMapSink(folder).end(end);

    mrpt::maps::CLandmarksMap map;
    mrpt::io::CFileGZInputStream in(path("map.landmarks.gz"));
    mrpt::serialization::archiveFrom(in) >> map;
    ASSERT_EQ(map.landmarks.size(), 2u);
    const auto* first = map.landmarks.get(0);
    EXPECT_EQ(first->pose_mean.x, 1.5f);
    EXPECT_EQ(first->pose_mean.y, -2.5f);
    EXPECT_EQ(first->pose_cov_11, 0.25f);
    EXPECT_EQ(first->pose_cov_12, 0.125f);
    EXPECT_EQ(first->pose_cov_22, 0.5f);
    EXPECT_EQ(first->ID, 17);  // the log's name where it gives one
    EXPECT_EQ(map.landmarks.get(1)->ID, 1);
    EXPECT_EQ(toStamp(first->timestampLastSeen), at(2));
    EXPECT_FALSE(fs::exists(path("map.landmarks.gz.part")));
}

TEST_F(MrptSinksTest, TheSceneLoadsAgain) {
    run::SceneSink sink(folder);
    for (int t = 1; t < 5; ++t) sink.step(step(t));
    run::RunEnd end;
    end.estimate = step(5).estimate;
    end.landmarks = {landmark(0, 17, 1.5, -2.5), landmark(1, -1, 3, 4)};
    sink.end(end);
    mrpt::opengl::COpenGLScene scene;
    ASSERT_TRUE(scene.loadFromFile(path("scene.3Dscene")));
    // Ground, robot's path, one track's path, two landmarks, the robot's ellipse and the robot.
    const auto viewport = scene.getViewport();
    ASSERT_TRUE(viewport);
    EXPECT_EQ(std::distance(viewport->begin(), viewport->end()), 7);
    // Ellipses lie at three standard deviations: (p - m)^t P^-1 (p - m) = 9.
    int outlines = 0;
    Matrix2 P;
    P << 0.25, 0.125, 0.125, 0.5;
    for (const auto& object : *viewport) {
        const auto lines = std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(object);
        if (!lines || lines->getLineCount() != 30) continue;
        const Vector2 mean = outlines == 0 ? Vector2(1.5, -2.5) : Vector2(3, 4);
        if (++outlines > 2) continue;  // the robot's
        for (const auto& line : *lines) {
            const Vector2 d = Vector2(line.point1.x, line.point1.y) - mean;
            EXPECT_NEAR(d.dot(P.inverse() * d), 9, 1e-4);  // MRPT keeps single precision in files
        }
    }
    EXPECT_EQ(outlines, 3);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1)
        << "nothing is left beside it";
}

TEST_F(MrptSinksTest, ASceneOfNothingLoadsToo) {
    run::SceneSink(folder).end({});
    EXPECT_TRUE(mrpt::opengl::COpenGLScene().loadFromFile(path("scene.3Dscene")));
}

TEST_F(MrptSinksTest, TheEstimateLogHasTheInputAndThePoses) {
    run::EstimateLogSink sink(folder);
    sink.observation(*odometry(1, {1, 0, 0}));
    sink.observation(*detections(1, "landmarks", {{3, 0}}));
    sink.step(step(1));
    run::Step prediction = step(2);
    prediction.has_detections = false;
    sink.step(prediction);  // adds nothing
    sink.end({});

    RawlogReader reader(path("estimate.rawlog"), {});
    std::vector<std::string> labels;
    std::shared_ptr<mrpt::obs::CObservationRobotPose> robot, track;
    while (const auto entry = reader.next()) {
        labels.push_back(entry->observation->sensorLabel);
        if (labels.back() == "slamot_robot")
            robot = std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(entry->observation);
        if (labels.back() == "slamot_track_4")
            track = std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(entry->observation);
    }
    EXPECT_EQ(reader.end(), LogEnd::clean);
    EXPECT_THAT(labels, testing::ElementsAre("odometry", "landmarks", "slamot_robot", "slamot_track_4"));
    ASSERT_TRUE(robot);
    ASSERT_TRUE(track);
    EXPECT_EQ(toStamp(robot->timestamp), at(1));
    EXPECT_EQ(robot->pose.mean.y(), 2);
    EXPECT_DOUBLE_EQ(robot->pose.mean.yaw(), 0.5);
    EXPECT_EQ(robot->pose.cov(0, 3), 3);  // x with yaw
    EXPECT_EQ(robot->pose.cov(3, 3), 9);
    EXPECT_EQ(robot->pose.cov(2, 2), 0);  // planar
    EXPECT_EQ(track->pose.mean.x(), 7);
    EXPECT_DOUBLE_EQ(track->pose.mean.yaw(), pi / 2);  // along its velocity (0, 2)
    EXPECT_EQ(checkChecksum(path("estimate.rawlog")), Checksum::matches);
}

/// Knows a joint covariance.
class Correlated : public Spy {
  public:
    explicit Correlated(Eigen::MatrixXd P) : P_(std::move(P)) {}

  protected:
    JointCovariance onJointCovariance() const override { return {{}, {}, P_}; }

  private:
    Eigen::MatrixXd P_;
};

struct CorrelationFile {
    std::string magic;
    std::uint32_t version = 0, dimension = 0, rows = 0;
    std::vector<float> cells;
};

CorrelationFile readCorrelation(const std::string& bytes) {
    CorrelationFile file;
    file.magic = bytes.substr(0, 8);
    std::uint32_t header[3];
    std::memcpy(header, bytes.data() + 8, sizeof header);
    file.version = header[0];
    file.dimension = header[1];
    file.rows = header[2];
    file.cells.resize((bytes.size() - 20) / sizeof(float));
    std::memcpy(file.cells.data(), bytes.data() + 20, file.cells.size() * sizeof(float));
    return file;
}

TEST_F(MrptSinksTest, TheCorrelationFile) {
    Eigen::Matrix3d P;
    P << 4, 3, 0, 3, 9, 0, 0, 0, 0;  // the third is known exactly
    const Correlated estimator(P);
    run::RunEnd end;
    end.estimator = &estimator;
    run::CorrelationSink(folder).end(end);
    const CorrelationFile file = readCorrelation(textOf(path("correlation.bin")));
    EXPECT_EQ(file.magic, "SLAMCORR");
    EXPECT_EQ(file.version, 1u);
    EXPECT_EQ(file.dimension, 3u);
    EXPECT_EQ(file.rows, 3u);
    EXPECT_THAT(file.cells, testing::ElementsAre(1, 0.5f, 0, 0.5f, 1, 0, 0, 0, 0));  // 3 / (2 * 3)
}

TEST_F(MrptSinksTest, ALargeCorrelationKeepsTheStrongestValueOfEachCell) {
    constexpr int n = 1024;  // two rows and columns to a cell
    Eigen::MatrixXd P = Eigen::MatrixXd::Identity(n, n);
    P(3, 1000) = P(1000, 3) = -0.5;
    P(2, 1001) = P(1001, 2) = 0.25;
    const Correlated estimator(P);
    run::RunEnd end;
    end.estimator = &estimator;
    run::CorrelationSink(folder).end(end);
    const CorrelationFile file = readCorrelation(textOf(path("correlation.bin")));
    EXPECT_EQ(file.dimension, 1024u);
    EXPECT_EQ(file.rows, 512u);
    ASSERT_EQ(file.cells.size(), 512u * 512u);
    EXPECT_EQ(file.cells[1 * 512 + 500], -0.5f);
    EXPECT_EQ(file.cells[500 * 512 + 1], -0.5f);
    EXPECT_EQ(file.cells[0], 1.0f);
    EXPECT_EQ(file.cells[1], 0.0f);
}

TEST_F(MrptSinksTest, WithoutAJointCovarianceThereIsNoCorrelationFile) {
    const Spy estimator;
    run::RunEnd end;
    end.estimator = &estimator;
    run::CorrelationSink(folder).end(end);
    EXPECT_FALSE(fs::exists(path("correlation.bin")));
}

TEST_F(MrptSinksTest, FilesThatCannotBeWrittenAreErrors) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
    const Correlated estimator(Eigen::MatrixXd::Identity(64, 64));
    run::RunEnd end;
    end.estimator = &estimator;
    for (int i = 0; i < 4000; ++i) end.landmarks.push_back(landmark(i, i, 0.37 * i, 1.0 / (i + 1)));
    fs::create_symlink("/dev/full", path("map.landmarks.gz.part"));
    EXPECT_ANY_THROW(run::LandmarkMapSink(folder).end(end));
    fs::create_symlink("/dev/full", path("correlation.bin.part"));
    EXPECT_ANY_THROW(run::CorrelationSink(folder).end(end));
    EXPECT_FALSE(fs::exists(path("map.landmarks.gz")));
    EXPECT_FALSE(fs::exists(path("correlation.bin")));
}

}  // namespace mrpt_sinks_test
}  // namespace slamot::test
