// The likelihood of a batch against densities by inverse and determinant.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "slamot/core/estimation/DenseJointBank.h"
#include "slamot/core/estimation/LinearMeasurement.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace linear_measurement_test {

using test::randomCovariance;
using test::randomMatrix;
using test::randomVector;

double logNormal(const Eigen::VectorXd& nu, const Eigen::MatrixXd& S) {
    return -0.5 * nu.dot(S.inverse() * nu) - 0.5 * std::log((2 * pi * S).determinant());
}

TEST(BatchLikelihoodTest, ConditionalAndMarginalDensities) {
    RandomStream random(4, RandomPurpose::test);
    DenseJointBank bank(randomVector(random, 3), randomCovariance(random, 3), Consistency::invariant);
    std::vector<LinearMeasurement> batch;
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(6, 9), R = Eigen::MatrixXd::Zero(6, 6);
    Eigen::VectorXd nu(6);
    for (int i = 0; i < 3; ++i) {
        const BlockId id =
            bank.augment(BlockKind::landmark,
                         {randomVector(random, 2), randomMatrix(random, 2, 3), randomCovariance(random, 2)});
        LinearMeasurement m;
        m.add(robot_block, randomMatrix(random, 2, 3));
        m.add(id, randomMatrix(random, 2, 2));
        m.residual = randomVector(random, 2);
        m.R = randomCovariance(random, 2);
        H.block<2, 3>(2 * i, 0) = m.terms[0].H;
        H.block<2, 2>(2 * i, 3 + 2 * i) = m.terms[1].H;
        R.block<2, 2>(2 * i, 2 * i) = m.R;
        nu.segment<2>(2 * i) = m.residual;
        batch.push_back(m);
    }
    const Eigen::MatrixXd S = H * bank.mode(0).jointCovariance({0, 1, 2, 3}) * H.transpose() + R;
    const BatchLikelihood likelihood = bank.mode(0).update(batch);
    ASSERT_EQ(likelihood.rows(), 6);
    EXPECT_NEAR(likelihood.logConditional(0, 6), logNormal(nu, S), 1e-11);
    EXPECT_NEAR(likelihood.logConditional(4, 2),
                logNormal(nu, S) - logNormal(nu.head(4), S.topLeftCorner(4, 4)), 1e-11);
    EXPECT_NEAR(likelihood.logConditional(2, 2),
                logNormal(nu.head(4), S.topLeftCorner(4, 4)) - logNormal(nu.head(2), S.topLeftCorner(2, 2)),
                1e-11);
    EXPECT_NEAR(likelihood.logMarginal(4, 2), logNormal(nu.tail(2), S.bottomRightCorner(2, 2)), 1e-11);
    EXPECT_NEAR(likelihood.logMarginal(2, 4), logNormal(nu.tail(4), S.bottomRightCorner(4, 4)), 1e-11);
    EXPECT_NEAR(likelihood.logMarginal(0, 4), logNormal(nu.head(4), S.topLeftCorner(4, 4)), 1e-11);
    // No measurement, no evidence.
    EXPECT_EQ(bank.mode(0).update({}).rows(), 0);
    EXPECT_EQ(bank.mode(0).update({}).logConditional(0, 0), 0);
}

}  // namespace linear_measurement_test
}  // namespace slamot
