// What all forms of a modal state do alike: landmarks that turn out to be one, movers less certain than
// thought, detections that are no outliers.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <stdexcept>

#include "FullMatrixState.h"
#include "ImmScenes.h"
#include "slamot/core/estimation/BankedImm.h"
#include "slamot/core/estimation/CompressedJointBank.h"
#include "slamot/core/estimation/DecoupledImm.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "slamot/core/estimation/ModalState.h"
#include "support/Expect.h"

namespace slamot {
namespace modal_state_test {

using test::near;

enum class Form { exact, banked, decoupled };
enum class Engine { dense, compressed };

std::unique_ptr<ModalState> make(Form form, const std::shared_ptr<const ModalSettings>& settings,
                                 std::unique_ptr<JointBank> bank) {
    if (form == Form::decoupled) return std::make_unique<DecoupledImm>(settings, std::move(bank));
    auto exact = std::make_unique<JointImm>(settings, std::move(bank));
    if (form == Form::exact) return exact;
    return std::make_unique<BankedImm>(settings, std::move(*exact));
}

/// A robot that has seen a mover of two modes and three landmarks for half a second, two of them 0.36 m
/// apart.
class ShortRun {
  public:
    ShortRun(Form form, Engine engine, Consistency consistency, OutlierTreatment outliers)
        : models_(modelsOf(test::immModes("cv:cv:0.3, ca:ca:4"))) {
        const ImmParameters imm = test::immModes("cv:cv:0.3, ca:ca:4");
        const auto settings = std::make_shared<const ModalSettings>(ModalSettings{
            {}, {outliers, 0.999}, chainOf(imm), initialProbabilities(imm), ModeLikelihood::conditional});
        const Matrix3 P = Vector3(0.04, 0.09, 0.01).asDiagonal();
        std::unique_ptr<JointBank> bank;
        if (engine == Engine::dense)
            bank = std::make_unique<DenseJointBank>(truth_.vector(), P, consistency);
        else
            bank = std::make_unique<CompressedJointBank>(truth_.vector(), P, consistency);
        bank_ = bank.get();
        state = make(form, settings, std::move(bank));
        for (const Vector2& at : places_)
            landmarks.push_back(state->addLandmark(
                firstSight(test::seen(truth_, at, ObjectKind::landmark, 0), {}, consistency)));
        target = state->addTarget(
            moverAt(firstSight(test::seen(truth_, {5, -5}, ObjectKind::mover, 0), {}, consistency), 2, 1));
        for (int k = 1; k <= 5; ++k) step(k);
    }

    void predict(int k) {
        const Pose2 move{0.3, 0, 0.05};
        truth_ = truth_ * move;
        state->predict(test::odometry(0.1 * (k - 1), 0.1 * k, move), models_);
    }
    Innovation sight(const RangeBearingDetection& detection, bool weighed) {
        const DetectionSet set = test::detectionsAt(0, {detection});
        std::vector<Innovation> innovations(1);
        KnownObjects known;
        known.targets.push_back({0, target, weighed});
        state->update(set.rangeBearing(), known, innovations);
        return innovations.front();
    }
    /// Beyond the reach of the sensors.
    void putAway(BlockId landmark) {
        bank_->commit({landmark}, Eigen::VectorXd::Constant(bank_->modeCount(), 1.0 / bank_->modeCount()));
    }
    Pose2 truth() const { return truth_; }

    std::unique_ptr<ModalState> state;
    std::vector<BlockId> landmarks;
    BlockId target = 0;

  private:
    void step(int k) {
        predict(k);
        std::vector<RangeBearingDetection> seen;
        KnownObjects known;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            known.landmarks.push_back({static_cast<int>(i), landmarks[i]});
            seen.push_back(test::seen(truth_, places_[i], ObjectKind::landmark, 0));
        }
        known.targets.push_back({3, target});
        const Vector2 mover(5 + 0.1 * k, -5 + 0.04 * k * k);
        seen.push_back(test::seen(truth_, mover, ObjectKind::mover, 0));
        for (RangeBearingDetection& d : seen) d.range += 0.1 * random_.normal();
        std::vector<Innovation> innovations(seen.size());
        state->update(test::detectionsAt(0.1 * k, seen).rangeBearing(), known, innovations);
    }

    const std::vector<Vector2> places_{{6, 1}, {6.2, 1.3}, {-4, 3}};
    RandomStream random_{64, RandomPurpose::test};
    Pose2 truth_{1, -2, 0.7};
    std::vector<TargetModel> models_;
    JointBank* bank_;
};

/// A mode's Gaussian over all blocks of the bank, in full.
test::FullMatrixState fullOf(const JointMode& mode, const JointBank& bank,
                             const std::vector<BlockId>& blocks) {
    test::FullMatrixState out(Vector3::Zero(), Matrix3::Zero());
    std::vector<double> x;
    out.blocks.clear();
    for (const BlockId block : blocks) {
        const BlockVector mean = mode.mean(block);
        out.blocks[block] = {bank.kind(block), static_cast<int>(mean.size())};
        x.insert(x.end(), mean.data(), mean.data() + mean.size());
    }
    out.x = Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
    out.P = mode.jointCovariance(blocks);
    return out;
}

void forAll(const std::function<void(Form, Engine, Consistency)>& check) {
    for (const Form form : {Form::exact, Form::banked, Form::decoupled})
        for (const Engine engine : {Engine::dense, Engine::compressed})
            for (const Consistency consistency : {Consistency::classic, Consistency::invariant}) {
                SCOPED_TRACE(testing::Message()
                             << "form " << static_cast<int>(form) << ", engine " << static_cast<int>(engine)
                             << ", consistency " << static_cast<int>(consistency));
                check(form, engine, consistency);
            }
}

TEST(ModalStateTest, MergingLandmarksConditionsEveryModeOnTheirBeingOne) {
    forAll([](Form form, Engine engine, Consistency consistency) {
        ShortRun run(form, engine, consistency, OutlierTreatment::accept);
        ModalState& state = *run.state;
        const BlockId kept = run.landmarks[0], gone = run.landmarks[1], away = run.landmarks[2];
        run.putAway(away);
        std::vector<BlockId> blocks{robot_block, kept, gone, away};
        if (form != Form::decoupled) blocks.push_back(run.target);  // the last
        const double deviation = 0.02;

        std::vector<test::FullMatrixState> expected;
        for (int j = 0; j < state.bank().modeCount(); ++j) {
            expected.push_back(fullOf(state.bank().mode(j), state.bank(), blocks));
            test::FullMatrixState& full = expected.back();
            LinearMeasurement same;
            same.add(kept, Matrix2::Identity());
            same.add(gone, -Matrix2::Identity());
            same.residual = -(full.x.segment<2>(full.offset(kept)) - full.x.segment<2>(full.offset(gone)));
            ASSERT_GT(same.residual.norm(), 0.2);
            same.R = deviation * deviation * Matrix2::Identity();
            full.update({same}, consistency);
            // Before the block goes: the two are one but for the deviation.
            const Vector2 apart = full.x.segment<2>(full.offset(kept)) - full.x.segment<2>(full.offset(gone));
            ASSERT_LT(apart.norm(), 0.05);
            full.remove(gone);
        }
        state.mergeLandmarks(kept, gone, deviation);
        blocks.erase(blocks.begin() + 2);
        ASSERT_EQ(state.bank().modeCount(), form == Form::exact ? 2 : 1);
        for (int j = 0; j < state.bank().modeCount(); ++j) {
            const test::FullMatrixState value = fullOf(state.bank().mode(j), state.bank(), blocks);
            const auto& full = expected[static_cast<std::size_t>(j)];
            EXPECT_TRUE(near(value.x, full.x, 1e-10));  // rounding, times the condition of S
            EXPECT_TRUE(near(value.P, full.P, 1e-10));
        }
        EXPECT_THROW(state.mean(gone), std::out_of_range);
        EXPECT_THROW(state.covariance(kept, gone), std::out_of_range);
    });
}

TEST(ModalStateTest, AMoversBankFollowsWhatMergingDoesToIt) {
    for (const Consistency consistency : {Consistency::classic, Consistency::invariant}) {
        ShortRun run(Form::banked, Engine::dense, consistency, OutlierTreatment::accept);
        ModalState& state = *run.state;
        const Vector6 joint = state.mean(run.target);
        const Matrix6 P = state.covariance(run.target, run.target);
        const TargetBelief before = state.target(run.target);
        state.mergeLandmarks(run.landmarks[0], run.landmarks[1], 0.02);
        const Vector6 moved = state.mean(run.target);
        ASSERT_GT((moved - joint).norm(), 1e-3) << "or there is nothing to follow";
        const Matrix6 L = covarianceMap(P, state.covariance(run.target, run.target));
        const TargetBelief after = state.target(run.target);
        EXPECT_TRUE(near(after.mean, moved + L * (before.mean - joint), 1e-10));
        EXPECT_TRUE(near(after.covariance, L * before.covariance * L.transpose(), 1e-10));
    }
}

TEST(ModalStateTest, WideningAMoverAddsToItsCovarianceAndNothingElse) {
    forAll([](Form form, Engine engine, Consistency consistency) {
        ShortRun run(form, engine, consistency, OutlierTreatment::accept);
        ModalState& state = *run.state;
        const TargetBelief before = state.target(run.target);
        const Eigen::MatrixXd robot_before = state.covariance(robot_block, robot_block),
                              cross = state.covariance(run.target, robot_block),
                              map = state.covariance(run.landmarks[0], run.landmarks[2]);
        const Matrix6 joint = state.covariance(run.target, run.target);
        const BlockVector mean = state.mean(run.target);
        const Matrix6 Q = (Vector6() << 0.3, 0.2, 0.1, 0.4, 0.5, 0.6).finished().asDiagonal();
        state.widenTarget(run.target, Q);
        const TargetBelief after = state.target(run.target);
        EXPECT_TRUE(near(after.mean, before.mean, 1e-12));
        EXPECT_TRUE(near(after.covariance, before.covariance + Q, 1e-12));
        EXPECT_TRUE(near(after.mode_probabilities, before.mode_probabilities, 1e-15));
        EXPECT_TRUE(near(state.mean(run.target), mean, 1e-12));
        EXPECT_TRUE(near(state.covariance(run.target, run.target), joint + Q, 1e-12));
        EXPECT_TRUE(near(state.covariance(run.target, robot_block), cross, 1e-12));
        EXPECT_TRUE(near(state.covariance(robot_block, robot_block), robot_before, 1e-12));
        EXPECT_TRUE(near(state.covariance(run.landmarks[0], run.landmarks[2]), map, 1e-12));
        // Bank and joint state are in step still: a look that shows nothing does not widen it again.
        std::vector<Innovation> none;
        state.update(test::detectionsAt(0.5, {}).rangeBearing(), {}, none);
        EXPECT_TRUE(near(state.target(run.target).covariance, after.covariance, 1e-10));
    });
}

TEST(ModalStateTest, WhatWasWeighedIsNoOutlier) {
    forAll([](Form form, Engine engine, Consistency consistency) {
        RangeBearingDetection far;
        for (const bool weighed : {false, true}) {
            ShortRun strict(form, engine, consistency, OutlierTreatment::reject),
                lenient(form, engine, consistency, OutlierTreatment::accept);
            far = test::seen(strict.truth(), {9, -1}, ObjectKind::mover, 0);
            const Vector6 before = strict.state->target(strict.target).mean;
            const Innovation innovation = strict.sight(far, weighed);
            EXPECT_GT(innovation.nis, 13.9);
            EXPECT_EQ(innovation.outcome, weighed ? Outcome::updated : Outcome::rejected);
            if (weighed) lenient.sight(far, false);
            EXPECT_TRUE(near(strict.state->target(strict.target).mean,
                             weighed ? lenient.state->target(strict.target).mean : before, 1e-9));
            if (weighed) {
                EXPECT_GT((strict.state->target(strict.target).mean - before).norm(), 0.1);
            }
        }
    });
}

}  // namespace modal_state_test
}  // namespace slamot
