// The merged detection against the mixture that it stands for, through a Kalman update of four dimensions of
// which the measurement sees two.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "slamot/core/association/MergedDetection.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace merged_detection_test {

using test::near;
using test::randomCovariance;
using test::randomMatrix;
using test::randomVector;

using Weighed = std::vector<WeighedInnovation>;

struct Belief {
    Eigen::VectorXd mean;
    Eigen::MatrixXd P;
};

Belief updated(const Belief& prior, const Eigen::MatrixXd& H, const Vector2& residual, const Matrix2& R) {
    const Eigen::MatrixXd K = prior.P * H.transpose() * (H * prior.P * H.transpose() + R).inverse();
    const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(prior.P.rows(), prior.P.rows()) - K * H;
    return {prior.mean + K * residual, A * prior.P * A.transpose() + K * R * K.transpose()};
}

/// Of the updates by each, and of none.
Belief mixture(const Belief& prior, const Eigen::MatrixXd& H, const Weighed& innovations) {
    std::vector<std::pair<double, Belief>> parts;
    double none = 1;
    for (const WeighedInnovation& i : innovations) {
        parts.emplace_back(i.probability, updated(prior, H, i.residual, i.noise));
        none -= i.probability;
    }
    parts.emplace_back(none, prior);
    Belief out{Eigen::VectorXd::Zero(prior.mean.size()),
               Eigen::MatrixXd::Zero(prior.P.rows(), prior.P.cols())};
    for (const auto& [p, part] : parts) out.mean += p * part.mean;
    for (const auto& [p, part] : parts) {
        const Eigen::VectorXd d = part.mean - out.mean;
        out.P += p * (part.P + d * d.transpose());
    }
    return out;
}

class Mixtures : public testing::Test {
  protected:
    Mixtures() : random_(61, RandomPurpose::test) {}
    Belief prior() { return {randomVector(random_, 4), randomCovariance(random_, 4)}; }
    Eigen::MatrixXd H() { return randomMatrix(random_, 2, 4); }
    RandomStream random_;
};

TEST_F(Mixtures, OneThatIsCertainGivesItselfBack) {
    for (int i = 0; i < 20; ++i) {
        const Matrix2 P_y = randomCovariance(random_, 2), R = randomCovariance(random_, 2, 0.1);
        const Vector2 nu = randomVector(random_, 2);
        const MergedInnovation merged = mergedInnovation(P_y, {{1, nu, R}}, 1e9);
        EXPECT_TRUE(near(merged.residual, nu, 1e-9));  // rounding, times the condition of P_y + R
        EXPECT_TRUE(near(merged.noise, R, 1e-9));
    }
}

TEST_F(Mixtures, AreReachedByOneUpdate) {
    // Residuals small beside their deviations: the mixture is more certain than the prior along all axes.
    for (int i = 0; i < 50; ++i) {
        const Belief prior = this->prior();
        const Eigen::MatrixXd H = this->H();
        const Matrix2 P_y = H * prior.P * H.transpose();
        const Matrix2 L = P_y.llt().matrixL();
        Weighed innovations;
        for (const double p : {0.5, 0.2, 0.1})
            innovations.push_back({p, L * (0.4 * randomVector(random_, 2)).cwiseMin(0.7).cwiseMax(-0.7),
                                   randomCovariance(random_, 2, 0.2)});
        const MergedInnovation merged = mergedInnovation(P_y, innovations, 1e9);
        const Belief expected = mixture(prior, H, innovations);
        const Belief reached = updated(prior, H, merged.residual, merged.noise);
        EXPECT_TRUE(near(reached.mean, expected.mean, 1e-9)) << i;
        EXPECT_TRUE(near(reached.P, expected.P, 1e-9)) << i;
    }
}

TEST_F(Mixtures, ThatSpreadKeepTheirMeanAndAddNoCovariance) {
    // Two on either side at three deviations: along that axis the mixture is wider than the prior.
    for (int i = 0; i < 20; ++i) {
        const Belief prior = this->prior();
        const Eigen::MatrixXd H = this->H();
        const Matrix2 P_y = H * prior.P * H.transpose();
        const Vector2 far = Matrix2(P_y.llt().matrixL()) * Vector2(3, 0);
        const Weighed innovations{{0.5, far, 0.1 * P_y}, {0.3, -far, 0.1 * P_y}};
        const MergedInnovation merged = mergedInnovation(P_y, innovations);
        const Belief expected = mixture(prior, H, innovations);
        const Belief reached = updated(prior, H, merged.residual, merged.noise);
        EXPECT_TRUE(near(reached.mean, expected.mean, 1e-9));
        EXPECT_GT((expected.P - prior.P).selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff(), 0);
        EXPECT_LT((reached.P - prior.P).selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff(), 1e-12);
    }
}

TEST(MergedDetectionTest, TwoAsLikelyOnEitherSideSayNothingOfTheMean) {
    // P_y = 1, noise 1: each halves the covariance. Along x the mixture has 0.5 + 1.5^2 > 1: as much noise as
    // allowed; across it 0.5, by noise 1.
    const Matrix2 I = Matrix2::Identity();
    const MergedInnovation merged =
        mergedInnovation(I, {{0.5, Vector2(3, 0), I}, {0.5, Vector2(-3, 0), I}}, 7);
    EXPECT_TRUE(near(merged.residual, Vector2::Zero(), 1e-14));
    EXPECT_TRUE(near(merged.noise, Matrix2(Vector2(7, 1).asDiagonal()), 1e-14));
}

TEST(MergedDetectionTest, HalfADetectionByHand) {
    // P_y = 4 along x, noise 4, residual 2, probability 1/2: means 1 and 0, covariance 2 and 4, spread 1/4:
    // 0.5 and 3.25. 1 / 3.25 = 1 / 4 + 1 / N at N = 52 / 3, gain 3.25 / N = 3 / 16, residual 8 / 3. Across, 2
    // and 4 make 3: N = 12.
    const Matrix2 P = 4 * Matrix2::Identity();
    const MergedInnovation merged = mergedInnovation(P, {{0.5, Vector2(2, 0), P}});
    EXPECT_TRUE(near(merged.residual, Vector2(8.0 / 3, 0), 1e-14));
    EXPECT_TRUE(near(merged.noise, Matrix2(Vector2(52.0 / 3, 12).asDiagonal()), 1e-14));
}

TEST(MergedDetectionTest, NothingDetectedIsTheMostNoise) {
    const Matrix2 P_y = (Matrix2() << 2, 0.5, 0.5, 1).finished();
    const MergedInnovation merged = mergedInnovation(P_y, {}, 5);
    EXPECT_TRUE(near(merged.residual, Vector2::Zero(), 0));
    EXPECT_TRUE(near(merged.noise, Matrix2(5 * P_y), 1e-14));
}

TEST(MergedDetectionTest, AllButExactDetectionsStayAllButExact) {
    const Matrix2 I = Matrix2::Identity();
    const MergedInnovation merged = mergedInnovation(I, {{1, Vector2(0.3, -0.2), 1e-18 * I}});
    EXPECT_TRUE(near(merged.residual, Vector2(0.3, -0.2), 1e-11));
    EXPECT_LT(merged.noise.norm(), 1e-11);
}

TEST_F(Mixtures, TurnWithTheirFrame) {
    for (int i = 0; i < 24; ++i) {
        const Matrix2 P_y = randomCovariance(random_, 2), Rot = rotation(radians(15.0 * i));
        Weighed straight, turned;
        for (const double p : {0.6, 0.3}) {
            straight.push_back({p, randomVector(random_, 2), randomCovariance(random_, 2, 0.3)});
            turned.push_back(
                {p, Rot * straight.back().residual, Rot * straight.back().noise * Rot.transpose()});
        }
        const MergedInnovation a = mergedInnovation(P_y, straight),
                               b = mergedInnovation(Rot * P_y * Rot.transpose(), turned);
        EXPECT_TRUE(near(b.residual, Rot * a.residual, 1e-9));
        EXPECT_TRUE(near(b.noise, Rot * a.noise * Rot.transpose(), 1e-9));
    }
}

}  // namespace merged_detection_test
}  // namespace slamot
