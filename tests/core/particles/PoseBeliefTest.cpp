#include "slamot/core/particles/PoseBelief.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace pose_belief_test {

TEST(PoseBeliefTest, FactorsOfWhatIsSemiDefinite) {
    RandomStream random(1, RandomPurpose::test);
    for (int k = 0; k < 100; ++k) {
        const Eigen::MatrixXd A = test::randomMatrix(random, 3, 1 + k % 3);  // rank 1 to 3
        const Matrix3 P = A * A.transpose();
        const Matrix3 L = factorOf(P);
        EXPECT_TRUE(test::near(L * L.transpose(), P, 1e-7));
        EXPECT_TRUE(L.isLowerTriangular(0));
    }
    EXPECT_TRUE(factorOf(Matrix3::Zero()).isZero(0));
    EXPECT_TRUE(
        test::near(factorOf(Vector3(0, 4, 0).asDiagonal()), Matrix3(Vector3(0, 2, 0).asDiagonal()), 0));
}

OdometryIncrement driving(double v, double omega, double dt) {
    OdometryIncrement out;
    out.t1 = Stamp::fromSeconds(dt);
    out.velocity = BodyVelocity{v, 0, omega};
    out.increment = {v * dt, 0, omega * dt};
    out.entry_seconds = dt;
    return out;
}

TEST(PoseBeliefTest, LinearPredictionIsThatOfTheMotionModel) {
    RobotMotionParameters motion;
    motion.model = RobotMotionModel::differential;
    const OdometryIncrement step = driving(2, 0.3, 0.5);
    RandomStream random(2, RandomPurpose::test);
    const Matrix3 P = test::randomCovariance(random, 3, 0.1);
    const PoseBelief before{{1, 2, 3}, factorOf(P)};

    const PoseBelief after =
        predicted(before, motion, controlOf(motion, step), 0.5, GaussianTransform::linear);
    const MotionPrediction expected = predictMotion(motion, before.mean, step);
    EXPECT_TRUE(test::near(after.mean, expected.pose, 1e-15));
    EXPECT_TRUE(test::near(after.covariance(), expected.F * P * expected.F.transpose() + expected.Q, 1e-13));
}

// The mean is right to third order: a linear prediction would be off by 3 m * 0.12 rad^2 / 2 = 2 cm.
TEST(PoseBeliefTest, UnscentedPredictionHasTheMomentsOfDraws) {
    for (const RobotMotionModel model : {RobotMotionModel::steered, RobotMotionModel::differential,
                                         RobotMotionModel::arc, RobotMotionModel::increment}) {
        RobotMotionParameters motion;
        motion.model = model;
        motion.speed_std = 0.3;
        motion.steering_std = motion.turn_rate_std = 0.06;
        motion.heading_std_per_sqrt_m = 0.03;
        const OdometryIncrement step = driving(3, 0.4, 1);
        const MotionControl control = controlOf(motion, step);
        const PoseBelief before{{1, -2, 3.1}, factorOf(Vector3(0.01, 0.02, 0.01).asDiagonal())};
        const PoseBelief after = predicted(before, motion, control, 1, GaussianTransform::unscented);

        constexpr int draws = 200000;
        const Matrix3 control_factor = factorOf(control.covariance);
        RandomStream random(3, RandomPurpose::test);
        Vector3 mean = Vector3::Zero();
        Matrix3 second = Matrix3::Zero();
        for (int k = 0; k < draws; ++k) {
            const Vector3 xi(random.normal(), random.normal(), random.normal());
            Vector3 d =
                drawnMove(before.mean + before.factor * xi, motion, control, control_factor, 1, random) -
                after.mean;
            d.z() = wrapAngle(d.z());
            mean += d / draws;
            second += d * d.transpose() / draws;
        }
        const Matrix3 P = second - mean * mean.transpose();
        // Means: 4.5 standard errors, one false alarm in 10,000 such tests of 12 means. Covariances: as many
        // standard errors, 4.5 sqrt(2 / draws) = 1.4 %, and what is of second order between heading and
        // control, 3^2 * 0.1^2 * 0.12^2 = 0.0013.
        for (int i = 0; i < 3; ++i)
            EXPECT_LT(std::abs(mean(i)), 4.5 * std::sqrt(P(i, i) / draws)) << static_cast<int>(model);
        EXPECT_TRUE(test::near(10 * after.covariance(), 10 * P, 0.014 + 0.013)) << static_cast<int>(model);
    }
}

TEST(PoseBeliefTest, TransformsAgreeWhereNoiseIsSmall) {
    RobotMotionParameters motion;
    motion.model = RobotMotionModel::steered;
    motion.speed_std = 1e-3;
    motion.steering_std = 1e-3;
    const MotionControl control = controlOf(motion, driving(2, 0.1, 0.1));
    const PoseBelief before{{0, 0, -3.14}, factorOf(Vector3(1e-6, 1e-6, 1e-6).asDiagonal())};
    const PoseBelief linear = predicted(before, motion, control, 0.1, GaussianTransform::linear);
    const PoseBelief unscented = predicted(before, motion, control, 0.1, GaussianTransform::unscented);
    EXPECT_TRUE(test::near(unscented.mean, linear.mean, 1e-6));
    EXPECT_TRUE(test::near(1e6 * unscented.covariance(), 1e6 * linear.covariance(), 1e-4));
}

}  // namespace pose_belief_test
}  // namespace slamot
