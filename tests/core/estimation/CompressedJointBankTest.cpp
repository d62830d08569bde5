// The compressed bank against the dense one: the same operations, the same numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <vector>

#include "slamot/core/estimation/CompressedJointBank.h"
#include "slamot/core/estimation/Definiteness.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace compressed_joint_bank_test {

using test::near;
using test::randomCovariance;
using test::randomMatrix;
using test::randomVector;

/// The same random operations on both engines.
class Twins {
  public:
    Twins(std::uint32_t index, Consistency consistency, int modes, bool background)
        : random(12, RandomPurpose::test, 0, 0, index),
          robot_(randomVector(random, 3)),
          covariance_(randomCovariance(random, 3)),
          dense(robot_, covariance_, consistency, modes),
          compressed(robot_, covariance_, consistency, modes, nothingOnItsOwn(), background),
          weights(Eigen::VectorXd::Constant(modes, 1.0 / modes)) {
        active.insert(robot_block);
        // Modes differ from the start.
        for (int i = 0; i < modes; ++i) propagate(robot_block, i);
    }

    BlockId augment(BlockKind kind) {
        const int size = kind == BlockKind::target ? 6 : kind == BlockKind::landmark ? 2 : 1;
        std::vector<NewBlock> values;
        const Eigen::MatrixXd own = randomCovariance(random, size);
        const Eigen::VectorXd mean = randomVector(random, size);
        for (int i = 0; i < dense.modeCount(); ++i)
            values.push_back({mean + 0.1 * randomVector(random, size), randomMatrix(random, size, 3) / 2,
                              own + randomCovariance(random, size, 0.1)});
        const BlockId id = dense.augment(kind, values);
        names[id] = compressed.augment(kind, values);
        active.insert(id);
        return id;
    }

    void propagate(BlockId id, int mode) {
        const auto size = dense.mode(mode).mean(id).size();
        const Eigen::VectorXd mean =
            dense.mode(mode).mean(id) + 0.1 * randomVector(random, static_cast<int>(size));
        const Eigen::MatrixXd F = Eigen::MatrixXd::Identity(size, size) +
                                  0.1 * randomMatrix(random, static_cast<int>(size), static_cast<int>(size));
        const Eigen::MatrixXd Q = randomCovariance(random, static_cast<int>(size), 0.1);
        dense.mode(mode).propagate(id, mean, F, Q);
        compressed.mode(mode).propagate(names.at(id), mean, F, Q);
    }

    void propagate() {
        for (const BlockId id : active)
            for (int i = 0; i < dense.modeCount(); ++i)
                if (dense.kind(id) != BlockKind::landmark) propagate(id, i);
    }

    void update() {
        std::vector<BlockId> objects;
        for (const BlockId id : active)
            if (id != robot_block && random.uniform() < 0.5) objects.push_back(id);
        for (int i = 0; i < dense.modeCount(); ++i) {
            std::vector<LinearMeasurement> batch, same;
            for (const BlockId id : objects) {
                LinearMeasurement m;
                m.add(robot_block, randomMatrix(random, 2, 3));
                m.add(id, randomMatrix(random, 2, dense.kind(id) == BlockKind::extra ? 1 : 2));
                m.residual = 0.3 * randomVector(random, 2);
                m.R = randomCovariance(random, 2) + Matrix2::Identity();
                batch.push_back(m);
                m.terms[1].block = names.at(id);
                same.push_back(m);
            }
            const auto a = dense.mode(i).update(batch), b = compressed.mode(i).update(same);
            EXPECT_TRUE(near(b.whitened(), a.whitened(), 1e-9));
            const int rows = a.rows();
            EXPECT_NEAR(b.logMarginal(0, rows), a.logMarginal(0, rows), 1e-9);
            if (rows >= 4) {
                EXPECT_NEAR(b.logConditional(rows - 2, 2), a.logConditional(rows - 2, 2), 1e-9);
            }
        }
    }

    void mix() {
        const int n = dense.modeCount();
        Eigen::MatrixXd mu(n, n);
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) mu(i, j) = random.uniform() + (i == j ? 1.0 : 0.0);
            mu.col(j) /= mu.col(j).sum();
        }
        dense.mix(mu);
        compressed.mix(mu);
        for (int i = 0; i < n; ++i) weights(i) = 0.1 + random.uniform();
        weights /= weights.sum();
    }

    void commit(const std::vector<BlockId>& landmarks) {
        dense.commit(landmarks, weights);
        compressed.commit(inCompressed(landmarks), weights);
        for (const BlockId id : landmarks) active.erase(id);
    }

    void activate(const std::vector<BlockId>& landmarks) {
        dense.activate(landmarks);
        compressed.activate(inCompressed(landmarks));
        active.insert(landmarks.begin(), landmarks.end());
    }

    /// The compressed engine groups its map by distance to the robot, and brings in what is near.
    void attend() {
        RangeBearingSet seen;
        seen.sensors.resize(1);
        seen.detections.resize(1);
        seen.detections.front().kind = ObjectKind::landmark;
        const std::vector<BlockId> measured;
        compressed.attend({Pose2::fromVector(compressed.mode(0).mean(robot_block)), seen, measured}, weights);
        for (const auto& [id, name] : names)
            if (compressed.active(name) && active.insert(id).second) dense.activate({id});
    }

    void remove(BlockId id) {
        dense.remove(id);
        compressed.remove(names.at(id));
        active.erase(id);
        names.erase(id);
    }

    /// One step of whatever the dice say.
    double anything() {
        attend();
        const double choice = random.uniform();
        if (choice < 0.25) {
            propagate();
        } else if (choice < 0.6) {
            update();
        } else if (choice < 0.7) {
            mix();
        } else if (choice < 0.78) {
            augment(random.uniform() < 0.7 ? BlockKind::landmark : BlockKind::target);
        } else if (choice < 0.84) {
            activate(some(0.3, false));
        } else if (choice < 0.94) {
            commit(some(0.4, true));
        } else {
            const auto ids = all();
            const auto id = ids[static_cast<std::size_t>(random.uniform(0, static_cast<double>(ids.size())))];
            if (id != robot_block) remove(id);
        }
        return choice;
    }

    std::vector<BlockId> inCompressed(const std::vector<BlockId>& ids) const {
        std::vector<BlockId> out;
        for (const BlockId id : ids) out.push_back(names.at(id));
        return out;
    }
    std::vector<BlockId> all() const {
        std::vector<BlockId> out;
        for (const auto& [id, name] : names) out.push_back(id);
        return out;
    }
    std::vector<BlockId> some(double part, bool from_active) {
        std::vector<BlockId> out;
        for (const auto& [id, name] : names)
            if (dense.kind(id) == BlockKind::landmark && (active.count(id) > 0) == from_active &&
                random.uniform() < part)
                out.push_back(id);
        return out;
    }

    testing::AssertionResult agree(double tolerance = 1e-9) const {
        for (int i = 0; i < dense.modeCount(); ++i) {
            const auto same = agree(dense.mode(i), compressed.mode(i), tolerance);
            if (!same) return testing::AssertionFailure() << "mode " << i << ": " << same.message();
        }
        return agree(CombinedView(dense, weights), CombinedView(compressed, weights), tolerance);
    }

    RandomStream random;

  private:
    static ActiveSetParameters nothingOnItsOwn() {
        ActiveSetParameters parameters;
        parameters.range = 0.1;  // positions are about 1 apart: most tiles are far
        parameters.base_growth = 1e9;
        parameters.keep_at_least = 1000;
        return parameters;
    }

    testing::AssertionResult agree(const JointView& a, const JointView& b, double tolerance) const {
        for (const auto& [id, name] : names)
            if (auto same = near(b.mean(name), a.mean(id), tolerance); !same)
                return testing::AssertionFailure() << "mean of " << id << ": " << same.message();
        const Eigen::MatrixXd P = a.jointCovariance(all()), Q = b.jointCovariance(inCompressed(all()));
        if (!(P - Q).allFinite() || (P - Q).cwiseAbs().maxCoeff() > tolerance * P.cwiseAbs().maxCoeff())
            return testing::AssertionFailure() << "covariances differ by " << (P - Q).cwiseAbs().maxCoeff()
                                               << " of " << P.cwiseAbs().maxCoeff();
        for (const auto& [id, name] : names)
            if (auto same = near(b.covariance(name, robot_block), a.covariance(id, robot_block), tolerance);
                !same)
                return testing::AssertionFailure() << "covariance of " << id << ": " << same.message();
        return testing::AssertionSuccess();
    }

    Vector3 robot_;
    Matrix3 covariance_;

  public:
    DenseJointBank dense;
    CompressedJointBank compressed;
    Eigen::VectorXd weights;
    std::map<BlockId, BlockId> names{{robot_block, robot_block}};  ///< dense to compressed
    std::set<BlockId> active;
};

struct Core {
    Consistency consistency;
    int modes;
    bool background = false;
};

class CompressedJointBankTest : public testing::TestWithParam<Core> {
  protected:
    Twins twins(std::uint32_t index) const {
        return {index, GetParam().consistency, GetParam().modes, GetParam().background};
    }
};

TEST_P(CompressedJointBankTest, ExactBetweenCommits) {
    // One commit, then everything the algebra allows, with two activations. Rounding only: 1e-12.
    Twins pair = twins(0);
    for (int i = 0; i < 8; ++i) pair.augment(BlockKind::landmark);
    pair.augment(BlockKind::target);
    pair.augment(BlockKind::extra);
    pair.update();
    ASSERT_TRUE(pair.agree(1e-12));
    pair.commit({1, 2, 3, 4, 5});
    ASSERT_TRUE(pair.agree(1e-12)) << "after the commit";
    for (int step = 0; step < 12; ++step) {
        pair.propagate();
        ASSERT_TRUE(pair.agree(1e-12)) << "propagate " << step;
        pair.update();
        ASSERT_TRUE(pair.agree(1e-12)) << "update " << step;
        pair.mix();
        ASSERT_TRUE(pair.agree(1e-12)) << "mix " << step;
        if (step == 2) pair.activate({2, 4});
        if (step == 4) pair.augment(BlockKind::landmark);
        if (step == 6) pair.activate({1});
        if (step == 8) pair.augment(BlockKind::target);
        if (step == 9) pair.remove(9);   // the target
        if (step == 10) pair.remove(3);  // a landmark that is put away
        ASSERT_TRUE(pair.agree(1e-12)) << "structure " << step;
    }
    EXPECT_FALSE(pair.compressed.active(5));
    EXPECT_TRUE(pair.compressed.active(2));
}

TEST_P(CompressedJointBankTest, RandomSequences) {
    int most_far = 0;
    std::int64_t regroupings = 0;
    for (std::uint32_t sequence = 1; sequence <= 6; ++sequence) {
        Twins pair = twins(sequence);
        for (int i = 0; i < 12; ++i) pair.augment(BlockKind::landmark);
        for (int step = 0; step < 80; ++step) {
            const double choice = pair.anything();
            ASSERT_TRUE(pair.agree()) << "sequence " << sequence << " step " << step << " choice " << choice;
            for (int i = 0; i < pair.dense.modeCount(); ++i)
                ASSERT_TRUE(isPositiveSemidefinite(
                    pair.compressed.mode(i).jointCovariance(pair.inCompressed(pair.all())), 1e-9))
                    << "sequence " << sequence << " step " << step;
            most_far = std::max(most_far, pair.compressed.map().census().columns -
                                              pair.compressed.map().census().near_columns);
            regroupings = std::max(regroupings, pair.compressed.map().census().regroupings);
        }
    }
    EXPECT_GT(most_far, 10);
    EXPECT_GT(regroupings, 5);
}

TEST_P(CompressedJointBankTest, EverythingCanComeBack) {
    Twins pair = twins(20);
    for (int i = 0; i < 12; ++i) pair.augment(BlockKind::landmark);
    for (int round = 0; round < 3; ++round) {
        pair.update();
        pair.commit(pair.some(0.7, true));
        pair.propagate();
        pair.update();
        pair.mix();
        pair.commit(pair.some(0.5, true));  // what was away before stays so, with another base
        EXPECT_GT(pair.compressed.map().size(), 6);
        pair.propagate();
        pair.activate(pair.some(1.0, false));
        EXPECT_EQ(pair.compressed.map().size(), 0);
        EXPECT_EQ(pair.compressed.activeDimension(), pair.dense.dimension());
        EXPECT_EQ(pair.compressed.map().baseDimension(), 0) << "nothing is left for it to speak of";
        ASSERT_TRUE(pair.agree(1e-11)) << round;
        pair.update();
        ASSERT_TRUE(pair.agree(1e-11)) << round;
    }
}

TEST_P(CompressedJointBankTest, ALandmarkAskedForTwiceComesOnce) {
    Twins pair = twins(22);
    for (int i = 0; i < 8; ++i) pair.augment(BlockKind::landmark);
    pair.update();
    pair.commit(pair.some(1.0, true));
    std::vector<BlockId> twice = pair.some(0.6, false);
    ASSERT_FALSE(twice.empty());
    twice.insert(twice.begin(), twice.back());
    pair.activate(twice);
    pair.update();
    pair.commit(pair.some(1.0, true));
    EXPECT_EQ(pair.compressed.map().size(), 8);
    EXPECT_EQ(pair.compressed.dimension(), pair.dense.dimension());
    ASSERT_TRUE(pair.agree(1e-11));
}

TEST_P(CompressedJointBankTest, WhatIsPutAwayCanBeRemoved) {
    // One by one, until nothing is left away; then the bank goes on.
    Twins pair = twins(21);
    for (int i = 0; i < 6; ++i) pair.augment(BlockKind::landmark);
    pair.update();
    pair.commit({1, 2, 3, 4});
    for (const char* step : {"with an activation", "with a grouping"}) {
        SCOPED_TRACE(step);
        pair.attend();
    }
    EXPECT_EQ(pair.compressed.map().census().near_columns, 0)
        << "in the far group; near ones: ExactBetweenCommits";
    pair.update();
    for (const BlockId id : {2, 1, 4, 3}) {
        ASSERT_FALSE(pair.compressed.active(pair.names.at(id)));
        pair.remove(id);
        ASSERT_TRUE(pair.agree(1e-12)) << id;
        pair.propagate();
        pair.update();
        ASSERT_TRUE(pair.agree(1e-12)) << id;
    }
    EXPECT_EQ(pair.compressed.map().size(), 0);
    pair.commit({5});
    pair.update();
    EXPECT_TRUE(pair.agree(1e-12));
}

TEST_P(CompressedJointBankTest, AClonesLifeIsItsOwn) {
    Twins pair = twins(22);
    for (int i = 0; i < 12; ++i) pair.augment(BlockKind::landmark);
    for (int step = 0; step < 40 || pair.compressed.map().census().waiting == 0; ++step) {
        ASSERT_LT(step, 400) << "nothing waits";
        pair.anything();
    }
    ASSERT_GT(pair.compressed.map().size(), 0);
    const auto clone = pair.compressed.clone();
    const auto blocks = pair.inCompressed(pair.all());
    const Eigen::MatrixXd before = pair.compressed.mode(0).jointCovariance(blocks);
    EXPECT_EQ(clone->mode(0).jointCovariance(blocks), before);

    auto original = std::make_unique<Twins>(pair);
    for (int step = 0; step < 40; ++step) original->anything();
    ASSERT_TRUE(original->agree());
    const auto names = original->all();
    const Eigen::MatrixXd after = original->compressed.mode(0).jointCovariance(original->inCompressed(names));
    EXPECT_EQ(clone->mode(0).jointCovariance(blocks), before) << "the clone has not moved";
    original.reset();

    // The same dice give the same to the bit, without the original.
    for (int step = 0; step < 40; ++step) pair.anything();
    ASSERT_TRUE(pair.agree());
    EXPECT_EQ(pair.all(), names);
    EXPECT_EQ(pair.compressed.mode(0).jointCovariance(pair.inCompressed(names)), after);
}

INSTANTIATE_TEST_SUITE_P(All, CompressedJointBankTest,
                         testing::Values(Core{Consistency::classic, 1}, Core{Consistency::invariant, 1},
                                         Core{Consistency::classic, 3}, Core{Consistency::invariant, 3},
                                         Core{Consistency::invariant, 3, true}),
                         [](const auto& each) {
                             return std::string(each.param.consistency == Consistency::classic
                                                    ? "classic"
                                                    : "invariant") +
                                    std::to_string(each.param.modes) +
                                    (each.param.background ? "InTheBackground" : "");
                         });

}  // namespace compressed_joint_bank_test
}  // namespace slamot
