// Paper 1's scenario against the traces of an independent implementation
// (tests/data/golden/paper1/README.md): fed with doubles, every printed number agrees to 1e-6.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "slamot/core/filter/JointFilter.h"

namespace slamot {
namespace golden_run_test {

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

/// config.json of the golden run, with movers still to be described.
JointFilterParameters goldenParameters(Consistency consistency) {
    JointFilterParameters parameters;
    parameters.consistency = consistency;
    parameters.outliers = OutlierTreatment::accept;
    parameters.target_velocity_std = 3.0;
    parameters.target_acceleration_std = 2.0;
    return parameters;
}

JointFilter goldenFilter(const JointFilterParameters& parameters) {
    RobotMotionParameters motion;
    motion.model = RobotMotionModel::steered;
    motion.wheelbase = 4.0;
    motion.speed_std = 1.0;
    motion.steering_std = 0.25;
    return {parameters, motion};
}

/// CV up to step 100, CA after.
JointFilter toldTheMode(Consistency consistency, JointEngine::Kind engine) {
    JointFilterParameters parameters = goldenParameters(consistency);
    parameters.engine.kind = engine;
    // Without a known range all of the map is within reach; with this one most of it is not.
    parameters.engine.active_set.range = 15;
    parameters.engine.active_set.keep_at_least = 5;
    parameters.target.kind = TargetModelKind::cv;
    parameters.target.noise_std = 0.1;
    parameters.target.noise_interval = 0;
    ModelChange change;
    change.after = 100 * dt;
    change.kind = TargetModelKind::ca;
    change.noise_std = 1.8;
    parameters.target_schedule = {change};
    return goldenFilter(parameters);
}

/// Paper 1's two modes; mode 0 is the first of `order`.
JointFilter twoModes(const std::vector<TargetModelKind>& order) {
    JointFilterParameters parameters = goldenParameters(Consistency::classic);
    parameters.imm.likelihood = ModeLikelihood::marginal;
    parameters.imm.noise_interval = 0;
    parameters.imm.transition_interval = 0;
    for (const TargetModelKind kind : order) {
        TargetModel model;
        model.kind = kind;
        model.noise_std = kind == TargetModelKind::cv ? 0.1 : 1.8;
        parameters.imm.modes.push_back({toText(kind), model});
    }
    return goldenFilter(parameters);
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

/// Feeds the inputs and compares every step; `more` compares what the trace has besides the EKF's columns.
template <class More>
void expectTrace(JointFilter& filter, const std::string& trace, const More& more) {
    const auto truth = readCsv("truth.csv"), observations = readCsv("observations.csv"),
               expected = readCsv(trace);
    ASSERT_EQ(expected.size(), 201u);
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
        const Eigen::MatrixXd joint = filter.jointCovariance().matrix;
        expectNear(joint(0, 3), row[19], at);
        expectNear(joint(2, 4), row[20], at);
        EXPECT_EQ(filter.state().dimension(), static_cast<int>(row[21])) << at;
        more(row, target, at);
        if (testing::Test::HasFailure()) break;
    }
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
    JointFilter filter = toldTheMode(consistency, engine);
    expectTrace(filter, stem + ".csv", [](const Row&, const TrackEstimate& target, const std::string&) {
        EXPECT_TRUE(target.mode_probabilities.empty());
    });

    std::map<std::int64_t, Row> map;
    for (const Row& row : readCsv(stem + "_map.csv")) map[static_cast<std::int64_t>(row[0])] = row;
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
                    GoldenCase{Consistency::invariant, "invariant", JointEngine::Kind::compressed,
                               "compressed"}),
    [](const auto& each) { return std::string(each.param.trace) + "_" + each.param.engine_name; });

TEST(GoldenImm, MatchesTheTraceWhateverTheOrderOfTheModes) {
    constexpr auto cv = TargetModelKind::cv, ca = TargetModelKind::ca;
    for (const auto& order : {std::vector{cv, ca}, std::vector{ca, cv}}) {
        JointFilter filter = twoModes(order);
        expectTrace(filter, "expect_imm_classic_marginal_likelihood.csv",
                    [&](const Row& row, const TrackEstimate& target, const std::string& at) {
                        ASSERT_EQ(target.mode_probabilities.size(), 2u);
                        expectNear(target.mode_probabilities[order[0] == cv ? 0 : 1], row[22], at);
                        EXPECT_NEAR(target.mode_probabilities[0] + target.mode_probabilities[1], 1, 1e-12)
                            << at;
                    });
        if (HasFailure()) break;
    }
}

}  // namespace golden_run_test
}  // namespace slamot
