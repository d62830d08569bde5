// The compressed engine with a thread for what is put away, beside the same without: equal to the last bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "core/estimation/ImmScenes.h"
#include "core/estimation/LoopScene.h"
#include "slamot/core/estimation/CompressedJointBank.h"
#include "slamot/core/filter/JointFilter.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace background_map_test {

using test::randomCovariance;
using test::randomMatrix;
using test::randomVector;

struct Form {
    Consistency consistency;
    const char* modes;
};

class BackgroundMap : public testing::TestWithParam<Form> {
  protected:
    JointFilter filter(bool background) const {
        JointFilterParameters parameters;
        parameters.consistency = GetParam().consistency;
        if (GetParam().modes[0] != '\0') parameters.imm = test::immModes(GetParam().modes);
        parameters.imm.form = ImmForm::exact;
        parameters.engine.active_set.keep_at_least = 10;
        parameters.engine.active_set.activate_margin = 0.4;  // room for a plan between two steps that are due
        parameters.engine.active_set.keep_margin = 0.45;
        parameters.engine.background = background;
        parameters.target_max_unseen = 2;
        JointFilter out(parameters, {});
        out.start({}, {{0, 0, 0}, Matrix3::Identity() * 1e-4});
        return out;
    }
};

const CompressedJointBank& bankOf(const JointFilter& filter) {
    return dynamic_cast<const CompressedJointBank&>(filter.state());
}

TEST_P(BackgroundMap, AWholeRunIsTheSameToTheBit) {
    test::LoopScene scene(5, 200);
    JointFilter ours = filter(true), theirs = filter(false);
    for (int step = 0; step < 480; ++step) {
        const OdometryIncrement odometry = scene.drive(step);
        const DetectionSet set = scene.look(step);
        for (JointFilter* each : {&ours, &theirs}) {
            each->predict(odometry);
            each->update(set);
        }
        ASSERT_EQ(ours.robot().mean.vector(), theirs.robot().mean.vector()) << step;
        ASSERT_EQ(ours.robot().covariance, theirs.robot().covariance) << step;
        // Seldom, since it waits.
        if (step % 60 == 59) {
            ASSERT_EQ(ours.jointCovariance().matrix, theirs.jointCovariance().matrix) << step;
        }
    }
    EXPECT_GT(bankOf(ours).commits(), 60) << "or there was nothing to do";
    EXPECT_GT(bankOf(ours).activations(), 20);
    EXPECT_EQ(bankOf(ours).commits(), bankOf(theirs).commits());
    EXPECT_EQ(bankOf(ours).activations(), bankOf(theirs).activations());
    EXPECT_EQ(bankOf(ours).unforeseen(), bankOf(theirs).unforeseen());
    EXPECT_EQ(bankOf(ours).memory(), bankOf(theirs).memory());
}

/// A bank through whatever the dice say, where the margins are too small for what is measured.
class Wanderer {
  public:
    Wanderer(const Form& form, bool background)
        : random_(31, RandomPurpose::test),
          weights_(Eigen::VectorXd::Constant(modesOf(form), 1.0 / modesOf(form))),
          bank_(std::make_unique<CompressedJointBank>(Vector3::Zero(), 0.01 * Matrix3::Identity(),
                                                      form.consistency, modesOf(form), policy(),
                                                      background)) {
        for (int i = 0; i < 60; ++i) {
            NewBlock landmark;
            landmark.mean = Vector2(random_.uniform(-3, 30), random_.uniform(-3, 3));
            landmark.G = randomMatrix(random_, 2, 3);
            landmark.own = randomCovariance(random_, 2);
            landmarks_.push_back(bank_->JointBank::augment(BlockKind::landmark, landmark));
        }
    }
    Wanderer(const Wanderer& other)
        : random_(other.random_),
          weights_(other.weights_),
          landmarks_(other.landmarks_),
          step_(other.step_),
          bank_(std::make_unique<CompressedJointBank>(*other.bank_)) {}

    void step() {
        ++step_;
        for (int i = 0; i < bank_->modeCount(); ++i) {
            const Vector3 pose(0.2 * std::min(step_ % 300, 300 - step_ % 300), 0, 0.01 * random_.normal());
            bank_->mode(i).propagate(robot_block, pose, Matrix3::Identity(),
                                     randomCovariance(random_, 3, 1e-3));
        }
        RangeBearingSet seen;
        seen.sensors.resize(1);
        seen.detections.resize(1);
        seen.detections.front().kind = ObjectKind::landmark;
        std::vector<BlockId> measured;
        if (random_.uniform() < 0.1) measured.push_back(any());
        bank_->attend({Pose2::fromVector(bank_->mode(0).mean(robot_block)), seen, measured}, weights_);
        update();
        if (random_.uniform() < 0.03) bank_->activate({any(), any()});
        if (random_.uniform() < 0.03) bank_->commit({any(), any(), any()}, weights_);
        if (random_.uniform() < 0.05 && landmarks_.size() > 30) {
            const BlockId gone = any();
            removed_away += bank_->active(gone) ? 0 : 1;
            bank_->remove(gone);
            landmarks_.erase(std::find(landmarks_.begin(), landmarks_.end(), gone));
        }
    }

    /// All there is, of one mode; waits.
    Eigen::MatrixXd all(int mode) const {
        std::vector<BlockId> blocks{robot_block};
        blocks.insert(blocks.end(), landmarks_.begin(), landmarks_.end());
        const Eigen::MatrixXd P = bank_->mode(mode).jointCovariance(blocks);
        Eigen::MatrixXd out(P.rows(), P.cols() + 1);
        out.leftCols(P.cols()) = P;
        Eigen::Index row = 0;
        for (const BlockId id : blocks) {
            const BlockVector mean = bank_->mode(mode).mean(id);
            out.col(P.cols()).segment(row, mean.size()) = mean;
            row += mean.size();
        }
        return out;
    }
    const CompressedJointBank& bank() const { return *bank_; }

    int removed_away = 0;

  private:
    static int modesOf(const Form& form) { return form.modes[0] == '\0' ? 1 : 2; }
    static ActiveSetParameters policy() {
        ActiveSetParameters parameters;
        parameters.range = 3;
        parameters.activate_margin = parameters.keep_margin = 0.5;
        parameters.keep_at_least = 4;
        return parameters;
    }

    BlockId any() {
        return landmarks_[static_cast<std::size_t>(
            random_.uniform(0, static_cast<double>(landmarks_.size())))];
    }
    void update() {
        std::vector<BlockId> objects;
        for (const BlockId id : bank_->landmarksWithinReach())
            if (random_.uniform() < 0.4) objects.push_back(id);
        for (int i = 0; i < bank_->modeCount(); ++i) {
            std::vector<LinearMeasurement> batch;
            for (const BlockId id : objects) {
                LinearMeasurement m;
                m.add(robot_block, randomMatrix(random_, 2, 3));
                m.add(id, randomMatrix(random_, 2, 2));
                m.residual = 0.01 * randomVector(random_, 2);
                m.R = Matrix2::Identity();
                batch.push_back(m);
            }
            bank_->mode(i).update(batch);
        }
    }

    RandomStream random_;
    Eigen::VectorXd weights_;
    std::vector<BlockId> landmarks_;
    int step_ = 0;
    std::unique_ptr<CompressedJointBank> bank_;
};

TEST_P(BackgroundMap, WhateverHappensIsTheSameToTheBit) {
    Wanderer ours(GetParam(), true), theirs(GetParam(), false);
    for (int step = 0; step < 600; ++step) {
        ours.step();
        theirs.step();
        for (int i = 0; i < ours.bank().modeCount(); ++i) {
            ASSERT_EQ(ours.bank().mode(i).mean(robot_block), theirs.bank().mode(i).mean(robot_block)) << step;
            if (step % 50 == 49) {
                ASSERT_EQ(ours.all(i), theirs.all(i)) << step;
            }
        }
    }
    const CompressedJointBank& bank = ours.bank();
    EXPECT_GT(bank.commits(), 30);
    EXPECT_GT(bank.unforeseen(), 10) << "measured while away";
    EXPECT_GT(bank.activations(), bank.unforeseen() + 10) << "prepared ahead";
    EXPECT_GT(bank.map().regroupings(), 2);
    EXPECT_GT(ours.removed_away, 5);
}

TEST_P(BackgroundMap, ACopyMadeWhileJobsWaitHasALifeOfItsOwn) {
    Wanderer ours(GetParam(), true), theirs(GetParam(), false);
    for (int step = 0; step < 200; ++step) {
        ours.step();
        theirs.step();
        if (step % 10 != 9) continue;
        Wanderer copy(ours);
        ASSERT_EQ(copy.all(0), theirs.all(0)) << step;
        Wanderer expected(theirs);
        for (int more = 0; more < 12; ++more) {
            copy.step();
            expected.step();
        }
        ASSERT_EQ(copy.all(0), expected.all(0)) << step;
    }
    EXPECT_EQ(ours.all(0), theirs.all(0)) << "the copies have changed nothing";
    EXPECT_GT(ours.bank().commits(), 8);
}

INSTANTIATE_TEST_SUITE_P(All, BackgroundMap,
                         testing::Values(Form{Consistency::classic, ""}, Form{Consistency::invariant, ""},
                                         Form{Consistency::invariant, "cv:cv:0.5, ca:ca:1.5"}),
                         [](const auto& each) {
                             return std::string(each.param.consistency == Consistency::classic
                                                    ? "classic"
                                                    : "invariant") +
                                    (each.param.modes[0] == '\0' ? "" : "Modes");
                         });

}  // namespace background_map_test
}  // namespace slamot
