#include <gtest/gtest.h>

#include "slamot/core/estimation/PassiveMap.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace passive_map_test {

using test::near;
using test::randomCovariance;
using test::randomMatrix;

TEST(PassiveMapTest, AGroupThatALandmarkWasRemovedFromIsMadeAnew) {
    // Landmark 1 is near, 2 to 4 are far. Rows are projected on the directions of far ones, which are not
    // orthonormal any more when one of them is gone.
    RandomStream random(1, RandomPurpose::test);
    PassiveMap map(true);
    map.follow({0, 0}, 1, false);
    PassiveMap::Commit commit;
    commit.landmarks = {1, 2, 3, 4};
    commit.mean.resize(8);
    commit.mean << 0, 0, 100, 0, 100.2, 0, 100.4, 0.1;
    commit.rows.resize(5, 0);
    commit.base = randomMatrix(random, 5, 8);
    commit.Phi.resize(8, 0);
    commit.covariance = randomCovariance(random, 8) + commit.base.transpose() * commit.base;
    map.commit(commit);
    map.follow({0, 0}, 1, false);
    ASSERT_EQ(map.census().near, 1);
    ASSERT_EQ(map.census().tiles, 2);
    map.prepare({1});
    const auto regroupings = map.regroupings();

    map.remove(3);
    const Eigen::MatrixXd base = map.base(4);
    const Matrix2 covariance = map.covariance(2, 4);
    const PassiveMap::Taken taken = map.prepare({1});
    EXPECT_EQ(map.regroupings(), regroupings + 1);
    EXPECT_TRUE(near(map.base(4), base, 1e-13));
    EXPECT_TRUE(near(map.covariance(2, 4), covariance, 1e-13));
    map.prepare({1});
    EXPECT_EQ(map.regroupings(), regroupings + 1) << "once is enough";

    // What is left knows as much of landmark 1 as before it was taken: U_c^t U_r + P_c|^1/2 gamma = P_cr0.
    map.take(map.prepare({1}));
    const Eigen::MatrixXd with_new = map.base(4);
    ASSERT_EQ(with_new.rows(), 10 + 4);
    const Eigen::MatrixXd U_c = taken.base(Eigen::seq(0, 9, 2), Eigen::all),
                          U_r = with_new(Eigen::seq(0, 9, 2), Eigen::all),
                          gamma = with_new(Eigen::seq(10, 13, 2), Eigen::all);
    EXPECT_TRUE(near(U_c.transpose() * U_r + taken.root * gamma, commit.covariance.block<2, 2>(0, 6), 1e-9));
}

}  // namespace passive_map_test
}  // namespace slamot
