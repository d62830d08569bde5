#include <cmath>
#include <string>

#include "slamot/core/filter/JointFilter.h"
#include "slamot/core/particles/LandmarkFilters.h"
#include "slamot/core/particles/ParticleFilter.h"
#include "support/Expect.h"
#include "support/Scenes.h"

namespace slamot {
namespace particle_filter_test {

using Filter = ParticleFilter<LandmarkFilters>;

struct Form {
    std::string name;
    PoseProposal proposal;
    GaussianTransform transform;
    Resampling resampling;
};

RobotMotionParameters motion() {
    RobotMotionParameters out;
    out.model = RobotMotionModel::increment;
    return out;
}

Filter filterOf(const Form& form, int count) {
    ParticleParameters p;
    p.count = count;
    p.proposal = form.proposal;
    p.transform = form.transform;
    p.resampling = form.resampling;
    LandmarkFilterParameters landmarks;
    landmarks.association = ParticleAssociation::known;
    return Filter(p, motion(), LandmarkFilters::Settings(landmarks, form.transform),
                  ScanMaker(landmarks.life, false), 1);
}

/// Half a circle of 2 m among landmarks, with noise in odometry and detections; `take` gets each step.
template <class Take>
void drive(const Take& take) {
    RandomStream random(11, RandomPurpose::test);
    const std::vector<Vector2> landmarks{{4, 0}, {0, 5}, {-3, 1}, {2, 4}, {-2, -3}};
    Pose2 truth;
    for (int k = 1; k <= 20; ++k) {
        const Pose2 step{0.3 + 0.01 * random.normal(), 0.005 * random.normal(),
                         0.15 + 0.02 * random.normal()};
        truth = truth * step;
        std::vector<RangeBearingDetection> detections;
        for (std::size_t i = 0; i < landmarks.size(); ++i) {
            auto each = test::seen(truth, landmarks[i], ObjectKind::landmark, static_cast<std::int64_t>(i));
            each.range += 0.1 * random.normal();
            each.bearing = wrapAngle(each.bearing + 0.02 * random.normal());
            detections.push_back(each);
        }
        take(test::odometry(0.1 * (k - 1), 0.1 * k, {0.3, 0, 0.15}), test::detectionsAt(0.1 * k, detections));
    }
}

class Forms : public testing::TestWithParam<Form> {};

// Many particles and the joint EKF see the same posterior, as far as the world is linear over its spread.
TEST_P(Forms, ManyParticlesHaveTheMomentsOfTheJointFilter) {
    constexpr int count = 4000;
    Filter particles = filterOf(GetParam(), count);
    particles.start({}, 3);
    JointFilterParameters p;
    JointFilter joint(p, motion());
    joint.start(Stamp{}, {});
    drive([&](const OdometryIncrement& odometry, const DetectionSet& set) {
        particles.predict(odometry);
        joint.predict(odometry);
        particles.update(set);
        joint.update(set);
    });
    const PoseGaussian a = particles.robot(), b = joint.robot();
    const Vector3 deviation = b.covariance.diagonal().cwiseSqrt();
    Vector3 d = a.mean.vector() - b.mean.vector();
    d.z() = wrapAngle(d.z());
    // The paths that are left are far fewer than particles: those of the first steps, which the map hangs on,
    // come from about one in a hundred. Two tenths of a deviation are 4 standard errors of 400 of them.
    EXPECT_LT((d.array() / deviation.array()).abs().maxCoeff(), 0.2) << d.transpose() << "\n"
                                                                     << deviation.transpose();
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::sqrt(a.covariance(i, i)) / deviation(i), 1, 0.2) << i;

    const auto landmarks = particles.landmarks();
    const auto expected = joint.landmarks();
    ASSERT_EQ(landmarks.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(landmarks[i].source, expected[i].source);
        const Vector2 spread = expected[i].covariance.diagonal().cwiseSqrt();
        EXPECT_LT(((landmarks[i].mean - expected[i].mean).array() / spread.array()).abs().maxCoeff(), 0.3);
        EXPECT_LT(
            (landmarks[i].covariance.diagonal().cwiseSqrt().array() / spread.array() - 1).abs().maxCoeff(),
            0.3);
    }
}

// Innovations are told as the mixture had them before it saw the detection.
TEST_P(Forms, InnovationsHaveTheSpreadTheyClaim) {
    Filter particles = filterOf(GetParam(), 200);
    particles.start({}, 5);
    double nis = 0;
    int count = 0;
    drive([&](const OdometryIncrement& odometry, const DetectionSet& set) {
        particles.predict(odometry);
        for (const Innovation& innovation : particles.update(set).innovations) {
            if (innovation.outcome != Outcome::updated) continue;
            nis += innovation.nis;
            ++count;
        }
    });
    EXPECT_EQ(count, 95);
    // Chi-square of 190 degrees of freedom: 3.5 standard deviations either side, one false alarm in 2,000.
    EXPECT_NEAR(nis / 190, 1, 3.5 * std::sqrt(2.0 / 190));
}

// Between scans a particle is spread itself, after one it is a point; both together make the robot's moments.
TEST_P(Forms, ParticlesMakeUpTheRobot) {
    Filter filter = filterOf(GetParam(), 50);
    filter.start({Pose2{1, 2, 3.1}, Vector3(0.1, 0.2, 0.05).cwiseAbs2().asDiagonal()}, 5);
    const auto expectMoments = [&] {
        const PoseGaussian robot = filter.robot();
        Vector3 mean = Vector3::Zero();
        Matrix3 P = Matrix3::Zero();
        const auto particles = filter.particles();
        ASSERT_EQ(particles.size(), 50u);
        for (const auto& [weight, pose] : particles) {
            Vector3 apart = pose.mean.vector() - robot.mean.vector();
            apart.z() = wrapAngle(apart.z());
            mean += weight * apart;
            P += weight * (apart * apart.transpose() + pose.covariance);
        }
        EXPECT_TRUE(test::near(mean, Vector3::Zero().eval(), 1e-13));
        EXPECT_TRUE(test::near(P, robot.covariance, 1e-13));
    };
    const bool refined = GetParam().proposal == PoseProposal::refined;
    EXPECT_EQ(filter.particles().at(7).pose.covariance.isZero(0), !refined);
    drive([&](const OdometryIncrement& odometry, const DetectionSet& set) {
        filter.predict(odometry);
        EXPECT_EQ(filter.particles().at(7).pose.covariance.isZero(0), !refined);
        expectMoments();
        filter.update(set);
        EXPECT_TRUE(filter.particles().at(7).pose.covariance.isZero(0));
        expectMoments();
    });
}

INSTANTIATE_TEST_SUITE_P(
    All, Forms,
    testing::Values(Form{"motion", PoseProposal::motion, GaussianTransform::linear, Resampling::systematic},
                    Form{"linear", PoseProposal::refined, GaussianTransform::linear, Resampling::systematic},
                    Form{"residual", PoseProposal::refined, GaussianTransform::linear, Resampling::residual},
                    Form{"unscented", PoseProposal::refined, GaussianTransform::unscented,
                         Resampling::systematic}),
    [](const auto& each) { return each.param.name; });

// A detection without identity is a candidate until others confirm it; a name vouches at once.
TEST(ParticleFilterTest, TentativeUntilConfirmed) {
    LandmarkFilterParameters landmarks;
    ParticleParameters p;
    p.count = 5;
    Filter filter(p, motion(), LandmarkFilters::Settings(landmarks, GaussianTransform::linear),
                  ScanMaker(landmarks.life, true), 1);
    filter.start({}, 1);
    const auto look = [&](double t) {
        filter.update(test::detectionsAt(t, {test::seen({}, {2, 1}, ObjectKind::landmark, -1),
                                             test::seen({}, {3, -1}, ObjectKind::landmark, 4)}));
    };
    look(0);
    ASSERT_EQ(filter.tentative().size(), 1u);
    const LandmarkEstimate candidate = filter.tentative()[0];
    EXPECT_TRUE(test::near(candidate.mean, Vector2(2, 1), 1e-9));
    EXPECT_GT(candidate.existence, 0);
    EXPECT_LT(candidate.existence, landmarks.life.confirm_probability);
    EXPECT_EQ(filter.landmarkCount(), 1);
    for (int k = 1; k < 10 && !filter.tentative().empty(); ++k) look(0.1 * k);
    EXPECT_TRUE(filter.tentative().empty());
    ASSERT_EQ(filter.landmarks({candidate.id}).size(), 1u);
    EXPECT_GE(filter.landmarks({candidate.id})[0].existence, landmarks.life.confirm_probability);
}

TEST(ParticleFilterTest, AnEmptyScanOfNamedLandmarksChangesNothing) {
    Filter filter =
        filterOf({"", PoseProposal::refined, GaussianTransform::linear, Resampling::systematic}, 10);
    filter.start({}, 1);
    filter.predict(test::odometry(0, 1, {1, 0, 0.1}));
    const PoseGaussian before = filter.robot();
    EXPECT_TRUE(filter.update(test::detectionsAt(1, {})).innovations.empty());
    EXPECT_EQ(filter.robot().covariance, before.covariance);
    EXPECT_EQ(filter.landmarkCount(), 0);
}

}  // namespace particle_filter_test
}  // namespace slamot
