// Paper 1's scenario against the traces of an independent implementation (tests/data/golden/paper1/README.md): fed
// with doubles, every printed number agrees to 1e-6.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "slamot/core/estimation/JointFilter.h"

namespace slamot {
namespace {

using Row = std::vector<double>;

std::vector<Row> readCsv(const std::string& name) {
    std::ifstream file(std::string(SLAMOT_SOURCE_DIR) + "/tests/data/golden/paper1/" + name);
    std::vector<Row> rows;
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
        Row row;
        std::istringstream fields(line);
        for (std::string field; std::getline(fields, field, ',');) row.push_back(std::stod(field));
        rows.push_back(row);
    }
    return rows;
}

constexpr double dt = 0.15;

Stamp stampOf(int step) {
    return Stamp::fromSeconds(step * dt);
}

/// config.json of the golden run.
JointFilter goldenFilter(Consistency consistency, JointEngine::Kind engine) {
    RobotMotionParameters motion;
    motion.model = RobotMotionModel::steered;
    motion.wheelbase = 4.0;
    motion.speed_std = 1.0;
    motion.steering_std = 0.25;

    JointFilterParameters parameters;
    parameters.consistency = consistency;
    parameters.engine.kind = engine;
    // Without a known range all of the map is within reach; with this one most of it is not.
    parameters.engine.active_set.range = 15;
    parameters.engine.active_set.keep_at_least = 5;
    parameters.outliers = OutlierTreatment::accept;
    parameters.target.kind = TargetModelKind::cv;
    parameters.target.noise_std = 0.1;
    parameters.target.noise_interval = 0;
    ModelChange change;
    change.after = 100 * dt;
    change.kind = TargetModelKind::ca;
    change.noise_std = 1.8;
    parameters.target_schedule = {change};
    parameters.target_velocity_std = 3.0;
    parameters.target_acceleration_std = 2.0;
    return {parameters, motion};
}

DetectionSet detectionsOf(int step, const std::vector<Row>& observations) {
    RangeBearingSet set;
    set.sensors.resize(1);
    for (const Row& row : observations) {
        if (static_cast<int>(row[0]) != step) continue;
        RangeBearingDetection detection;
        detection.kind = row[1] < 0 ? ObjectKind::mover : ObjectKind::landmark;
        detection.source = {row[1] < 0 ? 0 : static_cast<std::int64_t>(row[1])};
        detection.range = row[2];
        detection.bearing = row[3];
        detection.covariance = Vector2(0.1 * 0.1, 0.05 * 0.05).asDiagonal();
        set.detections.push_back(detection);
    }
    return {stampOf(step), set};
}

/// The traces are printed with twelve digits; the tolerance is the one their makers state.
void expectNear(double value, double expected, const std::string& what) {
    EXPECT_NEAR(value, expected, 1e-6 * std::max(1.0, std::abs(expected))) << what;
}

struct GoldenCase {
    Consistency consistency;
    const char* trace;
    JointEngine::Kind engine;
    const char* engine_name;
};

class GoldenRun : public testing::TestWithParam<GoldenCase> {};

TEST_P(GoldenRun, MatchesTheTrace) {
    const auto [consistency, name, engine, engine_name] = GetParam();
    const std::string stem = std::string("expect_ekf_true_mode_") + name;
    const auto truth = readCsv("truth.csv"), observations = readCsv("observations.csv"),
               expected = readCsv(stem + ".csv"), expected_map = readCsv(stem + "_map.csv");
    ASSERT_EQ(expected.size(), 201u);

    JointFilter filter = goldenFilter(consistency, engine);
    filter.start(stampOf(0), {});
    for (int k = 0; k <= 200; ++k) {
        if (k > 0) {
            OdometryIncrement odometry;
            odometry.t0 = stampOf(k - 1);
            odometry.t1 = stampOf(k);
            odometry.velocity = steeredToBody(truth[k][10], truth[k][11], 4.0);
            filter.predict(odometry);
        }
        filter.update(detectionsOf(k, observations));

        const Row& row = expected[k];
        const std::string at = "step " + std::to_string(k);
        const PoseGaussian robot = filter.robot();
        const TrackEstimate target = filter.tracks().at(0);
        expectNear(robot.mean.x, row[1], at);
        expectNear(robot.mean.y, row[2], at);
        expectNear(robot.mean.theta, row[3], at);
        for (int i = 0; i < 6; ++i) expectNear(target.mean(i), row[4 + i], at);
        for (int i = 0; i < 3; ++i) expectNear(robot.covariance(i, i), row[10 + i], at);
        for (int i = 0; i < 6; ++i) expectNear(target.covariance(i, i), row[13 + i], at);
        const JointBank& state = filter.state();
        const BlockMatrix cross = state.mode(0).covariance(robot_block, 1);  // the target is the first block added
        expectNear(cross(0, 0), row[19], at);
        expectNear(cross(2, 1), row[20], at);
        EXPECT_EQ(state.dimension(), static_cast<int>(row[21])) << at;
        if (testing::Test::HasFailure()) break;
    }

    std::map<std::int64_t, Row> map;
    for (const Row& row : expected_map) map[static_cast<std::int64_t>(row[0])] = row;
    const auto landmarks = filter.landmarks();
    ASSERT_EQ(landmarks.size(), map.size());
    for (const LandmarkEstimate& landmark : landmarks) {
        const Row& row = map.at(landmark.source.value);
        const std::string at = "landmark " + std::to_string(landmark.source.value);
        expectNear(landmark.mean.x(), row[2], at);
        expectNear(landmark.mean.y(), row[3], at);
        expectNear(landmark.covariance(0, 0), row[4], at);
        expectNear(landmark.covariance(1, 1), row[5], at);
        expectNear(landmark.covariance(0, 1), row[6], at);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Paper1, GoldenRun,
    testing::Values(GoldenCase{Consistency::classic, "classic", JointEngine::Kind::dense, "dense"},
                    GoldenCase{Consistency::invariant, "invariant", JointEngine::Kind::dense, "dense"},
                    GoldenCase{Consistency::classic, "classic", JointEngine::Kind::compressed, "compressed"},
                    GoldenCase{Consistency::invariant, "invariant", JointEngine::Kind::compressed, "compressed"}),
    [](const auto& each) { return std::string(each.param.trace) + "_" + each.param.engine_name; });

}  // namespace
}  // namespace slamot
