// Mixing, combination and commits of the dense bank against the formulas written out with full matrices.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "slamot/core/estimation/Definiteness.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace mixing_test {

using test::near;
using test::randomCovariance;
using test::randomMatrix;
using test::randomVector;

const std::vector<BlockId> blocks{0, 1, 2, 3, 4};  // robot, landmark, target, extra, landmark
constexpr int n = 3 + 2 + 6 + 1 + 2;
/// First coordinates of the 2-vectors that turn with the world.
const std::vector<int> vectors{0, 3, 5, 7, 9, 12};

/// Three modes that differ in everything; headings on both sides of pi.
DenseJointBank threeModes(Consistency consistency) {
    RandomStream random(3, RandomPurpose::test);
    DenseJointBank bank({1, 2, 3.1}, randomCovariance(random, 3), consistency, 3);
    for (const auto& [kind, size] : {std::pair{BlockKind::landmark, 2}, std::pair{BlockKind::target, 6},
                                     std::pair{BlockKind::extra, 1}, std::pair{BlockKind::landmark, 2}}) {
        std::vector<NewBlock> values;
        for (int i = 0; i < 3; ++i)
            values.push_back(
                {randomVector(random, size), randomMatrix(random, size, 3), randomCovariance(random, size)});
        bank.augment(kind, values);
    }
    for (int i = 0; i < 3; ++i) {
        const Vector3 mean(random.normal(), random.normal(), wrapAngle(3.1 + 0.2 * i));
        bank.mode(i).propagate(robot_block, mean, Matrix3::Identity() + 0.2 * randomMatrix(random, 3, 3),
                               randomCovariance(random, 3));
    }
    return bank;
}

struct Moments {
    Eigen::VectorXd x;
    Eigen::MatrixXd P;
};

Moments momentsOf(const JointView& view) {
    Moments out{Eigen::VectorXd(n), view.jointCovariance(blocks)};
    int at = 0;
    for (const BlockId id : blocks) {
        const BlockVector mean = view.mean(id);
        out.x.segment(at, mean.size()) = mean;
        at += static_cast<int>(mean.size());
    }
    return out;
}

Eigen::MatrixXd transport(const Eigen::VectorXd& dx) {
    Eigen::MatrixXd D = Eigen::MatrixXd::Identity(n, n);
    for (const int at : vectors) D.block<2, 1>(at, 2) += quarterTurn() * dx.segment<2>(at);
    return D;
}

Moments mixture(const std::vector<Moments>& modes, const Eigen::VectorXd& w, Consistency consistency) {
    Eigen::Index r;
    w.maxCoeff(&r);
    std::vector<Eigen::VectorXd> d;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(n);
    for (std::size_t i = 0; i < modes.size(); ++i) {
        d.push_back(modes[i].x - modes[static_cast<std::size_t>(r)].x);
        d.back()(2) = wrapAngle(d.back()(2));
        mean += w(static_cast<int>(i)) * d.back();
    }
    const bool invariant = consistency == Consistency::invariant;
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t i = 0; i < modes.size(); ++i) {
        const Eigen::MatrixXd D = invariant ? transport(-d[i]) : Eigen::MatrixXd::Identity(n, n);
        P += w(static_cast<int>(i)) *
             (D * modes[i].P * D.transpose() + (d[i] - mean) * (d[i] - mean).transpose());
    }
    if (invariant) P = transport(mean) * P * transport(mean).transpose();
    Eigen::VectorXd x = modes[static_cast<std::size_t>(r)].x + mean;
    x(2) = wrapAngle(x(2));
    return {x, P};
}

class Mixing : public testing::TestWithParam<Consistency> {};

TEST_P(Mixing, IsMomentMatchingWithTwoTransports) {
    DenseJointBank bank = threeModes(GetParam());
    std::vector<Moments> before;
    for (int i = 0; i < 3; ++i) before.push_back(momentsOf(bank.mode(i)));
    Eigen::Matrix3d mu;  // columns sum to 1; the last mode only takes from two
    mu << 0.7, 0.2, 0.4, 0.1, 0.5, 0.6, 0.2, 0.3, 0.0;
    for (int j = 0; j < 3; ++j) {
        const Moments combined = momentsOf(CombinedView(bank, mu.col(j)));
        const Moments expected = mixture(before, mu.col(j), GetParam());
        EXPECT_TRUE(near(combined.x, expected.x, 1e-13));
        EXPECT_TRUE(near(combined.P, expected.P, 1e-13));
    }
    bank.mix(mu);
    for (int j = 0; j < 3; ++j) {
        const Moments mixed = momentsOf(bank.mode(j)), expected = mixture(before, mu.col(j), GetParam());
        EXPECT_TRUE(near(mixed.x, expected.x, 1e-13)) << j;
        EXPECT_TRUE(near(mixed.P, expected.P, 1e-13)) << j;
    }
}

TEST_P(Mixing, NothingMixedIsNothingChanged) {
    DenseJointBank bank = threeModes(GetParam());
    const Moments before = momentsOf(bank.mode(1));
    bank.mix(Matrix3::Identity());
    EXPECT_TRUE(near(momentsOf(bank.mode(1)).x, before.x, 1e-15));
    EXPECT_TRUE(near(momentsOf(bank.mode(1)).P, before.P, 1e-15));
}

TEST_P(Mixing, ACommitKeepsWhatIsKnownTogetherAndEachModesOwnRest) {
    // Put away: both landmarks. Weighted with the commit's weights, mean and covariance of everything stay as
    // they were when matched at the merged mean; mean and covariance of robot, target and extra stay each
    // mode's own.
    DenseJointBank bank = threeModes(GetParam());
    const Eigen::Vector3d weights(0.5, 0.2, 0.3);
    const std::vector<BlockId> rest{0, 2, 3};
    std::vector<Eigen::MatrixXd> own;
    std::vector<Moments> before;
    for (int i = 0; i < 3; ++i) {
        own.push_back(bank.mode(i).jointCovariance(rest));
        before.push_back(momentsOf(bank.mode(i)));
    }
    bank.commit({1, 4}, weights);

    const auto matched =
        [&](const std::vector<Moments>& modes) {  // every mode transported to the merged mean
            Moments out = mixture(modes, weights, GetParam());
            out.P.setZero();
            for (int i = 0; i < 3; ++i) {
                Eigen::VectorXd d = modes[static_cast<std::size_t>(i)].x - out.x;
                d(2) = wrapAngle(d(2));
                const Eigen::MatrixXd D =
                    GetParam() == Consistency::invariant ? transport(-d) : Eigen::MatrixXd::Identity(n, n);
                out.P += weights(i) *
                         (D * modes[static_cast<std::size_t>(i)].P * D.transpose() + d * d.transpose());
            }
            return out;
        };
    std::vector<Moments> after;
    for (int i = 0; i < 3; ++i) {
        after.push_back(momentsOf(bank.mode(i)));
        EXPECT_TRUE(near(bank.mode(i).jointCovariance(rest), own[static_cast<std::size_t>(i)], 1e-12)) << i;
        for (const BlockId id : rest)
            EXPECT_TRUE(near(bank.mode(i).mean(id).head(1),
                             before[static_cast<std::size_t>(i)].x.segment(id == 0   ? 0
                                                                           : id == 2 ? 5
                                                                                     : 11,
                                                                           1),
                             1e-14));
        EXPECT_TRUE(isPositiveSemidefinite(after.back().P, 1e-9));
    }
    // Conditions of P_aa here are some 1e2, so 1e-12.
    EXPECT_TRUE(near(matched(after).x, matched(before).x, 1e-12));
    EXPECT_TRUE(near(matched(after).P, matched(before).P, 1e-12));
    // b given a is one for all modes: P_ba P_aa^-1, seen without the transport in the classic core.
    if (GetParam() == Consistency::invariant) return;
    const std::vector<int> a{0, 1, 2, 5, 6, 7, 8, 9, 10, 11}, b{3, 4, 12, 13};
    const auto gain = [&](const Moments& m) {
        return Eigen::MatrixXd(m.P(b, a) * Eigen::MatrixXd(m.P(a, a)).inverse());
    };
    for (int i = 1; i < 3; ++i)
        EXPECT_TRUE(near(gain(after[static_cast<std::size_t>(i)]), gain(after[0]), 1e-11));
}

INSTANTIATE_TEST_SUITE_P(Both, Mixing, testing::Values(Consistency::classic, Consistency::invariant),
                         [](const auto& each) {
                             return each.param == Consistency::classic ? "classic" : "invariant";
                         });

}  // namespace mixing_test
}  // namespace slamot
