// What is gathered is what the state itself says, whatever engine and whatever number of modes.
#include <gtest/gtest.h>

#include <stdexcept>

#include "slamot/core/estimation/CompressedJointBank.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "slamot/core/estimation/GatheredView.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace gathered_view_test {

using test::near;
using test::randomCovariance;
using test::randomMatrix;
using test::randomVector;

/// A robot, a mover and eight landmarks, all correlated; modes differ from one another.
template <class Bank>
std::vector<BlockId> fill(Bank& bank) {
    RandomStream random(63, RandomPurpose::test);
    std::vector<BlockId> blocks;
    for (int i = 0; i < 9; ++i) {
        const bool mover = i == 2;
        const int size = mover ? 6 : 2;
        std::vector<NewBlock> by_mode;
        for (int j = 0; j < bank.modeCount(); ++j)
            by_mode.push_back(
                {randomVector(random, size), randomMatrix(random, size, 3), randomCovariance(random, size)});
        blocks.push_back(bank.augment(mover ? BlockKind::target : BlockKind::landmark, by_mode));
        for (int j = 0; j < bank.modeCount(); ++j) {
            const BlockVector mean = bank.mode(j).mean(robot_block);
            bank.mode(j).propagate(robot_block, mean + 0.1 * randomVector(random, 3), Matrix3::Identity(),
                                   randomCovariance(random, 3, 0.2));
        }
    }
    return blocks;
}

void expectSame(const GatheredView& view, const JointView& state, std::vector<BlockId> blocks) {
    blocks.push_back(robot_block);
    for (const BlockId a : blocks) {
        EXPECT_EQ(view.mean(a), state.mean(a));
        for (const BlockId b : blocks)  // the same sums in another order
            EXPECT_TRUE(near(view.covariance(a, b), state.covariance(a, b), 1e-12)) << a << ' ' << b;
    }
    EXPECT_TRUE(near(view.jointCovariance(blocks), state.jointCovariance(blocks), 1e-12));
}

/// Some of them, in an order of their own, and one that is left out.
std::vector<BlockId> chosen(const std::vector<BlockId>& all) {
    return {all[5], all[2], all[0], all[7], all[8]};
}

class Gathered : public testing::TestWithParam<Consistency> {};
INSTANTIATE_TEST_SUITE_P(Cores, Gathered, testing::Values(Consistency::classic, Consistency::invariant));

TEST_P(Gathered, FromADenseState) {
    DenseJointBank bank({1, 2, 3.1}, 0.1 * Matrix3::Identity(), GetParam());
    const std::vector<BlockId> some = chosen(fill(bank));
    expectSame(GatheredView(bank.mode(0), some), bank.mode(0), some);
}

TEST_P(Gathered, FromACompressedStateOfWhichPartIsPutAway) {
    CompressedJointBank bank({1, 2, 3.1}, 0.1 * Matrix3::Identity(), GetParam());
    const std::vector<BlockId> all = fill(bank), some = chosen(all);
    bank.commit({all[5], all[6], all[7]}, Eigen::VectorXd::Ones(1));
    ASSERT_FALSE(bank.active(all[5]));
    ASSERT_TRUE(bank.active(all[8]));
    expectSame(GatheredView(bank.mode(0), some), bank.mode(0), some);
}

TEST_P(Gathered, FromSeveralModes) {
    DenseJointBank dense({1, 2, 3.1}, 0.1 * Matrix3::Identity(), GetParam(), 3);
    CompressedJointBank compressed({1, 2, 3.1}, 0.1 * Matrix3::Identity(), GetParam(), 3);
    const Eigen::Vector3d weights(0.2, 0.5, 0.3);
    for (JointBank* bank : {static_cast<JointBank*>(&dense), static_cast<JointBank*>(&compressed)}) {
        const std::vector<BlockId> all = fill(*bank), some = chosen(all);
        bank->commit({all[5], all[6], all[7]}, weights);
        const CombinedView combined(*bank, weights);
        expectSame(GatheredView(combined, some), combined, some);
    }
}

TEST(GatheredViewTest, KnowsNothingElse) {
    DenseJointBank bank({1, 2, 3}, Matrix3::Identity(), Consistency::classic);
    const std::vector<BlockId> all = fill(bank);
    const GatheredView view(bank.mode(0), {all[1]});
    EXPECT_THROW(view.mean(all[0]), std::out_of_range);
    EXPECT_THROW(view.covariance(all[1], all[0]), std::out_of_range);
    EXPECT_THROW(view.jointCovariance({all[1], all[0]}), std::out_of_range);
}

}  // namespace gathered_view_test
}  // namespace slamot
