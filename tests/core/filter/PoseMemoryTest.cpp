// Landmarks taken in late, from the poses that saw them first, against filters that had them from the start.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <functional>
#include <memory>

#include "../estimation/ImmScenes.h"
#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/estimation/BankedImm.h"
#include "slamot/core/estimation/CompressedJointBank.h"
#include "slamot/core/estimation/DecoupledImm.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "slamot/core/filter/PoseMemory.h"
#include "support/Expect.h"

namespace slamot {
namespace pose_memory_test {

using test::near;

enum class Form { exact, banked, decoupled };
enum class Engine { dense, compressed };

struct Case {
    Form form;
    Engine engine;
    Consistency consistency;
};

void forAll(const std::vector<Consistency>& cores, const std::function<void(const Case&)>& check) {
    for (const Form form : {Form::exact, Form::banked, Form::decoupled})
        for (const Engine engine : {Engine::dense, Engine::compressed})
            for (const Consistency consistency : cores) {
                SCOPED_TRACE(testing::Message()
                             << "form " << static_cast<int>(form) << ", engine " << static_cast<int>(engine)
                             << ", consistency " << static_cast<int>(consistency));
                check({form, engine, consistency});
            }
}

RobotMotionParameters increments(double scale = 1) {
    RobotMotionParameters motion;
    motion.model = RobotMotionModel::increment;
    for (double* noise : {&motion.along_std_per_sqrt_m, &motion.across_std_per_sqrt_m,
                          &motion.heading_std_per_sqrt_m, &motion.heading_std_per_sqrt_rad})
        *noise *= scale;
    return motion;
}

constexpr double dt = 0.2;
Stamp at(int step) {
    return Stamp::fromSeconds(dt * step);
}

/// A robot that turns through heading pi among three landmarks and a mover that stands. A fourth landmark is
/// seen at steps 4 to 8; at 8 it is known to be one.
class LateLandmark {
  public:
    /// noise: 0, or what the noise of everything that has any is multiplied by.
    LateLandmark(const Case& c, double noise, bool late, bool stray = false)
        : noise_(noise),
          assumed_(noise > 0 ? noise : 1),
          late_(late),
          stray_(stray),
          consistency_(c.consistency),
          // Modes that are equal: what mixing makes of different ones is no linearisation error.
          modes_(test::immModes("a:cv:0.3, b:cv:0.3")) {
        for (TargetMode& mode : modes_.modes) mode.model.noise_std *= assumed_;
        const auto settings =
            std::make_shared<const ModalSettings>(ModalSettings{increments(assumed_),
                                                                {},
                                                                chainOf(modes_),
                                                                initialProbabilities(modes_),
                                                                ModeLikelihood::conditional});
        const Matrix3 P = assumed_ * assumed_ * Vector3(0.04, 0.09, 0.01).asDiagonal().toDenseMatrix();
        std::unique_ptr<JointBank> bank;
        if (c.engine == Engine::dense)
            bank = std::make_unique<DenseJointBank>(truth_.vector(), P, c.consistency);
        else
            bank = std::make_unique<CompressedJointBank>(truth_.vector(), P, c.consistency);
        bank_ = bank.get();
        if (c.form == Form::decoupled) {
            belief = std::make_unique<DecoupledImm>(settings, std::move(bank));
        } else {
            auto exact = std::make_unique<JointImm>(settings, std::move(bank));
            if (c.form == Form::exact)
                belief = std::move(exact);
            else
                belief = std::make_unique<BankedImm>(settings, std::move(*exact));
        }
        for (const Vector2& place : places_) landmarks.push_back(add(look(place, ObjectKind::landmark)));
        target = belief->addTarget(
            moverAt(firstSight(look({5, -5}, ObjectKind::mover), {}, consistency_), 2 * assumed_, assumed_));
        for (int k = 1; k <= 8; ++k) step(k);
    }

    /// All there is but remembered poses; in the decoupled form without the mover, of which the landmark's
    /// late coming changed what it took the robot's covariance for.
    std::vector<BlockId> blocks() const {
        std::vector<BlockId> out{robot_block};
        if (!dynamic_cast<DecoupledImm*>(belief.get())) out.push_back(target);
        out.insert(out.end(), landmarks.begin(), landmarks.end());
        return out;
    }
    Eigen::VectorXd means() const {
        std::vector<double> out;
        for (const BlockId block : blocks()) {
            const BlockVector mean = belief->mean(block);
            out.insert(out.end(), mean.data(), mean.data() + mean.size());
        }
        return Eigen::Map<Eigen::VectorXd>(out.data(), static_cast<Eigen::Index>(out.size()));
    }
    Eigen::MatrixXd covariance() const { return belief->jointCovariance(blocks()); }

    std::unique_ptr<ModalState> belief;
    std::vector<BlockId> landmarks;  ///< the one that came late at the end
    BlockId target = 0;
    PoseMemory poses;

  private:
    RangeBearingDetection look(const Vector2& place, ObjectKind kind) {
        RangeBearingDetection d = test::seen(truth_, place, kind, 0);
        d.covariance *= assumed_ * assumed_;
        d.range += noise_ * 0.1 * random_.normal();
        d.bearing = wrapAngle(d.bearing + noise_ * 0.02 * random_.normal());
        return d;
    }
    BlockId add(const RangeBearingDetection& d) {
        return belief->addLandmark(firstSight(d, {}, consistency_));
    }

    void step(int k) {
        const Pose2 move{0.4, 0, 0.06};
        truth_ = truth_ * move;
        const Pose2 error{noise_ * 0.02 * random_.normal(), noise_ * 0.005 * random_.normal(),
                          noise_ * 0.02 * random_.normal()};
        belief->predict(test::odometry(dt * (k - 1), dt * k, move * error), modelsOf(modes_));

        std::vector<RangeBearingDetection> seen;
        KnownObjects known;
        std::vector<BlockId> measured;
        const auto know = [&](std::vector<KnownObjects::Sight>& list, BlockId block, const Vector2& place,
                              ObjectKind kind) {
            list.push_back({static_cast<int>(seen.size()), block});
            seen.push_back(look(place, kind));
            measured.push_back(block);
        };
        for (std::size_t i = 0; i < places_.size(); ++i)
            if (i != 2 || k % 3 == 0) know(known.landmarks, landmarks[i], places_[i], ObjectKind::landmark);
        know(known.targets, target, {5, -5}, ObjectKind::mover);
        const bool fourth = k >= 4;
        const RangeBearingDetection sight = look({-2, 6}, ObjectKind::landmark);
        if (fourth && !late_ && k > 4) {
            known.landmarks.push_back({static_cast<int>(seen.size()), landmarks.back()});
            seen.push_back(sight);
            measured.push_back(landmarks.back());
        }
        const DetectionSet set = test::detectionsAt(dt * k, seen);
        belief->attend(set.rangeBearing(), measured);
        std::vector<Innovation> innovations(seen.size());
        belief->update(set.rangeBearing(), known, innovations);

        if (fourth && !late_ && k == 4) landmarks.push_back(add(sight));
        if (fourth && late_) sights_.push_back({at(k), sight, {}});
        if (late_ && k == 8) takeIn(k);
        if (late_) poses.remember(*belief, at(k));
        // The map may be put away at any time; poses stay.
        if (dynamic_cast<CompressedJointBank*>(bank_) && late_ && k != 8)
            bank_->commit({landmarks[2]},
                          Eigen::VectorXd::Constant(bank_->modeCount(), 1.0 / bank_->modeCount()));
    }

    struct Sight {
        Stamp when;
        RangeBearingDetection detection;
        Pose2 sensor;
    };
    void takeIn(int now) {
        std::vector<PastSight> past;
        for (const Sight& s : sights_)
            past.push_back(
                {s.when == at(now) ? robot_block : poses.at(s.when).value(), s.detection, s.sensor});
        if (stray_) {  // of something 3 m behind
            past.insert(past.begin() + 2, past[1]);
            past[2].detection.range += 3;
        }
        landmarks.push_back(belief->addLandmark(past, chiSquareQuantile(0.999, 2)));
    }

    const std::vector<Vector2> places_{{6, 1}, {3, -4}, {-4, 3}};
    double noise_, assumed_;
    bool late_, stray_;
    Consistency consistency_;
    ImmParameters modes_;
    RandomStream random_{64, RandomPurpose::test};
    Pose2 truth_{1, -2, 2.9};
    JointBank* bank_;
    std::vector<Sight> sights_;
};

TEST(PoseMemoryTest, NothingIsLostByTakingALandmarkInLate) {
    // Detections without noise leave every mean where it is, so both linearise at the truth: the same linear
    // problem, solved in another order, whatever the noise that is assumed. Only the classic core:
    // second-order terms move the means.
    forAll({Consistency::classic}, [](const Case& c) {
        const LateLandmark late(c, 0, true);
        const LateLandmark from_the_start({c.form, Engine::dense, c.consistency}, 0, false);
        ASSERT_EQ(late.landmarks.size(), 4u);
        EXPECT_TRUE(near(late.means(), from_the_start.means(), 1e-10));
        EXPECT_TRUE(near(late.covariance(), from_the_start.covariance(), 1e-10));
        EXPECT_GT(late.covariance()(0, 0), 1e-3) << "the robot is not known anyway";
    });
}

TEST(PoseMemoryTest, WithNoiseTheDifferenceIsLinearisationError) {
    // What linearisation neglects is of second order: in standard deviations it is in proportion to the
    // noise.
    forAll({Consistency::classic, Consistency::invariant}, [](const Case& c) {
        for (const double noise : {1.0, 0.01}) {
            const LateLandmark late(c, noise, true);
            const LateLandmark from_the_start({c.form, Engine::dense, c.consistency}, noise, false);
            const Eigen::MatrixXd P = from_the_start.covariance(), Q = late.covariance();
            const Eigen::ArrayXd std = P.diagonal().cwiseSqrt().cwiseMax(1e-9);  // no acceleration: 0
            EXPECT_LT(((late.means() - from_the_start.means()).array() / std).abs().maxCoeff(), 0.5 * noise);
            EXPECT_LT(((Q - P).array() / (std.matrix() * std.matrix().transpose()).array()).abs().maxCoeff(),
                      0.5 * noise);
            const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Q);
            EXPECT_GT(eigen.eigenvalues()(0), -1e-12 * eigen.eigenvalues().maxCoeff());
        }
    });
}

TEST(PoseMemoryTest, ASightOfSomethingElseIsLeftOut) {
    forAll({Consistency::classic, Consistency::invariant}, [](const Case& c) {
        const LateLandmark clean(c, 0, true), strayed(c, 0, true, true);
        EXPECT_EQ(strayed.means(), clean.means());
        EXPECT_EQ(strayed.covariance(), clean.covariance());
    });
}

TEST(PoseMemoryTest, AForgottenSightIsNone) {
    forAll({Consistency::invariant}, [](const Case& c) {
        LateLandmark run(c, 1, true);
        // Six are kept of 1 to 8.
        for (int k = 1; k <= 8; ++k) EXPECT_EQ(run.poses.at(at(k)).has_value(), k > 2) << k;
        EXPECT_FALSE(run.poses.at(Stamp{1}));
        run.poses.clear();
        EXPECT_FALSE(run.poses.at(at(8)));
    });
}

/// Two modes whose robots head to either side of pi.
class AcrossPi {
  public:
    AcrossPi(Engine engine, Consistency consistency) : modes_(test::immModes("cv:cv:0.3, ca:ca:2")) {
        const auto settings = std::make_shared<const ModalSettings>(ModalSettings{
            increments(), {}, chainOf(modes_), initialProbabilities(modes_), ModeLikelihood::conditional});
        const Vector3 pose(1, -2, pi - 0.01);
        const Matrix3 P =
            (Matrix3() << 0.04, 0.01, 0.002, 0.01, 0.09, -0.003, 0.002, -0.003, 0.01).finished();
        std::unique_ptr<JointBank> bank;
        if (engine == Engine::dense)
            bank = std::make_unique<DenseJointBank>(pose, P, consistency);
        else
            bank = std::make_unique<CompressedJointBank>(pose, P, consistency);
        bank_ = bank.get();
        belief = std::make_unique<JointImm>(settings, std::move(bank));
        landmark = belief->addLandmark(RelativeGaussian{Vector2(3, 1), 0.01 * Matrix2::Identity()});
        belief->addTarget(moverAt({Vector2(4, -1), 0.01 * Matrix2::Identity()}, 1, 1));
        moveSecondMode({0.02, 0.01, 0.03});
    }
    void moveSecondMode(const Vector3& by) {
        Vector3 robot = bank_->mode(1).mean(robot_block) + by;
        robot.z() = wrapAngle(robot.z());
        bank_->mode(1).propagate(robot_block, robot, Matrix3::Identity(), Matrix3::Zero());
    }
    void move() { belief->predict(test::odometry(0, 0.1, {0.4, 0, 0.1}), modelsOf(modes_)); }

    std::unique_ptr<JointImm> belief;
    BlockId landmark;

  private:
    ImmParameters modes_;
    JointBank* bank_;
};

void expectIsTheRobot(const ModalState& belief, BlockId pose, BlockId landmark) {
    const auto check = [&](const JointView& view) {
        const BlockVector robot = view.mean(robot_block), remembered = view.mean(pose);
        EXPECT_TRUE(near(remembered.head<2>(), robot.head<2>(), 1e-13));
        EXPECT_NEAR(angleDifference(remembered(2), robot(2)), 0, 1e-13);
        const BlockMatrix P = view.covariance(robot_block, robot_block);
        EXPECT_TRUE(near(view.covariance(pose, pose), P, 1e-13));
        EXPECT_TRUE(near(view.covariance(pose, robot_block), P, 1e-13));
        EXPECT_TRUE(near(view.covariance(pose, landmark), view.covariance(robot_block, landmark), 1e-13));
    };
    check(belief);
    for (int j = 0; j < belief.bank().modeCount(); ++j) check(belief.bank().mode(j));
    EXPECT_NEAR(belief.bank().mode(0).mean(pose)(2), belief.bank().mode(1).mean(pose)(2), 0.5)
        << "no whole turn apart";
}

TEST(PoseMemoryTest, ARememberedPoseIsTheRobotInEveryModeAcrossPi) {
    for (const Engine engine : {Engine::dense, Engine::compressed})
        for (const Consistency consistency : {Consistency::classic, Consistency::invariant}) {
            AcrossPi scene(engine, consistency);
            ASSERT_GT(scene.belief->bank().mode(0).mean(robot_block)(2), 3);
            ASSERT_LT(scene.belief->bank().mode(1).mean(robot_block)(2), -3);
            const BlockId pose = scene.belief->rememberPose();
            EXPECT_EQ(scene.belief->bank().kind(pose), BlockKind::pose);
            expectIsTheRobot(*scene.belief, pose, scene.landmark);

            const BlockVector kept = scene.belief->mean(pose);
            scene.move();
            EXPECT_TRUE(near(scene.belief->mean(pose), kept, 1e-13)) << "stays where the robot was";
            scene.moveSecondMode({0, 0, 0.04});
            EXPECT_EQ(scene.belief->rememberPose(pose), pose);
            expectIsTheRobot(*scene.belief, pose, scene.landmark);
        }
}

}  // namespace pose_memory_test
}  // namespace slamot
