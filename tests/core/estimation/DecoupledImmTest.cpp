// The decoupled form: against an IMM and a Kalman filter written out here, and where it must equal other
// filters.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "ImmScenes.h"
#include "slamot/core/estimation/DecoupledImm.h"
#include "slamot/core/filter/JointFilter.h"
#include "support/Expect.h"

namespace slamot {
namespace decoupled_imm_test {

using test::immModes;
using test::ImmScene;
using test::near;

JointFilterParameters parametersOf(const std::string& modes, ImmForm form, Consistency consistency) {
    JointFilterParameters parameters;
    parameters.consistency = consistency;
    parameters.imm = immModes(modes);
    parameters.imm.form = form;
    parameters.target_max_unseen = 0.75;
    return parameters;
}

/// Only landmarks.
DetectionSet withoutMovers(DetectionSet set) {
    auto& seen = std::get<RangeBearingSet>(set.measurements).detections;
    std::vector<RangeBearingDetection> landmarks;
    for (const RangeBearingDetection& d : seen)
        if (d.kind == ObjectKind::landmark) landmarks.push_back(d);
    seen = landmarks;
    return set;
}

TEST(DecoupledImmTest, RobotAndMapAreThoseOfTheLandmarksAlone) {
    for (const Consistency consistency : {Consistency::classic, Consistency::invariant})
        for (const auto engine : {JointEngine::Kind::dense, JointEngine::Kind::compressed}) {
            JointFilterParameters parameters =
                parametersOf("cv:cv:0.3, ca:ca:2", ImmForm::decoupled, consistency);
            parameters.engine.kind = engine;
            JointFilterParameters joint = parameters;
            joint.imm.form = ImmForm::exact;
            JointFilter decoupled(parameters, {}), slam(joint, {});
            ImmScene scene;
            for (JointFilter* filter : {&decoupled, &slam}) filter->start({}, scene.start());
            bool any_mover = false;
            for (int k = 0; k < 60; ++k) {
                const ImmScene::Step step = scene.next();
                for (JointFilter* filter : {&decoupled, &slam}) filter->predict(step.odometry);
                decoupled.update(step.detections);
                slam.update(withoutMovers(step.detections));
                any_mover = any_mover || !decoupled.tracks().empty();
                // The same operations in the same order.
                ASSERT_EQ(decoupled.robot().mean.vector(), slam.robot().mean.vector()) << k;
                ASSERT_EQ(decoupled.robot().covariance, slam.robot().covariance) << k;
                const auto a = decoupled.landmarks(), b = slam.landmarks();
                ASSERT_EQ(a.size(), b.size());
                for (std::size_t i = 0; i < a.size(); ++i) {
                    ASSERT_EQ(a[i].mean, b[i].mean);
                    ASSERT_EQ(a[i].covariance, b[i].covariance);
                }
            }
            EXPECT_TRUE(any_mover);
        }
}

TEST(DecoupledImmTest, IsTheExactFormWhereTheRobotIsKnown) {
    // Nothing couples movers with a robot that stands and knows where.
    const Pose2 pose{1, 2, 0.5};
    for (const Consistency consistency : {Consistency::classic, Consistency::invariant}) {
        const std::string modes = "cv:cv:0.3, left:ct:0.3:40, ca:ca:2";
        JointFilter exact(parametersOf(modes, ImmForm::exact, consistency), {}),
            decoupled(parametersOf(modes, ImmForm::decoupled, consistency), {});
        RandomStream random(44, RandomPurpose::test);
        for (JointFilter* filter : {&exact, &decoupled}) filter->start({}, {pose, Matrix3::Zero()});
        for (int k = 0; k < 80; ++k) {
            const double t = 0.1 * k;
            std::vector<RangeBearingDetection> seen{
                test::seen(pose, Vector2(6 + t, 2 + std::sin(t)), ObjectKind::mover, 0),
                test::seen(pose, Vector2(4, -3), ObjectKind::landmark, 0)};
            if (k % 5 > 0) seen.push_back(test::seen(pose, Vector2(-5 + t * t / 8, 4), ObjectKind::mover, 1));
            for (RangeBearingDetection& d : seen) d.range += 0.1 * random.normal();
            for (JointFilter* filter : {&exact, &decoupled}) {
                if (k > 0) filter->predict(test::odometry(t - 0.1, t, {}));
                filter->update(test::detectionsAt(t, seen));
            }
            const auto a = exact.tracks(), b = decoupled.tracks();
            ASSERT_EQ(a.size(), b.size());
            for (std::size_t i = 0; i < a.size(); ++i) {  // rounding, as for the scalable form
                ASSERT_TRUE(near(b[i].mean, a[i].mean, 1e-8)) << k;
                ASSERT_TRUE(near(b[i].covariance, a[i].covariance, 1e-8)) << k;
                for (int j = 0; j < 3; ++j)
                    ASSERT_NEAR(b[i].mode_probabilities[j], a[i].mode_probabilities[j], 1e-8) << k;
            }
        }
    }
}

/// A robot at the origin that stands, unsure of its pose, without landmarks, and a mover along the x axis.
class UnsureRobot : public testing::Test {
  protected:
    UnsureRobot() {
        P_RR_ << 0.04, 0.003, 0.001, 0.003, 0.09, 0.002, 0.001, 0.002, 0.01;
        parameters_ = parametersOf("cv:cv:0.5, ca:ca:3", ImmForm::decoupled, Consistency::classic);
        parameters_.outliers = OutlierTreatment::accept;
        parameters_.imm.noise_interval = 0;
        parameters_.imm.transition_interval = 0;
        parameters_.imm.stay_probability = 0.9;
        parameters_.target_velocity_std = 2;
        parameters_.target_acceleration_std = 1;
        // A standing robot adds nothing to its covariance.
        motion_.model = RobotMotionModel::arc;
    }
    Matrix3 P_RR_;
    JointFilterParameters parameters_;
    RobotMotionParameters motion_;
};

class UnsureRobotWithEitherCore : public UnsureRobot, public testing::WithParamInterface<Consistency> {};
INSTANTIATE_TEST_SUITE_P(Cores, UnsureRobotWithEitherCore,
                         testing::Values(Consistency::classic, Consistency::invariant));

TEST_P(UnsureRobotWithEitherCore, TheMoverIsTrackedByATextbookImmWithTheRobotsCovarianceAsNoise) {
    const bool second_order = GetParam() == Consistency::invariant;
    parameters_.consistency = GetParam();
    JointFilter filter(parameters_, motion_);
    filter.start({}, {{0, 0, 0}, P_RR_});
    const Matrix2 R = Vector2(0.01, 0.0004).asDiagonal();

    // First sight at (10, 0): p = (r cos b, r sin b), with the heading turning it by (0, r) per rad. To
    // second order the bearing's variance of 0.0004 shortens the mean range and spreads it.
    filter.update(test::detectionsAt(0, {test::seen({}, Vector2(10, 0), ObjectKind::mover, 0)}));
    const double r = second_order ? 10 * (1 - 0.0004 / 2) : 10;
    Matrix2 R0 = R;
    if (second_order) R0(0, 0) += 0.5 * std::pow(10 * 0.0004, 2);
    Eigen::Matrix<double, 2, 3> G;
    G << 1, 0, 0, 0, 1, r;
    Matrix2 G_z;
    G_z << 1, 0, 0, r;
    Matrix6 P0 = Matrix6::Zero();
    P0.topLeftCorner<2, 2>() = G * P_RR_ * G.transpose() + G_z * R0 * G_z.transpose();
    P0.diagonal().tail<4>() << 4, 4, 1, 1;
    Vector6 x[2];
    Matrix6 P[2] = {P0, P0};
    x[0] = x[1] = (Vector6() << r, 0, 0, 0, 0, 0).finished();
    Vector2 mu(0.5, 0.5);

    const double dt = 0.2;
    const Matrix2 I = Matrix2::Identity();
    Matrix6 A[2] = {Matrix6::Identity(), Matrix6::Identity()}, Q[2];
    A[0].block<2, 2>(0, 2) = A[1].block<2, 2>(0, 2) = A[1].block<2, 2>(2, 4) = dt * I;
    A[1].block<2, 2>(0, 4) = dt * dt / 2 * I;
    A[0].block<2, 2>(4, 4).setZero();
    Eigen::Matrix<double, 6, 2> B[2];
    B[0] << dt * dt / 2 * I, dt * I, 0 * I;                 // an acceleration of 0.5 m/s^2
    B[1] << dt * dt * dt / 6 * I, dt * dt / 2 * I, dt * I;  // a jerk of 3 m/s^3
    Q[0] = 0.25 * B[0] * B[0].transpose();
    Q[1] = 9 * B[1] * B[1].transpose();
    const Matrix2 stay = (Matrix2() << 0.9, 0.1, 0.1, 0.9).finished();

    for (int k = 1; k <= 12; ++k) {
        const Vector2 place(10 + 0.5 * k + (k > 6 ? 0.2 * (k - 6) * (k - 6) : 0), 0.1 * k);
        filter.predict(test::odometry(dt * (k - 1), dt * k, {}));
        filter.update(test::detectionsAt(dt * k, {test::seen({}, place, ObjectKind::mover, 0)}));

        // Mixing.
        const Vector2 c = stay.transpose() * mu;
        Vector6 mixed[2];
        Matrix6 mixed_P[2];
        for (int j = 0; j < 2; ++j) {
            mixed[j].setZero();
            mixed_P[j].setZero();
            for (int i = 0; i < 2; ++i) mixed[j] += stay(i, j) * mu(i) / c(j) * x[i];
            for (int i = 0; i < 2; ++i)
                mixed_P[j] +=
                    stay(i, j) * mu(i) / c(j) * (P[i] + (x[i] - mixed[j]) * (x[i] - mixed[j]).transpose());
        }
        // The Kalman filter of each mode, in information form for the gain.
        for (int j = 0; j < 2; ++j) {
            x[j] = A[j] * mixed[j];
            P[j] = A[j] * mixed_P[j] * A[j].transpose() + Q[j];
            const double d = x[j].head<2>().norm(), dx = x[j](0), dy = x[j](1);
            Eigen::Matrix<double, 2, 6> H = Eigen::Matrix<double, 2, 6>::Zero();
            H.leftCols<2>() << dx / d, dy / d, -dy / d / d, dx / d / d;
            Eigen::Matrix<double, 2, 3> H_R;
            H_R << -dx / d, -dy / d, 0, dy / d / d, -dx / d / d, -1;
            Matrix2 noise = R + H_R * P_RR_ * H_R.transpose();
            Vector2 nu(place.norm() - d, std::atan2(place.y(), place.x()) - std::atan2(dy, dx));
            if (second_order) {  // of the uncertainty of robot and mover across the line of sight
                const Vector2 across(-dy / d, dx / d);
                const double lateral =
                    across.dot((P[j].topLeftCorner<2, 2>() + P_RR_.topLeftCorner<2, 2>()) * across);
                nu(0) -= lateral / (2 * d);
                noise(0, 0) += 0.5 * std::pow(lateral / d, 2);
            }
            const Matrix2 S = H * P[j] * H.transpose() + noise;
            const Eigen::Matrix<double, 6, 2> K = P[j] * H.transpose() * S.inverse();
            x[j] += K * nu;
            P[j] = (Matrix6::Identity() - K * H) * P[j];
            mu(j) = c(j) * std::exp(-0.5 * nu.dot(S.inverse() * nu)) / std::sqrt(S.determinant());
        }
        mu /= mu.sum();
        const Vector6 mean = mu(0) * x[0] + mu(1) * x[1];
        Matrix6 covariance = Matrix6::Zero();
        for (int j = 0; j < 2; ++j) covariance += mu(j) * (P[j] + (x[j] - mean) * (x[j] - mean).transpose());

        const TrackEstimate track = filter.tracks().at(0);
        ASSERT_TRUE(near(track.mean, mean, 1e-10)) << k;  // rounding of some hundred operations
        ASSERT_TRUE(near(track.covariance, covariance, 1e-10)) << k;
        ASSERT_NEAR(track.mode_probabilities[1], mu(1), 1e-10) << k;
        EXPECT_EQ(filter.robot().mean.vector(), Vector3::Zero()) << "a mover has corrected the robot";
        EXPECT_EQ(filter.robot().covariance, P_RR_);
    }
    EXPECT_GT(mu(1), 0.6) << "the mover has sped up, or the test shows nothing";
}

TEST_F(UnsureRobot, NothingIsCorrelatedWithAMover) {
    JointFilter filter(parameters_, motion_);
    filter.start({}, {{0, 0, 0}, P_RR_});
    for (int k = 0; k < 3; ++k) {
        if (k > 0) filter.predict(test::odometry(0.1 * (k - 1), 0.1 * k, {}));
        filter.update(test::detectionsAt(0.1 * k, {test::seen({}, {10, 0}, ObjectKind::mover, 4),
                                                   test::seen({}, {3, -8}, ObjectKind::mover, 5),
                                                   test::seen({}, {5, 5}, ObjectKind::landmark, 0),
                                                   test::seen({}, {7, -5}, ObjectKind::landmark, 1)}));
    }
    const JointCovariance joint = filter.jointCovariance();
    const Eigen::MatrixXd& P = joint.matrix;  // robot, two movers, two landmarks
    ASSERT_EQ(P.rows(), 3 + 6 + 6 + 2 + 2);
    for (const int at : {3, 9}) {
        EXPECT_TRUE(P.block(at, 0, 6, at).isZero(0));
        EXPECT_TRUE(P.block(at, at + 6, 6, P.cols() - at - 6).isZero(0));
        EXPECT_EQ(P.block(at, at, 6, 6), filter.tracks()[at == 3 ? 0 : 1].covariance);
    }
    EXPECT_EQ(P, P.transpose().eval());
    EXPECT_EQ(P.topLeftCorner(3, 3), filter.robot().covariance);
    EXPECT_EQ(P.block(15, 15, 2, 2), filter.landmarks()[0].covariance);
    EXPECT_GT(std::abs(P(15, 17)), 1e-3) << "landmarks seen by one robot are correlated";
}

TEST_F(UnsureRobot, MoversComeAndGo) {
    parameters_.imm.max_exact_targets = 1;  // no limit here
    JointFilter filter(parameters_, motion_);
    filter.start({}, {{0, 0, 0}, P_RR_});
    std::vector<RangeBearingDetection> seen;
    for (int i = 0; i < 4; ++i) seen.push_back(test::seen({}, Vector2(10, i), ObjectKind::mover, i));
    filter.update(test::detectionsAt(0, seen));
    ASSERT_EQ(filter.tracks().size(), 4u);
    seen.erase(seen.begin() + 1);
    for (int k = 1; k <= 10; ++k) {
        filter.predict(test::odometry(0.1 * (k - 1), 0.1 * k, {}));
        filter.update(test::detectionsAt(0.1 * k, seen));
    }
    const auto tracks = filter.tracks();
    ASSERT_EQ(tracks.size(), 3u);  // one was not seen for longer than 0.75 s
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(tracks[i].mean.y(), static_cast<double>(tracks[i].source.value), 0.1);
    EXPECT_EQ(tracks[1].source.value, 2);
}

}  // namespace decoupled_imm_test
}  // namespace slamot
