#include <gtest/gtest.h>

#include "slamot/core/association/LinearInnovations.h"
#include "slamot/core/estimation/CompressedJointBank.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "slamot/core/estimation/RangeBearingUpdate.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"
#include "support/Scenes.h"

namespace slamot {
namespace linear_innovations_test {

template <class Bank>
class LinearInnovationsOf : public testing::Test {};
using Banks = testing::Types<DenseJointBank, CompressedJointBank>;
TYPED_TEST_SUITE(LinearInnovationsOf, Banks);

TYPED_TEST(LinearInnovationsOf, AreThoseOfTheUpdate) {
    RandomStream random(7, RandomPurpose::test);
    const Pose2 robot{1, -2, 3.1}, sensor{0.3, 0.1, 0.2};
    TypeParam bank(robot.vector(), test::randomCovariance(random, 3, 0.01), Consistency::invariant);
    // Objects that depend on the robot, a mover among them; one is put away and brought back.
    const auto add = [&](BlockKind kind, int size) {
        Eigen::VectorXd mean = 4 * test::randomVector(random, size);
        return bank.augment(
            kind, {mean, test::randomMatrix(random, size, 3), test::randomCovariance(random, size, 0.1)});
    };
    const std::vector<BlockId> objects{add(BlockKind::landmark, 2), add(BlockKind::target, 6),
                                       add(BlockKind::landmark, 2), add(BlockKind::landmark, 2)};
    bank.commit({objects[2]}, Eigen::VectorXd::Ones(1));
    bank.activate({objects[2]});

    std::vector<LinearMeasurement> measurements;
    for (const BlockId object : objects) {
        const Vector2 p = bank.mode(0).mean(object).template head<2>();
        auto detection = test::seen(robot, p + Vector2(0.1, -0.05), ObjectKind::landmark, -1, sensor);
        measurements.push_back(
            linearise(bank.mode(0), object, detection, sensor, Consistency::invariant).measurement);
    }
    LinearInnovations innovations(bank.mode(0), measurements);
    const int n = static_cast<int>(measurements.size());
    Eigen::MatrixXd S(2 * n, 2 * n);
    Eigen::VectorXd nu(2 * n);
    for (int a : {2, 0, 3, 1}) {  // in no order: blocks are made when asked for
        nu.segment<2>(2 * a) = innovations.residual(a);
        for (int b : {3, 1, 0, 2}) S.block<2, 2>(2 * a, 2 * b) = innovations.covariance(a, b);
    }
    InnovationFactor factor(innovations, n);
    for (int a = 0; a < n; ++a) ASSERT_TRUE(factor.push(a));

    const BatchLikelihood update = bank.mode(0).update(measurements);
    const Eigen::MatrixXd L = Eigen::MatrixXd(update.factor()).template triangularView<Eigen::Lower>();
    // Two orders of the same sums, entries of about 1.
    EXPECT_TRUE(test::near(S, L * L.transpose(), 1e-12));
    EXPECT_TRUE(test::near(nu, L * update.whitened(), 1e-12));
    EXPECT_NEAR(factor.nis(), update.whitened().squaredNorm(), 1e-10 * factor.nis());
    EXPECT_TRUE((S - Eigen::MatrixXd(S.transpose())).norm() < 1e-12);
    EXPECT_GT(std::abs(S(0, 4)), 1e-4);  // pairs do depend on one another
}

}  // namespace linear_innovations_test
}  // namespace slamot
