#include <cmath>

#include "slamot/core/particles/TargetParticles.h"
#include "support/Expect.h"
#include "support/Scenes.h"

namespace slamot {
namespace target_particles_test {

using test::detectionsAt;
using test::near;
using test::odometry;
using test::seen;

constexpr ObjectKind landmark = ObjectKind::landmark, mover = ObjectKind::mover,
                     unknown = ObjectKind::unknown;

RobotMotionParameters motion() {
    RobotMotionParameters out;
    out.model = RobotMotionModel::increment;
    return out;
}

TargetParticles particlesOf(int count, bool weigh_targets = true,
                            PoseProposal proposal = PoseProposal::motion) {
    LandmarkFilterParameters landmarks;
    TargetSettings targets;
    targets.models[0].noise_std = 0.3;
    return TargetParticles({count, proposal, GaussianTransform::linear}, motion(),
                           {LandmarkFilters::Settings(landmarks, GaussianTransform::linear), targets, 0.9},
                           ScanMaker(landmarks.life, true, true), weigh_targets, 1);
}

RelativeGaussian moverAtPoint(const Vector2& at) {
    RelativeGaussian out = moverAt({at, Matrix2(Vector2(0.01, 0.02).asDiagonal())}, 1, 0);
    out.mean.segment<2>(2) << 1, -0.5;
    return out;
}

DetectionSet scanAt(double t, std::vector<RangeBearingDetection> detections) {
    DetectionSet set = detectionsAt(t, std::move(detections));
    std::get<RangeBearingSet>(set.measurements).sensors.front().max_range = 30;
    return set;
}

TargetDetection detectionOf(BlockId target, const RangeBearingDetection& detection) {
    return {target, -1, {detection.z(), detection.covariance, {}}};
}

// A mover as seen from an uncertain robot: P_TT = G P_RR G^t + own, P_RT = P_RR G^t (paper 1, eq. 13 to 17).
// With 4,000 particles an entry of a covariance is off by 1/sqrt(2,000) of the deviations' product or so;
// five times that.
TEST(TargetParticlesTest, ManyParticlesHaveTheMomentsOfTheJointFilter) {
    TargetParticles particles = particlesOf(4000);
    PoseGaussian start{{1, -2, 3.1}, Matrix3(Vector3(0.04, 0.09, 1e-4).asDiagonal())};
    start.covariance(0, 1) = start.covariance(1, 0) = 0.03;
    particles.start(start, 5);
    const RelativeGaussian relative = moverAtPoint({4, 3});
    const BlockId target = particles.addTarget(relative);
    const NewBlock expected = inWorld(relative, start.mean.vector());
    const MergedTargets merged = particles.merged();
    EXPECT_TRUE(near(merged.mean(target), expected.mean, 0.01));
    EXPECT_NEAR(wrapAngle(merged.mean(robot_block)(2) - 3.1), 0, 1e-3);

    const BlockMatrix P_TT = expected.G * start.covariance * expected.G.transpose() + expected.own;
    const BlockMatrix P_RT = start.covariance * expected.G.transpose();
    const auto expectNear = [](const BlockMatrix& value, const BlockMatrix& wanted, const BlockVector& rows,
                               const BlockVector& columns) {
        for (Eigen::Index i = 0; i < wanted.rows(); ++i)
            for (Eigen::Index j = 0; j < wanted.cols(); ++j)
                EXPECT_NEAR(value(i, j), wanted(i, j), 5 / std::sqrt(2000.0) * rows(i) * columns(j) + 1e-12)
                    << i << j;
    };
    const BlockVector d_R = start.covariance.diagonal().cwiseSqrt(), d_T = P_TT.diagonal().cwiseSqrt();
    expectNear(merged.covariance(target, target), P_TT, d_T, d_T);
    expectNear(merged.covariance(robot_block, target), P_RT, d_R, d_T);
    expectNear(merged.covariance(robot_block, robot_block), start.covariance, d_R, d_R);
}

TEST(TargetParticlesTest, TheWaysToAskForMomentsAgree) {
    TargetParticles particles = particlesOf(20);
    particles.start({{}, Matrix3(Vector3(0.04, 0.09, 1e-2).asDiagonal())}, 5);
    const BlockId a = particles.addTarget(moverAtPoint({4, 3})),
                  b = particles.addTarget(moverAtPoint({-4, 1}));
    particles.predict(odometry(0, 0.1, {0.2, 0, 0.1}));
    const MergedTargets merged = particles.merged();
    for (const BlockId target : {a, b}) {
        const TargetBelief belief = particles.target(target);
        EXPECT_TRUE(near(merged.mean(target), belief.mean, 1e-12));
        EXPECT_TRUE(near(merged.covariance(target, target), belief.covariance, 1e-12));
    }
    const PoseGaussian robot = particles.particles().robot();
    EXPECT_TRUE(near(merged.mean(robot_block), robot.mean.vector(), 1e-12));
    EXPECT_TRUE(near(merged.covariance(robot_block, robot_block), robot.covariance, 1e-12));
    const Eigen::MatrixXd P = merged.jointCovariance({b, robot_block, a});
    EXPECT_TRUE(near(P.block(0, 6, 6, 3), merged.covariance(b, robot_block), 0));
    EXPECT_TRUE(near(P.block(9, 0, 6, 6), merged.covariance(a, b), 0));

    // Numbers stay with their movers.
    const Vector6 before = particles.target(b).mean;
    particles.removeTarget(a);
    EXPECT_EQ(particles.target(b).mean, before);
    EXPECT_THROW(particles.target(a), std::out_of_range);
    EXPECT_NE(particles.addTarget(moverAtPoint({1, 1})), a);
}

// Eq. 11: particles from which the mover is seen where it was expected gain.
TEST(TargetParticlesTest, MoversWeighParticlesWhereTheyShall) {
    for (const bool weigh : {true, false}) {
        TargetParticles particles = particlesOf(50, weigh);
        particles.start({}, 5);
        const BlockId target = particles.addTarget(moverAtPoint({4, 3}));
        particles.predict(odometry(0, 0.1, {1, 0, 0.5}));
        std::vector<double> log_w;
        for (int i = 0; i < 50; ++i) {
            TargetFilter filter = particles.particles().map(i).targets().at(0);
            const RangeBearingDetection d = seen({1, 0, 0.5}, {4.1, 2.95}, mover, 1);
            log_w.push_back(filter.update(TargetSettings(), particles.particles().cloud().pose(i).mean,
                                          {d.z(), d.covariance, {}}));
        }
        particles.updateByTargets({detectionOf(target, seen({1, 0, 0.5}, {4.1, 2.95}, mover, 1))});
        double sum = 0;
        for (const double each : log_w) sum += std::exp(each);
        for (int i = 0; i < 50; ++i)
            EXPECT_NEAR(particles.particles().cloud().weights()[i],
                        weigh ? std::exp(log_w[static_cast<std::size_t>(i)]) / sum : 0.02, 1e-12);
    }
}

// A detection that may be of something else: 1 + P_D v (N / c - 1). It says no more against a particle than a
// miss.
TEST(TargetParticlesTest, WhatMayNotBeTheMoversWeighsLittle) {
    for (const Vector2& point : {Vector2(4.1, 2.95), Vector2(8, 6)}) {
        for (const double visible : {0.25, 1.0}) {
            TargetParticles particles = particlesOf(20);
            particles.start({}, 5);
            const BlockId target = particles.addTarget(moverAtPoint({4, 3}));
            particles.predict(odometry(0, 0.1, {1, 0, 0.5}));
            TargetDetection detection = detectionOf(target, seen({1, 0, 0.5}, point, mover, -1));
            detection.named = false;
            detection.visible = visible;
            detection.detection_probability = 0.9;
            detection.unexplained = 0.01;
            std::vector<double> factors;
            double sum = 0;
            for (int i = 0; i < 20; ++i) {
                TargetFilter filter = particles.particles().map(i).targets().at(0);
                const double log_N = filter.update(
                    TargetSettings(), particles.particles().cloud().pose(i).mean, detection.sight);
                factors.push_back(1 + 0.9 * visible * (std::exp(log_N) / 0.01 - 1));
                sum += factors.back();
            }
            particles.updateByTargets({detection});
            for (int i = 0; i < 20; ++i)
                EXPECT_NEAR(particles.particles().cloud().weights()[i],
                            factors[static_cast<std::size_t>(i)] / sum, 1e-12);
        }
    }
}

// A particle whose landmark took the detection has missed the mover, which weighs as much as in others.
TEST(TargetParticlesTest, WhereALandmarkTookItTheMoverWasMissed) {
    TargetParticles particles = particlesOf(40);
    particles.start({}, 5);
    const RangeBearingDetection first = seen({}, {5, 0}, unknown, -1);
    particles.updateByLandmarks(scanAt(0, {first}), true);
    particles.addLandmark({{Stamp::fromSeconds(0), first, {}, 0.01}}, 13.8, LandmarkFilter());
    const BlockId target = particles.addTarget(moverAtPoint({7, 0.5}));
    particles.predict(odometry(0, 1, {1, 0, 0.5}));
    const RangeBearingDetection second = seen({1, 0, 0.5}, {5.4, 0}, unknown, -1);
    particles.updateByLandmarks(scanAt(1, {second}), true);
    TargetDetection detection = detectionOf(target, second);
    detection.detection = 0;
    detection.named = false;
    detection.visible = 0.8;
    detection.detection_probability = 0.9;
    detection.unexplained = 0.01;
    std::vector<double> weights;
    double sum = 0;
    int took = 0;
    for (int i = 0; i < 40; ++i) {
        TargetFilter filter = particles.particles().map(i).targets().at(0);
        const double log_N =
            filter.update(TargetSettings(), particles.particles().cloud().pose(i).mean, detection.sight);
        const bool is_taken = particles.particles().records(i).at(0).landmark.valid();
        took += is_taken;
        const double factor = 1 - 0.72 + (is_taken ? 0 : 0.72 * std::exp(log_N) / 0.01);
        weights.push_back(particles.particles().cloud().weights()[i] * factor);
        sum += weights.back();
    }
    ASSERT_GT(took, 2);
    ASSERT_LT(took, 38);
    particles.updateByTargets({detection});
    for (int i = 0; i < 40; ++i)
        EXPECT_NEAR(particles.particles().cloud().weights()[i], weights[static_cast<std::size_t>(i)] / sum,
                    1e-12);
}

// Sights of what turns out to be a landmark are taken in where the path has them made.
TEST(TargetParticlesTest, ALandmarkOfUnknownKindStartsWhereThePathSawItFirst) {
    TargetParticles particles = particlesOf(1);
    particles.start({}, 5);
    const std::vector<RangeBearingDetection> sights{
        seen({}, {5, 0}, unknown, -1), seen({}, {5.3, 0}, unknown, -1), seen({}, {5, 3}, unknown, -1),
        seen({}, {5, 0.1}, unknown, -1)};
    std::vector<TentativeSight> tentative;
    for (int k = 0; k < 4; ++k) {
        const auto& sight = sights[static_cast<std::size_t>(k)];
        particles.updateByLandmarks(scanAt(k, {sight}), true);
        tentative.push_back({Stamp::fromSeconds(k), sight, {}, 0.01});
        EXPECT_EQ(particles.particles().landmarkCount(), 0);
        ASSERT_EQ(particles.landmarkVerdicts().size(), 1u);
        EXPECT_TRUE(particles.landmarkVerdicts()[0].may_be_new);
        EXPECT_FALSE(particles.landmarkVerdicts()[0].explained);
    }
    LandmarkFilter life;
    life.seen = 4;
    const LandmarkId id = particles.addLandmark(tentative, 13.8, life);
    const LandmarkFilter* point = particles.particles().best().find(id);
    ASSERT_NE(point, nullptr);
    EXPECT_EQ(point->seen, 4);
    // Ranges 5, 5.3 and 5.001 with equal weight; the third sight lies outside the gate.
    EXPECT_NEAR(point->point.mean.x(), 5.1, 3e-3);
    EXPECT_NEAR(point->point.covariance(0, 0), 0.01 / 3, 1e-5);

    // It explains its next sight; another one may be new.
    particles.updateByLandmarks(scanAt(5, {seen({}, {-4, 2}, unknown, -1), seen({}, {5.1, 0}, unknown, -1)}),
                                true);
    const auto verdicts = particles.landmarkVerdicts();
    ASSERT_EQ(verdicts.size(), 2u);
    EXPECT_TRUE(verdicts[0].may_be_new);
    EXPECT_TRUE(verdicts[1].explained);
    EXPECT_EQ(verdicts[1].landmark, id);
    particles.removeLandmark(id);
    EXPECT_EQ(particles.particles().landmarkCount(), 0);
}

// Of two particles that see a second sight from where they are, each is weighed by it, and where it lies
// outside the gate by what else it may have been.
TEST(TargetParticlesTest, SightsOfANewLandmarkWeighParticles) {
    TargetParticles particles = particlesOf(30);
    particles.start({}, 5);
    const RangeBearingDetection first = seen({}, {5, 0}, unknown, -1);
    particles.updateByLandmarks(scanAt(0, {first}), true);
    particles.predict(odometry(0, 1, {1, 0, 0.5}));
    const RangeBearingDetection second = seen({1, 0, 0.5}, {5, 0}, unknown, -1);
    particles.updateByLandmarks(scanAt(1, {second}), true);
    std::vector<double> factors;
    double sum = 0;
    int outside = 0;
    constexpr double gate = 1, other = 0.3;
    const double p_d = LifeParameters().detection_probability;
    for (int i = 0; i < 30; ++i) {
        const SensorPlace here = placeOf(particles.particles().cloud().pose(i).mean, {});
        const GaussianPoint point =
            firstSight(placeOf(Vector3::Zero(), {}), first.z(), first.covariance, GaussianTransform::linear);
        const PointInnovation innovation(sightOf(point, here, GaussianTransform::linear), second.z(),
                                         second.covariance);
        outside += innovation.nis > gate;
        const double own = innovation.nis > gate ? 0 : std::exp(innovation.logLikelihood());
        factors.push_back(p_d * own + (1 - p_d) * other);
        sum += factors.back();
    }
    ASSERT_GT(outside, 2);
    ASSERT_LT(outside, 28);
    particles.addLandmark(
        {{Stamp::fromSeconds(0), first, {}, other}, {Stamp::fromSeconds(1), second, {}, other}}, gate,
        LandmarkFilter());
    for (int i = 0; i < 30; ++i)
        EXPECT_NEAR(particles.particles().cloud().weights()[i], factors[static_cast<std::size_t>(i)] / sum,
                    1e-9);
}

TEST(TargetParticlesTest, ASightThatIsLikelierOfAMoverIsLeftToIt) {
    TargetParticles particles = particlesOf(1);
    particles.start({}, 5);
    particles.updateByLandmarks(scanAt(0, {seen({}, {5, 0}, unknown, -1)}), true);
    const LandmarkId id = particles.addLandmark(
        {{Stamp::fromSeconds(0), seen({}, {5, 0}, unknown, -1), {}, 0.01}}, 13.8, LandmarkFilter());
    particles.addTarget(moverAtPoint({5, 0.4}));
    particles.updateByLandmarks(scanAt(1, {seen({}, {5, 0.38}, unknown, -1)}), true);
    EXPECT_FALSE(particles.landmarkVerdicts().at(0).explained);
    EXPECT_FALSE(particles.landmarkVerdicts().at(0).may_be_new);
    particles.updateByLandmarks(scanAt(2, {seen({}, {5, 0.02}, unknown, -1)}), true);
    EXPECT_EQ(particles.landmarkVerdicts().at(0).landmark, id);
    // Seen as a landmark it can be nothing else.
    particles.updateByLandmarks(scanAt(3, {seen({}, {5, 0.38}, landmark, -1)}), true);
    EXPECT_TRUE(particles.landmarkVerdicts().empty());
}

}  // namespace target_particles_test
}  // namespace slamot
