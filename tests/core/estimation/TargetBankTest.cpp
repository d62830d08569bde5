// The scalable form: the bank's four steps, and where it must equal the exact form.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "ImmScenes.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "slamot/core/estimation/RangeBearingUpdate.h"
#include "slamot/core/estimation/RobotTargetView.h"
#include "slamot/core/estimation/TargetBank.h"
#include "slamot/core/filter/JointFilter.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace target_bank_test {

using test::immModes;
using test::ImmScene;
using test::near;
using test::randomCovariance;
using test::randomVector;

Matrix6 turnOf(double angle) {
    Matrix6 R = Matrix6::Zero();
    for (int k = 0; k < 6; k += 2) R.block<2, 2>(k, k) = rotation(angle);
    return R;
}

TEST(CovarianceMapTest, MapsTurnsAndScales) {
    RandomStream random(41, RandomPurpose::test);
    const Matrix6 units = (Vector6() << 1, 1, 20, 20, 0.03, 0.03).finished().asDiagonal();
    for (int i = 0; i < 20; ++i) {
        const Matrix6 from = randomCovariance(random, 6), to = randomCovariance(random, 6);
        const Matrix6 L = covarianceMap(from, to);
        EXPECT_TRUE(near(L * from * L.transpose(), to, 1e-11));
        EXPECT_TRUE(near(covarianceMap(from, from), Matrix6::Identity(), 1e-11));
        const Matrix6 R = turnOf(0.7 * i);
        EXPECT_TRUE(near(covarianceMap(R * from * R.transpose(), R * to * R.transpose()),
                         R * L * R.transpose(), 1e-10));
        EXPECT_TRUE(near(covarianceMap(units * from * units, units * to * units), units * L * units.inverse(),
                         1e-10));
    }
}

TEST(CovarianceMapTest, ComponentsWithoutVariance) {
    RandomStream random(42, RandomPurpose::test);
    Matrix6 from = randomCovariance(random, 6), to = randomCovariance(random, 6);
    for (Matrix6* P : {&from, &to}) {  // no acceleration, as in cv and ct
        P->rightCols<2>().setZero();
        P->bottomRows<2>().setZero();
    }
    const Matrix6 L = covarianceMap(from, to);
    EXPECT_TRUE(near(L * from * L.transpose(), to, 1e-11));
    EXPECT_TRUE(L.bottomRows<2>().isZero(0));
    EXPECT_TRUE(covarianceMap(Matrix6::Zero(), Matrix6::Zero()).isZero(0));
}

/// A bank of two random modes in step with a joint state of robot and one target.
class BankTest : public testing::Test {
  protected:
    BankTest() : random_(43, RandomPurpose::test) {
        for (int j = 0; j < 2; ++j)
            modes_.push_back({(Vector6() << 5, 2, 1, 0, 0, 0).finished() + 0.3 * randomVector(random_, 6),
                              randomCovariance(random_, 6, 0.05)});
    }
    TargetBank bank() const { return {mu_, modes_}; }
    TargetGaussian merged() const {
        const Vector6 mean = mu_(0) * modes_[0].mean + mu_(1) * modes_[1].mean;
        Matrix6 P = Matrix6::Zero();
        for (int j = 0; j < 2; ++j) {
            const Vector6 d = modes_[j].mean - mean;
            P += mu_(j) * (modes_[j].covariance + d * d.transpose());
        }
        return {mean, P};
    }
    /// Robot uncertain and correlated with the target, whose marginal is the bank's.
    DenseJointBank joint(Consistency consistency) const {
        const TargetGaussian target = merged();
        DenseJointBank out(Vector3(1, -1, 0.4), Matrix3::Identity() * 0.05, consistency);
        Eigen::Matrix<double, 6, 3> G = Eigen::Matrix<double, 6, 3>::Zero();
        G.topRows<3>() = 0.5 * Matrix3::Identity();
        out.augment(BlockKind::target, {target.mean, G, target.covariance - 0.05 * G * G.transpose()});
        return out;
    }

    RandomStream random_;
    Eigen::Vector2d mu_{0.3, 0.7};
    std::vector<TargetGaussian> modes_;
};

TEST_F(BankTest, SynchronisingTakesOverTheJointMarginal) {
    TargetBank bank = this->bank();
    const TargetGaussian moved{merged().mean + randomVector(random_, 6), randomCovariance(random_, 6, 0.1)};
    bank.synchronise(moved);
    EXPECT_TRUE(near(bank.merged().mean, moved.mean, 1e-12));
    EXPECT_TRUE(near(bank.merged().covariance, moved.covariance, 1e-12));
    EXPECT_EQ(bank.probabilities(), Eigen::VectorXd(mu_));
}

TEST_F(BankTest, PredictionMovesTheJointBlockToTheMergedMoments) {
    // Mixing keeps the merged moments, and prediction is linear: by the law of total covariance the block
    // that follows x <- mean, P <- Phi P Phi^t + Q must have what the bank then has, and Phi P the covariance
    // of after with before, here by summing over the mixed modes.
    const std::vector<TargetModel> models{{TargetModelKind::cv, 0.4, 0.1}, {TargetModelKind::ca, 2.0, 0.1}};
    const Eigen::Matrix2d p = (Eigen::Matrix2d() << 0.9, 0.1, 0.2, 0.8).finished();
    TargetBank bank = this->bank();
    const TargetGaussian before = merged();
    const BlockPrediction f = bank.predict(p, models, 0.3, before.mean);
    const TargetGaussian after = bank.merged();
    EXPECT_TRUE(near(f.mean, after.mean, 1e-12));
    EXPECT_TRUE(near(f.Phi * before.covariance * f.Phi.transpose() + f.Q, after.covariance, 1e-11));
    EXPECT_NEAR(bank.probabilities()(0), 0.3 * 0.9 + 0.7 * 0.2, 1e-15);

    // E[after before^t] over pairs (i, j) with probability mu_i p_ij, before approximated by j's mixture.
    Matrix6 X = Matrix6::Zero();
    for (int j = 0; j < 2; ++j) {
        const double c = mu_(0) * p(0, j) + mu_(1) * p(1, j);
        Vector6 m = Vector6::Zero();
        for (int i = 0; i < 2; ++i) m += mu_(i) * p(i, j) / c * modes_[i].mean;
        Matrix6 P = Matrix6::Zero();
        for (int i = 0; i < 2; ++i) {
            const Vector6 d = modes_[i].mean - m;
            P += mu_(i) * p(i, j) / c * (modes_[i].covariance + d * d.transpose());
        }
        const TargetPrediction A = predictTarget(models[j], m, 0.3);
        X += c * (A.F * P + (A.mean - after.mean) * (m - before.mean).transpose());
    }
    EXPECT_TRUE(near(f.Phi * before.covariance, X, 1e-11));
    // A joint mean apart from the bank's stays apart, as Phi carries it.
    TargetBank apart = this->bank();
    const Vector6 shift = 0.1 * randomVector(random_, 6);
    EXPECT_TRUE(
        near(apart.predict(p, models, 0.3, before.mean + shift).mean, after.mean + f.Phi * shift, 1e-12));
}

TEST_F(BankTest, EqualModesMeasureWhatTheJointStateDoes) {
    // Where every mode is the joint marginal, each mode's update is the joint EKF's.
    for (const Consistency consistency : {Consistency::classic, Consistency::invariant}) {
        DenseJointBank joint = this->joint(consistency);
        JointMode& ekf = joint.mode(0);
        const BlockId target = 1;
        TargetBank bank(mu_, {merged(), merged()});
        const RangeBearingDetection seen =
            test::seen({1.1, -1, 0.45}, merged().mean.head<2>() + Vector2(0.2, 0.1), ObjectKind::mover, 0);
        std::vector<Linearisation> by_mode;
        const RobotGivenTarget robot(ekf, target);
        bank.linearise(robot, seen, {}, consistency, by_mode);
        const Linearisation whole = linearise(ekf, target, seen, {}, consistency);
        ASSERT_EQ(by_mode.size(), 2u);
        EXPECT_TRUE(near(by_mode[0].S, whole.S, 1e-12));
        EXPECT_TRUE(near(by_mode[0].measurement.residual, whole.measurement.residual, 1e-12));
        bank.update(robot, by_mode, consistency);
        ekf.update({whole.measurement});
        EXPECT_TRUE(near(bank.merged().mean, Vector6(ekf.mean(target)), 1e-12));
        EXPECT_TRUE(near(bank.merged().covariance, Matrix6(ekf.covariance(target, target)), 1e-12));
        EXPECT_TRUE(near(bank.probabilities(), mu_, 1e-12));
    }
}

TEST_F(BankTest, ModesAreLikelyByTheirInnovations) {
    // Robot known, so that a mode's likelihood is that of its own S alone.
    const TargetGaussian all = merged();
    DenseJointBank joint(Vector3::Zero(), Matrix3::Zero(), Consistency::classic);
    const BlockId target = joint.augment(
        BlockKind::target, NewBlock{all.mean, Eigen::Matrix<double, 6, 3>::Zero(), all.covariance});
    TargetBank bank = this->bank();
    const RangeBearingDetection seen =
        test::seen({}, modes_[1].mean.head<2>() + Vector2(0.1, 0), ObjectKind::mover, 0);
    std::vector<Linearisation> by_mode;
    const RobotGivenTarget robot(joint.mode(0), target);
    bank.linearise(robot, seen, {}, Consistency::classic, by_mode);
    bank.update(robot, by_mode, Consistency::classic);
    double weight[2];
    for (int j = 0; j < 2; ++j) {
        const RangeBearingPrediction h = predictRangeBearing(Vector3::Zero(), modes_[j].mean.head<2>(), {});
        const Matrix2 S =
            h.H_point * modes_[j].covariance.topLeftCorner<2, 2>() * h.H_point.transpose() + seen.covariance;
        const Vector2 nu = rangeBearingResidual(seen.z(), h.z);
        weight[j] = mu_(j) * std::exp(-0.5 * nu.dot(S.inverse() * nu)) / std::sqrt(S.determinant());
    }
    EXPECT_NEAR(bank.probabilities()(0), weight[0] / (weight[0] + weight[1]), 1e-12);
}

TEST_F(BankTest, TheGuardLeadsBackOnlyWhatHasParted) {
    const TargetGaussian all = merged();
    const Matrix6 L = all.covariance.llt().matrixL();
    // e^t P^-1 e is 3.9 and 4.1.
    for (const double squared : {3.9, 4.1}) {
        const TargetGaussian joint{all.mean + L.col(0) * std::sqrt(squared), all.covariance};
        TargetBank bank = this->bank();
        bank.guard(joint);
        EXPECT_TRUE(near(bank.merged().mean, squared < 4 ? all.mean : joint.mean, 1e-12)) << squared;
    }
    const TargetGaussian elsewhere{all.mean + 100 * Vector6::Ones(), randomCovariance(random_, 6)};
    TargetBank bank = this->bank();
    bank.guard(elsewhere);
    EXPECT_TRUE(near(bank.merged().covariance, elsewhere.covariance, 1e-11));
}

JointFilterParameters parametersOf(const std::string& modes, ImmForm form, Consistency consistency) {
    JointFilterParameters parameters;
    parameters.consistency = consistency;
    parameters.imm = immModes(modes);
    parameters.imm.form = form;
    parameters.target_max_unseen = 0.75;
    return parameters;
}

TEST(BankedImmTest, IsExactWhereTheRobotIsKnown) {
    // A robot that stands and knows where: nothing couples target and map, and the bank is the whole IMM. The
    // exact form's likelihood is the same whether conditional on landmarks or not.
    for (const Consistency consistency : {Consistency::classic, Consistency::invariant}) {
        const std::string modes = "cv:cv:0.3, left:ct:0.3:40, ca:ca:2";
        JointFilter exact(parametersOf(modes, ImmForm::exact, consistency), {}),
            scalable(parametersOf(modes, ImmForm::scalable, consistency), {});
        RandomStream random(44, RandomPurpose::test);
        for (JointFilter* filter : {&exact, &scalable}) filter->start({}, {{1, 2, 0.5}, Matrix3::Zero()});
        for (int k = 0; k < 80; ++k) {
            const double t = 0.1 * k;
            std::vector<RangeBearingDetection> seen{
                test::seen({1, 2, 0.5}, Vector2(6 + t, 2 + std::sin(t)), ObjectKind::mover, 0),
                test::seen({1, 2, 0.5}, Vector2(4, -3), ObjectKind::landmark, 0)};
            if (k % 5 > 0)
                seen.push_back(test::seen({1, 2, 0.5}, Vector2(-5 + t * t / 8, 4), ObjectKind::mover, 1));
            for (RangeBearingDetection& d : seen) d.range += 0.1 * random.normal();
            for (JointFilter* filter : {&exact, &scalable}) {
                if (k > 0) filter->predict(test::odometry(t - 0.1, t, {}));
                filter->update(test::detectionsAt(t, seen));
            }
            const auto a = exact.tracks(), b = scalable.tracks();
            for (std::size_t i = 0; i < a.size(); ++i) {
                ASSERT_TRUE(near(b[i].mean, a[i].mean, 1e-8)) << k;
                ASSERT_TRUE(near(b[i].covariance, a[i].covariance, 1e-8)) << k;
                for (int j = 0; j < 3; ++j)
                    ASSERT_NEAR(b[i].mode_probabilities[j], a[i].mode_probabilities[j], 1e-8) << k;
            }
        }
    }
}

TEST(BankedImmTest, OneModeIsTheEkfWhereMoversAndLandmarksAreSeenInTurns) {
    // Movers are taken in one after another, linearised anew: equal to the EKF's batch where a batch is one
    // mover.
    for (const Consistency consistency : {Consistency::classic, Consistency::invariant}) {
        JointFilter ekf(parametersOf("ca:ca:1.2", ImmForm::exact, consistency), {}),
            scalable(parametersOf("ca:ca:1.2", ImmForm::scalable, consistency), {});
        ImmScene scene;
        for (JointFilter* filter : {&ekf, &scalable}) filter->start({}, scene.start());
        for (int k = 0; k < 60; ++k) {
            ImmScene::Step step = scene.next();
            auto& seen = std::get<RangeBearingSet>(step.detections.measurements).detections;
            std::vector<RangeBearingDetection> some;
            for (const RangeBearingDetection& d : seen)
                if (k % 2 == 0 ? d.kind == ObjectKind::landmark : d.kind == ObjectKind::mover)
                    some.push_back(d);
            seen = some;
            for (JointFilter* filter : {&ekf, &scalable}) {
                filter->predict(step.odometry);
                filter->update(step.detections);
            }
            ASSERT_TRUE(near(scalable.jointCovariance().matrix, ekf.jointCovariance().matrix, 1e-9)) << k;
            const auto a = ekf.tracks(), b = scalable.tracks();
            ASSERT_EQ(a.size(), b.size());
            for (std::size_t i = 0; i < a.size(); ++i) {
                ASSERT_TRUE(near(b[i].mean, a[i].mean, 1e-9)) << k;
                ASSERT_TRUE(near(b[i].covariance, a[i].covariance, 1e-9)) << k;
            }
        }
    }
}

TEST(BankedImmTest, GoesOnWhereTheExactFormStands) {
    // The third mover turns the exact form into the scalable one; what is known of the first two does not
    // change.
    JointFilterParameters parameters =
        parametersOf("cv:cv:0.3, ca:ca:2", ImmForm::automatic, Consistency::invariant);
    JointFilter filter(parameters, {});
    ImmScene scene;
    filter.start({}, scene.start());
    for (int k = 0; k < 18; ++k) {
        const ImmScene::Step step = scene.next();
        filter.predict(step.odometry);
        filter.update(step.detections);
    }
    ASSERT_EQ(filter.state().modeCount(), 4);
    const PoseGaussian robot = filter.robot();
    const auto before = filter.tracks();
    const Eigen::MatrixXd joint = filter.jointCovariance().matrix;
    filter.update(test::detectionsAt(1.8, {test::seen({}, {3, 3}, ObjectKind::mover, 7)}));
    ASSERT_EQ(filter.state().modeCount(), 1);
    const auto after = filter.tracks();
    ASSERT_EQ(after.size(), 3u);
    EXPECT_TRUE(near(filter.robot().mean.vector(), robot.mean.vector(), 1e-12));
    EXPECT_TRUE(
        near(filter.jointCovariance().matrix.topLeftCorner<15, 15>(), joint.topLeftCorner<15, 15>(), 1e-12));
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_TRUE(near(after[i].mean, before[i].mean, 1e-10));
        EXPECT_TRUE(near(after[i].covariance, before[i].covariance, 1e-10));
        for (int j = 0; j < 2; ++j)
            EXPECT_NEAR(after[i].mode_probabilities[j], before[i].mode_probabilities[j], 1e-12);
    }
}

}  // namespace target_bank_test
}  // namespace slamot
