#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "slamot/core/particles/PointSight.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace point_sight_test {

const Pose2 mount{0.3, -0.2, 0.4};

struct Scene {
    PoseBelief pose;
    GaussianPoint point;
};

Scene scene(std::uint32_t number, double scale) {
    RandomStream random(5, RandomPurpose::test, 0, number);
    Scene out;
    out.pose.mean << random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-pi, pi);
    out.pose.factor = factorOf(test::randomCovariance(random, 3, scale));
    const double direction = random.uniform(-pi, pi), range = random.uniform(5, 15);
    out.point.mean = out.pose.mean.head<2>() + range * Vector2(std::cos(direction), std::sin(direction));
    out.point.covariance = test::randomCovariance(random, 2, scale);
    return out;
}

Matrix2 noise() {
    return (Matrix2() << 0.04, 0.001, 0.001, 0.0009).finished();
}

TEST(PointSightTest, LinearSightIsTheJacobians) {
    for (std::uint32_t k = 0; k < 20; ++k) {
        const Scene s = scene(k, 0.05);
        const PointSight sight = sightOf(s.point, s.pose, mount, GaussianTransform::linear);
        const RangeBearingPrediction h = predictRangeBearing(s.pose.mean, s.point.mean, mount);
        EXPECT_TRUE(test::near(sight.z, h.z, 1e-15));
        EXPECT_TRUE(test::near(sight.covariance,
                               h.H_robot * s.pose.covariance() * h.H_robot.transpose() +
                                   h.H_point * s.point.covariance * h.H_point.transpose(),
                               1e-12));
        EXPECT_TRUE(test::near(sight.A, h.H_robot * s.pose.factor, 1e-12));
        EXPECT_TRUE(test::near(sight.cross, s.point.covariance * h.H_point.transpose(), 1e-12));
    }
}

TEST(PointSightTest, UnscentedSightHasTheMomentsOfDraws) {
    constexpr int draws = 100000;
    for (std::uint32_t k = 0; k < 6; ++k) {
        const Scene s = scene(k, 0.05);
        const PointSight sight = sightOf(s.point, s.pose, mount, GaussianTransform::unscented);
        const Matrix2 L = s.point.covariance.llt().matrixL();
        RandomStream random(6, RandomPurpose::test, 0, k);
        Vector2 mean = Vector2::Zero();
        Matrix2 second = Matrix2::Zero(), cross = Matrix2::Zero();
        Eigen::Matrix<double, 2, 3> A = Eigen::Matrix<double, 2, 3>::Zero();
        for (int i = 0; i < draws; ++i) {
            const Vector3 xi(random.normal(), random.normal(), random.normal());
            const Vector2 eta(random.normal(), random.normal());
            const Vector2 d = rangeBearingResidual(
                rangeBearing<double>(s.pose.mean + s.pose.factor * xi, s.point.mean + L * eta, mount),
                sight.z);
            mean += d / draws;
            second += d * d.transpose() / draws;
            A += d * xi.transpose() / draws;
            cross += L * eta * d.transpose() / draws;
        }
        // 4.5 standard errors, and what a transform of third order leaves at these spreads (some 4 % of a
        // range of 5 m): a hundredth of the deviations.
        const Vector2 deviation = sight.covariance.diagonal().cwiseSqrt();
        for (int i = 0; i < 2; ++i) {
            const double mean_error = deviation(i) * (4.5 / std::sqrt(double(draws)) + 0.01);
            EXPECT_LT(std::abs(mean(i)), mean_error);
            EXPECT_NEAR(std::sqrt(second(i, i)), deviation(i), 0.03 * deviation(i));
            for (int j = 0; j < 3; ++j) EXPECT_NEAR(A(i, j), sight.A(i, j), 0.03 * deviation(i));
            for (int j = 0; j < 2; ++j)
                EXPECT_NEAR(cross(j, i), sight.cross(j, i),
                            0.03 * deviation(i) * std::sqrt(s.point.covariance(j, j)));
        }
    }
}

class Transforms : public testing::TestWithParam<GaussianTransform> {};

TEST_P(Transforms, AKnownPoseIsAPoseWithoutSpread) {
    const Scene s = scene(1, 0.05);
    const PointSight of_belief =
        sightOf(s.point, PoseBelief{s.pose.mean, Matrix3::Zero()}, mount, GetParam());
    const PointSight of_pose = sightOf(s.point, placeOf(s.pose.mean, mount), GetParam());
    EXPECT_TRUE(test::near(of_belief.z, of_pose.z, 0));
    EXPECT_TRUE(test::near(of_belief.covariance, of_pose.covariance, 0));
    EXPECT_TRUE(of_pose.A.isZero(0));
    // A hardly uncertain pose comes near it.
    const PointSight nearly =
        sightOf(s.point, PoseBelief{s.pose.mean, 1e-6 * Matrix3::Identity()}, mount, GetParam());
    EXPECT_TRUE(test::near(nearly.z, of_pose.z, 2e-3));
    EXPECT_TRUE(test::near(nearly.covariance, of_pose.covariance, 2e-3));
}

// Refined pose and updated point are the blocks of one Kalman update of both.
TEST(PointSightTest, RefinementIsTheKalmanUpdateOfPoseAndPoint) {
    for (std::uint32_t k = 0; k < 20; ++k) {
        const Scene s = scene(k, 0.05);
        const PointSight sight = sightOf(s.point, s.pose, mount, GaussianTransform::linear);
        const Vector2 z = sight.z + Vector2(0.1, -0.02);
        const PointInnovation innovation(sight, z, noise());
        RefinedPose refined(s.pose);
        refined.take(sight, innovation);
        GaussianPoint point = s.point;
        update(point, sight, innovation);

        const RangeBearingPrediction h = predictRangeBearing(s.pose.mean, s.point.mean, mount);
        Eigen::Matrix<double, 2, 5> H;
        H << h.H_robot, h.H_point;
        Eigen::Matrix<double, 5, 5> P = Eigen::Matrix<double, 5, 5>::Zero();
        P.topLeftCorner<3, 3>() = s.pose.covariance();
        P.bottomRightCorner<2, 2>() = s.point.covariance;
        const Matrix2 S = H * P * H.transpose() + noise();
        const Eigen::Matrix<double, 5, 2> K = P * H.transpose() * S.inverse();
        const Eigen::Matrix<double, 5, 1> shift = K * (z - sight.z);
        const Eigen::Matrix<double, 5, 5> after = P - K * S * K.transpose();
        EXPECT_TRUE(
            test::near(refined.belief().mean.head<2>(), s.pose.mean.head<2>() + shift.head<2>(), 1e-12));
        EXPECT_NEAR(angleDifference(refined.belief().mean.z(), s.pose.mean.z() + shift(2)), 0, 1e-12);
        EXPECT_TRUE(test::near(refined.belief().covariance(), after.topLeftCorner<3, 3>(), 1e-12));
        EXPECT_TRUE(test::near(point.mean, s.point.mean + shift.tail<2>(), 1e-12));
        EXPECT_TRUE(test::near(point.covariance, after.bottomRightCorner<2, 2>(), 1e-12));
        EXPECT_NEAR(innovation.logLikelihood(),
                    -0.5 * (z - sight.z).dot(S.inverse() * (z - sight.z)) - 0.5 * std::log(S.determinant()) -
                        std::log(2 * pi),
                    1e-10);
    }
}

// log_ratio is log p/q: with it draws of the proposal stand for the prior. A prior that knows a direction
// exactly is no hindrance.
TEST_P(Transforms, DrawsWeighedByTheRatioHaveThePriorsMoments) {
    for (const bool flat : {false, true}) {
        Scene s = scene(3, 0.02);
        if (flat) s.pose.factor.col(2).setZero();
        RefinedPose refined(s.pose);
        for (int k = 0; k < 2; ++k) {
            const PointSight sight = sightOf(s.point, refined.belief(), mount, GetParam());
            refined.take(sight, PointInnovation(sight, sight.z + Vector2(0.05, 0.01), 20 * noise()));
        }
        constexpr int draws = 100000;
        double weight = 0, squares = 0;
        Vector3 mean = Vector3::Zero();
        RandomStream random(8, RandomPurpose::test);
        for (int i = 0; i < draws; ++i) {
            const RefinedPose::Draw draw = refined.draw(random);
            const double w = std::exp(draw.log_ratio);
            Vector3 d = draw.pose - s.pose.mean;
            d.z() = wrapAngle(d.z());
            weight += w / draws;
            squares += w * w / draws;
            mean += w * d / draws;
        }
        const double error = 4.5 * std::sqrt((squares - weight * weight) / draws);
        EXPECT_NEAR(weight, 1, error);
        const Matrix3 P = s.pose.covariance();
        // The weighed draws' spread is at most a few times the weights' own.
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(mean(i), 0, 3 * error * std::sqrt(P(i, i)) + 1e-12);
    }
}

TEST_P(Transforms, FirstSightLiesWhereTheDetectionPoints) {
    const Vector3 pose(1, 2, 0.5);
    const Vector2 z(8, -0.3);
    const Matrix2 R = 0.01 * noise();
    const GaussianPoint point = firstSight(placeOf(pose, mount), z, R, GetParam());
    const RangeBearingInverse inverse = invertRangeBearing(pose, z, mount);
    EXPECT_TRUE(test::near(point.mean, inverse.point, 1e-4));
    EXPECT_TRUE(test::near(1e3 * point.covariance, 1e3 * (inverse.G_z * R * inverse.G_z.transpose()), 1e-3));
}

TEST_P(Transforms, ManyUpdatesKeepAPointDefinite) {
    GaussianPoint point =
        firstSight(placeOf({0, 0, 0}, mount), {5, 0.2}, Vector2(1, 0.1).asDiagonal(), GetParam());
    RandomStream random(9, RandomPurpose::test);
    for (int k = 0; k < 20000; ++k) {
        const Vector3 pose(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-pi, pi));
        const PointSight sight = sightOf(point, placeOf(pose, mount), GetParam());
        update(point, sight, PointInnovation(sight, sight.z, 1e-4 * noise()));
    }
    const Eigen::LLT<Matrix2> definite(point.covariance);
    EXPECT_EQ(definite.info(), Eigen::Success);
    EXPECT_EQ(point.covariance(0, 1), point.covariance(1, 0));
}

INSTANTIATE_TEST_SUITE_P(Both, Transforms,
                         testing::Values(GaussianTransform::linear, GaussianTransform::unscented),
                         [](const auto& each) {
                             return each.param == GaussianTransform::linear ? "linear" : "unscented";
                         });

}  // namespace point_sight_test
}  // namespace slamot
