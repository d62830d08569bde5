#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "FullMatrixState.h"
#include "slamot/core/estimation/Definiteness.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace dense_joint_bank_test {

using test::FullMatrixState;
using test::near;
using test::randomCovariance;
using test::randomMatrix;
using test::randomVector;

int sizeOf(BlockKind kind) {
    switch (kind) {
        case BlockKind::robot:
        case BlockKind::pose:
            return 3;
        case BlockKind::target:
            return 6;
        case BlockKind::landmark:
            return 2;
        case BlockKind::extra:
            return 1;
    }
    return 0;
}

/// The same random operations on an engine and on the reference.
class Pair {
  public:
    explicit Pair(std::uint32_t index, Consistency consistency = Consistency::invariant)
        : random_(11, RandomPurpose::test, 0, 0, index),
          robot_(randomVector(random_, 3)),
          covariance_(randomCovariance(random_, 3)),
          engine(robot_, covariance_, consistency),
          reference(robot_, covariance_) {}

    void augment(BlockKind kind) {
        const int size = sizeOf(kind);
        const Eigen::VectorXd mean = randomVector(random_, size);
        const Eigen::MatrixXd G = randomMatrix(random_, size, 3) / 2, own = randomCovariance(random_, size);
        reference.augment(engine.augment(kind, {mean, G, own}), kind, mean, G, own);
    }

    void propagate(bool coupled) {
        const BlockId id = anyBlock();
        const int size = reference.blocks.at(id).size;
        const Eigen::VectorXd mean = randomVector(random_, size);
        const Eigen::MatrixXd F =
            Eigen::MatrixXd::Identity(size, size) + 0.2 * randomMatrix(random_, size, size);
        const Eigen::MatrixXd Q = randomCovariance(random_, size, 0.1);
        std::vector<Coupling> couplings;
        if (coupled)
            for (const auto& [from, block] : reference.blocks)
                if (from != id && couplings.size() < 2 && random_.uniform() < 0.5)
                    couplings.push_back({from, 0.3 * randomMatrix(random_, size, block.size)});
        engine.mode(0).propagate(id, mean, F, Q, couplings);
        reference.propagate(id, mean, F, Q, couplings);
    }

    void update() {
        std::vector<LinearMeasurement> batch(static_cast<std::size_t>(random_.uniform(0, 5)));
        for (LinearMeasurement& m : batch) {
            m.add(robot_block, randomMatrix(random_, 2, 3));
            for (const auto& [id, block] : reference.blocks)
                if (id != robot_block && m.term_count < 3 && random_.uniform() < 0.4)
                    m.add(id, randomMatrix(random_, 2, std::min(block.size, 2)));  // leading coordinates only
            m.residual = randomVector(random_, 2);
            m.R = randomCovariance(random_, 2) + Matrix2::Identity();
        }
        engine.mode(0).update(batch);
        reference.update(batch, engine.consistency());
    }

    /// Removes any block but the robot.
    void remove() {
        const BlockId id = anyBlock();
        if (id == robot_block) return;
        engine.remove(id);
        reference.remove(id);
    }

    BlockId anyBlock() {
        auto block = reference.blocks.begin();
        std::advance(block,
                     static_cast<int>(random_.uniform(0, static_cast<double>(reference.blocks.size()))));
        return block->first;
    }

    std::vector<BlockId> allBlocks() const {
        std::vector<BlockId> ids;
        for (const auto& [id, block] : reference.blocks) ids.push_back(id);
        return ids;
    }

    /// Both do the same few products in another order; each operation adds some 1e-16, sequences have 60.
    testing::AssertionResult agree() const {
        if (engine.dimension() != reference.x.size())
            return testing::AssertionFailure() << "dimensions differ";
        Eigen::VectorXd x(engine.dimension());
        for (const auto& [id, block] : reference.blocks)
            x.segment(reference.offset(id), block.size) = engine.mode(0).mean(id);
        if (auto same = near(x, reference.x, 1e-12); !same) return same << "\n(mean)";
        return near(engine.mode(0).jointCovariance(allBlocks()), reference.P, 1e-12);
    }

    RandomStream random_;

  private:
    Vector3 robot_;
    Matrix3 covariance_;

  public:
    DenseJointBank engine;
    FullMatrixState reference;
};

class DenseJointBankTest : public testing::TestWithParam<Consistency> {};

TEST_P(DenseJointBankTest, RandomSequencesMatchFullMatrices) {
    for (std::uint32_t sequence = 0; sequence < 20; ++sequence) {
        Pair pair(sequence, GetParam());
        for (int step = 0; step < 60; ++step) {
            const double choice = pair.random_.uniform();
            if (choice < 0.25) {
                constexpr BlockKind kinds[] = {BlockKind::landmark, BlockKind::landmark, BlockKind::target,
                                               BlockKind::extra};
                pair.augment(kinds[static_cast<int>(pair.random_.uniform(0, 4))]);
            } else if (choice < 0.55) {
                pair.propagate(choice < 0.4);
            } else if (choice < 0.9) {
                pair.update();
            } else {
                pair.remove();
            }
            ASSERT_TRUE(pair.agree()) << "sequence " << sequence << " step " << step;
        }
    }
}

TEST_P(DenseJointBankTest, CovarianceStaysSemidefiniteOverAThousandSteps) {
    Pair pair(100, GetParam());
    for (const BlockKind kind : {BlockKind::target, BlockKind::landmark, BlockKind::landmark,
                                 BlockKind::extra, BlockKind::landmark, BlockKind::target})
        pair.augment(kind);
    for (int step = 0; step < 1000; ++step) {
        pair.propagate(step % 3 == 0);
        pair.update();
        ASSERT_TRUE(isPositiveSemidefinite(pair.engine.mode(0).jointCovariance(pair.allBlocks()), 1e-9))
            << step;
    }
}

INSTANTIATE_TEST_SUITE_P(Both, DenseJointBankTest,
                         testing::Values(Consistency::classic, Consistency::invariant), [](const auto& each) {
                             return each.param == Consistency::classic ? "classic" : "invariant";
                         });

/// Robot with a landmark, a target and an extra block in between.
Pair smallPair(Consistency consistency = Consistency::invariant) {
    Pair pair(50, consistency);
    for (const BlockKind kind : {BlockKind::landmark, BlockKind::extra, BlockKind::target})
        pair.augment(kind);
    return pair;
}

TEST(DenseJointBankTest, CrossCovariancesAreTransposes) {
    const Pair pair = smallPair();
    for (const BlockId a : pair.allBlocks())
        for (const BlockId b : pair.allBlocks())
            EXPECT_EQ(Eigen::MatrixXd(pair.engine.mode(0).covariance(a, b)),
                      Eigen::MatrixXd(pair.engine.mode(0).covariance(b, a).transpose()));
    // Any order may be asked for.
    const Eigen::MatrixXd P = pair.engine.mode(0).jointCovariance({3, robot_block});
    EXPECT_EQ(P.rows(), 9);
    EXPECT_EQ(P.topRightCorner(6, 3), Eigen::MatrixXd(pair.engine.mode(0).covariance(3, robot_block)));
}

TEST(DenseJointBankTest, ExtraBlocksDoNotTurnWithTheWorld) {
    // The one-dimensional extra block of a state where everything is uncertain moves in the update, yet its
    // covariance is the classic one.
    Pair classic = smallPair(Consistency::classic), invariant = smallPair(Consistency::invariant);
    LinearMeasurement m;
    m.add(robot_block, MeasurementJacobian::Ones(2, 3));
    m.add(2, MeasurementJacobian::Constant(2, 1, 0.5));
    m.residual = Vector2(3, -1);
    m.R = Matrix2::Identity();
    classic.engine.mode(0).update({m});
    invariant.engine.mode(0).update({m});
    EXPECT_EQ(Eigen::MatrixXd(classic.engine.mode(0).covariance(2, 2)),
              Eigen::MatrixXd(invariant.engine.mode(0).covariance(2, 2)));
    EXPECT_NE(Eigen::MatrixXd(classic.engine.mode(0).covariance(1, 1)),
              Eigen::MatrixXd(invariant.engine.mode(0).covariance(1, 1)));
    EXPECT_EQ(Eigen::MatrixXd(classic.engine.mode(0).mean(1)),
              Eigen::MatrixXd(invariant.engine.mode(0).mean(1)));
}

TEST(DenseJointBankTest, ClonesAreIndependent) {
    Pair pair = smallPair();
    const auto clone = pair.engine.clone();
    const Eigen::MatrixXd before = clone->mode(0).jointCovariance(pair.allBlocks());
    const Eigen::VectorXd mean_before = clone->mode(0).mean(3);
    pair.update();
    pair.propagate(true);
    pair.engine.remove(1);
    EXPECT_EQ(clone->mode(0).jointCovariance({0, 1, 2, 3}), before);
    EXPECT_EQ(Eigen::VectorXd(clone->mode(0).mean(3)), mean_before);
    clone->remove(3);
    EXPECT_NO_THROW(pair.engine.mode(0).mean(3));
    // Ids go on from the same number in both and stay apart.
    EXPECT_EQ(clone->augment(BlockKind::landmark,
                             {Vector2(1, 2), Eigen::MatrixXd::Zero(2, 3), Matrix2::Identity()}),
              4);
    EXPECT_EQ(pair.engine.augment(BlockKind::extra, {Eigen::VectorXd::Ones(1), Eigen::MatrixXd::Zero(1, 3),
                                                     Eigen::MatrixXd::Ones(1, 1)}),
              4);
    EXPECT_EQ(clone->mode(0).mean(4).size(), 2);
    EXPECT_EQ(pair.engine.mode(0).mean(4).size(), 1);
}

TEST(DenseJointBankTest, RemovedBlocksAreGoneAndIdsNotReused) {
    Pair pair = smallPair();
    pair.engine.remove(2);
    EXPECT_THROW(pair.engine.mode(0).mean(2), std::out_of_range);
    EXPECT_THROW(pair.engine.mode(0).covariance(0, 2), std::out_of_range);
    EXPECT_THROW(pair.engine.remove(2), std::out_of_range);
    EXPECT_THROW(pair.engine.mode(0).mean(-1), std::out_of_range);
    EXPECT_THROW(pair.engine.mode(0).mean(99), std::out_of_range);
    EXPECT_THROW(pair.engine.remove(robot_block), std::invalid_argument);
    EXPECT_EQ(pair.engine.augment(BlockKind::landmark,
                                  {Vector2(0, 0), Eigen::MatrixXd::Zero(2, 3), Matrix2::Identity()}),
              4);
}

TEST(DenseJointBankTest, UpdateRefusesAnIndefiniteS) {
    Pair pair = smallPair();
    LinearMeasurement m;
    m.add(robot_block, MeasurementJacobian::Zero(2, 3));
    m.residual.setZero();
    for (const Matrix2& R : {Matrix2(-Matrix2::Identity()), Matrix2(Matrix2::Zero())}) {
        m.R = R;
        EXPECT_THROW(pair.engine.mode(0).update({m}), std::domain_error);
    }
    EXPECT_TRUE(pair.agree()) << "a refused update changes nothing";
}

TEST(DenseJointBankTest, HandComputedUpdate) {
    // Robot known but for x with variance 4; z = x measured with variance 1 (the second row sees y, known).
    // Gain 4/5: x 0 -> 0.8 * 5 = 4, variance 4 - 16/5 = 0.8.
    DenseJointBank state({0, 0, 3}, Matrix3(Vector3(4, 0, 0).asDiagonal()), Consistency::invariant);
    LinearMeasurement m;
    m.add(robot_block, (MeasurementJacobian(2, 3) << 1, 0, 0, 0, 1, 0).finished());
    m.residual = Vector2(5, 0);
    m.R = Matrix2::Identity();
    state.mode(0).update({m});
    EXPECT_TRUE(near(state.mode(0).mean(robot_block), Vector3(4, 0, 3), 1e-15));
    EXPECT_TRUE(near(state.mode(0).covariance(0, 0), Matrix3(Vector3(0.8, 0, 0).asDiagonal()), 1e-15));
}

TEST(DenseJointBankTest, HeadingIsWrappedByUpdates) {
    DenseJointBank state({0, 0, 3}, Matrix3(Vector3(0, 0, 1).asDiagonal()), Consistency::classic);
    LinearMeasurement m;
    m.add(robot_block, (MeasurementJacobian(2, 3) << 0, 0, 1, 0, 1, 0).finished());
    m.residual = Vector2(1, 0);
    m.R = Vector2(1e-9, 1).asDiagonal();
    state.mode(0).update({m});
    EXPECT_NEAR(state.mode(0).mean(robot_block)(2), 4 - 2 * pi, 1e-8);  // gain 1 / (1 + 1e-9)
}

}  // namespace dense_joint_bank_test
}  // namespace slamot
