#include <gtest/gtest.h>

#include "AssociationProblems.h"
#include "slamot/core/association/JointInnovations.h"
#include "support/Expect.h"

namespace slamot {
namespace joint_innovations_test {

TEST(InnovationFactorTest, TheLastPairGivenTheOthersIsASchurComplement) {
    RandomStream random(62, RandomPurpose::test);
    for (int i = 0; i < 20; ++i) {
        test::MatrixInnovations all = test::randomInnovations(random, 6, 0.5);
        InnovationFactor factor(all, 5);
        std::vector<int> order{4, 0, 5, 2, 1};
        for (std::size_t k = 0; k < order.size(); ++k) {
            ASSERT_TRUE(factor.push(order[k]));
            const auto before = static_cast<Eigen::Index>(2 * k);
            Eigen::MatrixXd S(before, before), s(2, before);
            Eigen::VectorXd nu(before);
            for (std::size_t a = 0; a < k; ++a) {
                const auto at = static_cast<Eigen::Index>(2 * a);
                nu.segment<2>(at) = all.residual(order[a]);
                s.middleCols<2>(at) = all.covariance(order[k], order[a]);
                for (std::size_t b = 0; b < k; ++b)
                    S.block<2, 2>(at, static_cast<Eigen::Index>(2 * b)) = all.covariance(order[a], order[b]);
            }
            const Eigen::MatrixXd K = k == 0 ? Eigen::MatrixXd(2, 0) : Eigen::MatrixXd(s * S.inverse());
            const Matrix2 covariance = all.covariance(order[k], order[k]) - K * s.transpose();
            const Vector2 residual = all.residual(order[k]) - K * nu;
            const auto [value, P] = factor.conditional();
            ASSERT_TRUE(test::near(value, residual, 1e-11));
            ASSERT_TRUE(test::near(P, covariance, 1e-11));
        }
        // Taking a pair back leaves no trace of it.
        const auto before = factor.conditional();
        factor.pop();
        ASSERT_TRUE(factor.push(3));
        factor.pop();
        ASSERT_TRUE(factor.push(1));
        EXPECT_EQ(factor.conditional().residual, before.residual);
        EXPECT_EQ(factor.conditional().covariance, before.covariance);
    }
}

}  // namespace joint_innovations_test
}  // namespace slamot
