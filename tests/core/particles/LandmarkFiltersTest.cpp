#include <Eigen/LU>

#include "OneParticle.h"
#include "slamot/core/particles/LandmarkFilters.h"
#include "support/Expect.h"

namespace slamot {
namespace landmark_filters_test {

using test::nameless;
using test::scanAt;
using test::scanOfTwo;
using test::seen;
using test::sensorOf;

LandmarkFilterParameters parameters() {
    LandmarkFilterParameters out;
    out.life.detection_probability = 0.8;
    out.life.clutter_per_scan = 2;
    out.life.new_per_scan = 0.5;
    out.life.hidden_every = std::numeric_limits<double>::infinity();
    return out;
}

struct Particle : test::OneParticle<LandmarkFilters, LandmarkFilter> {
    explicit Particle(LandmarkFilterParameters p = parameters())
        : OneParticle({p, GaussianTransform::linear}, {p.life, p.association != ParticleAssociation::known}) {
    }
};

TEST(LandmarkFiltersTest, NamedLandmarksWeighByTheirInnovationAlone) {
    Particle particle;
    EXPECT_EQ(particle.take(scanAt(0, {seen({}, {5, 0}, ObjectKind::landmark, 7)})), 0);
    EXPECT_EQ(particle.records.at(0).outcome, Outcome::initiated);
    // Covariance at first sight: diag(0.01, 25 * 0.0004) = 0.01 I. Again, 0.1 m farther: S = diag(0.02,
    // 0.0008).
    const double log_likelihood = particle.take(scanAt(1, {seen({}, {5.1, 0}, ObjectKind::landmark, 7)}));
    EXPECT_NEAR(log_likelihood, -0.5 * 0.01 / 0.02 - 0.5 * std::log(0.02 * 0.0008) - std::log(2 * pi), 1e-12);
    const LandmarkFilter landmark = particle.all().at(0);
    EXPECT_TRUE(test::near(landmark.point.mean, Vector2(5.05, 0), 1e-14));
    EXPECT_TRUE(test::near(landmark.point.covariance, Matrix2(0.005 * Matrix2::Identity()), 1e-14));
    EXPECT_EQ(landmark.seen, 2);
    // Not seen: a name vouches for it.
    EXPECT_EQ(particle.take(scanAt(2, {})), 0);
    EXPECT_EQ(particle.all().size(), 1u);
}

TEST(LandmarkFiltersTest, TheSameNewNameTwiceInABatchStartsOneLandmark) {
    Particle particle;
    particle.take(
        scanAt(0, {seen({}, {5, 0}, ObjectKind::landmark, 7), seen({}, {6, 0}, ObjectKind::landmark, 7)}));
    EXPECT_EQ(particle.all().size(), 1u);
    particle.take(scanAt(1, {seen({}, {5, 0}, ObjectKind::landmark, 7)}));
    EXPECT_EQ(particle.all().size(), 1u);
}

TEST(LandmarkFiltersTest, ANameTwiceInABatchIsTwoSightsOneAfterTheOther) {
    Particle particle;
    const auto at = [](double x) { return seen({}, {x, 0}, ObjectKind::landmark, 7); };
    particle.take(scanAt(0, {at(5)}));
    particle.take(scanAt(1, {at(5), at(5.3)}));
    // Of three equal sights in all: the mean, and a third of one's covariance.
    const LandmarkFilter landmark = particle.all().at(0);
    EXPECT_TRUE(test::near(landmark.point.mean, Vector2(5.1, 0), 1e-14));
    EXPECT_TRUE(test::near(landmark.point.covariance, Matrix2(0.01 / 3 * Matrix2::Identity()), 1e-4));
    EXPECT_EQ(landmark.seen, 3);
}

// The weights of a nameless landmark, by hand: c = 2.5 / (20 * 2 pi), r = 0.5 / 2.5 at first sight.
TEST(LandmarkFiltersTest, NamelessLandmarksWeighByExistence) {
    const double c = 2.5 / (20 * 2 * pi), p_d = 0.8;
    Particle particle;
    EXPECT_NEAR(particle.take(scanAt(0, {nameless({5, 0})})), std::log(c), 1e-12);
    double r = 0.2;
    EXPECT_NEAR(particle.all().at(0).existence.probability(), r, 1e-12);

    const double N = 1 / (2 * pi * std::sqrt(0.02 * 0.0008));
    EXPECT_NEAR(particle.take(scanAt(1, {nameless({5, 0})})), std::log(c * (1 - r * p_d) + r * p_d * N),
                1e-9);
    r = r * p_d * N / (r * p_d * N + (1 - r) * c);
    EXPECT_NEAR(particle.all().at(0).existence.probability(), r, 1e-9);

    EXPECT_NEAR(particle.take(scanAt(2, {})), std::log(1 - r * p_d), 1e-9);
    r = r * (1 - p_d) / (1 - r * p_d);
    EXPECT_NEAR(particle.all().at(0).existence.probability(), r, 1e-9);

    // Looked for again and again and never there: gone.
    for (int k = 3; k < 20; ++k) particle.take(scanAt(k, {}));
    EXPECT_TRUE(particle.all().empty());
}

// One probability of detection for both: of a landmark as far off as the sensor reaches half of the looks
// show it.
TEST(LandmarkFiltersTest, DetectedOrMissedSumToOneAtTheRimToo) {
    Particle particle;
    const double range_at_rim = 20;
    for (int k = 0; k < 4; ++k) particle.take(scanAt(k, {nameless({range_at_rim, 0})}));
    const double visible = particle.all().at(0).existence.visibility();
    const LandmarkFilter landmark = particle.all().at(0);
    const double
        p = 0.5 * 0.8,
        c = std::exp(
            particle.scans.scan(scanAt(4, {nameless({range_at_rim, 0})})).sights.at(0).log_unexplained);
    const Matrix2 S =
        landmark.point.covariance + Matrix2(Vector2(0.01, 0.0004 * range_at_rim * range_at_rim).asDiagonal());
    const double N = range_at_rim / (2 * pi * std::sqrt(S.determinant()));
    Particle other = particle;
    EXPECT_NEAR(other.take(scanAt(4, {nameless({range_at_rim, 0})})),
                std::log(c * (1 - visible * p) + visible * p * N), 1e-6);
    EXPECT_NEAR(particle.take(scanAt(4, {})), std::log(1 - visible * p), 1e-6);
}

// Where no new landmarks are expected a detection without identity is clutter.
TEST(LandmarkFiltersTest, NothingStartsWhereNothingNewIsExpected) {
    LandmarkFilterParameters p = parameters();
    p.life.new_per_scan = 0;
    Particle particle(p);
    for (int k = 0; k < 3; ++k) particle.take(scanAt(k, {nameless({5, 0})}));
    EXPECT_TRUE(particle.all().empty());
    particle.take(scanAt(3, {seen({}, {5, 0}, ObjectKind::landmark, 7)}));
    EXPECT_EQ(particle.all().size(), 1u);
}

TEST(LandmarkFiltersTest, OnlyLooksThatWouldShowALandmarkSpeakAgainstIt) {
    Particle particle;
    for (int k = 0; k < 5; ++k) particle.take(scanAt(k, {nameless({5, 0})}));
    const double before = particle.all().at(0).existence.probability();
    EXPECT_EQ(particle.take(test::scanBehind(5)), 0);
    EXPECT_EQ(particle.all().at(0).existence.probability(), before);
}

TEST(LandmarkFiltersTest, OneDetectionForEachLandmarkAndTheLikeliestPairFirst) {
    for (const ParticleAssociation method : {ParticleAssociation::nearest, ParticleAssociation::likelihood}) {
        LandmarkFilterParameters p = parameters();
        p.association = method;
        Particle particle(p);
        for (int k = 0; k < 5; ++k) particle.take(scanAt(k, {nameless({5, 0}), nameless({5, 1})}));
        ASSERT_EQ(particle.all().size(), 2u);
        // The second detection lies half-way, outside the gates: it starts nothing, since it may be of the
        // second landmark, which is not seen otherwise.
        particle.take(scanAt(6, {nameless({5.02, 0}), nameless({5.0, 0.5})}));
        EXPECT_EQ(particle.records.at(0).landmark, particle.all().at(0).id);
        EXPECT_EQ(particle.all().size(), 2u) << static_cast<int>(method);
    }
}

TEST(LandmarkFiltersTest, WhereIdentitiesAreRequiredNamelessDetectionsAreNothing) {
    LandmarkFilterParameters p = parameters();
    p.association = ParticleAssociation::known;
    Particle particle(p);
    EXPECT_EQ(particle.take(scanAt(0, {nameless({5, 0}), seen({}, {8, 0}, ObjectKind::landmark, 1)})), 0);
    EXPECT_EQ(particle.all().size(), 1u);
}

TEST(LandmarkFiltersTest, WhatWasLeftBehindUnconfirmedIsLetGo) {
    Particle particle;
    particle.take(scanAt(0, {nameless({5, 0})}));
    DetectionSet elsewhere = scanAt(0, {});
    sensorOf(elsewhere).max_range = 2;
    for (int k = 1; k <= 5; ++k) {
        elsewhere.stamp = Stamp::fromSeconds(k);
        particle.take(elsewhere);
        EXPECT_EQ(particle.all().size(), 1u);
    }
    elsewhere.stamp = Stamp::fromSeconds(5.1);
    particle.take(elsewhere);
    EXPECT_TRUE(particle.all().empty());
}

// Only landmarks that exist beyond doubt correct the pose.
TEST(LandmarkFiltersTest, TentativeLandmarksDoNotRefineThePose) {
    const PoseBelief belief{Vector3::Zero(), 0.1 * Matrix3::Identity()};
    Particle particle;
    for (int k = 0; k < 4; ++k) {
        const ParticleScan scan = particle.scans.scan(scanAt(k, {nameless({5, 0})}));
        particle.map.pairUp(particle.settings, belief, scan, particle.work, particle.records);
        const auto all = particle.all();
        const bool confirmed = !all.empty() && particle.settings.parameters.life.confirm_probability <=
                                                   all.at(0).existence.probability();
        RefinedPose refined(belief);
        particle.map.refine(particle.settings, scan, particle.work, refined);
        EXPECT_EQ(refined.belief().factor == belief.factor, !confirmed) << k;
        particle.map.update(particle.settings, Vector3::Zero(), true, scan, particle.work, particle.records);
        EXPECT_EQ(confirmed, k > 1);
    }
}

// Each sensor detects a landmark once at most: what one starts the other confirms, and what one misses
// counts.
TEST(LandmarkFiltersTest, SensorsHaveTheirTurns) {
    Particle seen_by_both, seen_by_one;
    for (Particle* each : {&seen_by_both, &seen_by_one})
        each->take(scanOfTwo(0, {nameless({5, 0}), nameless({5, 0})}));
    ASSERT_EQ(seen_by_both.all().size(), 1u);
    EXPECT_EQ(seen_by_both.all()[0].seen, 2);
    // Two readings of one place, each with the sensor's noise.
    EXPECT_NEAR(seen_by_both.all()[0].point.covariance(0, 0), 0.01 / 2, 1e-9);

    seen_by_both.take(scanOfTwo(1, {nameless({5, 0}), nameless({5, 0})}));
    seen_by_one.take(scanOfTwo(1, {nameless({-5, 3}), nameless({5, 0})}));
    ASSERT_EQ(seen_by_both.all().size(), 1u);
    EXPECT_EQ(seen_by_both.all()[0].seen, 4);
    ASSERT_EQ(seen_by_one.all().size(), 2u);
    EXPECT_EQ(seen_by_one.all()[0].seen, 3);
    EXPECT_LT(seen_by_one.all()[0].existence.probability(), seen_by_both.all()[0].existence.probability());
}

// Of two detections of the second sensor near what the first has started the nearer is its; the other starts
// another.
TEST(LandmarkFiltersTest, ASensorDetectsOnceWhatAnotherHasJustStarted) {
    for (const bool nearer_first : {true, false}) {
        DetectionSet set = scanAt(0, {nameless({5, 0})});
        auto& both = std::get<RangeBearingSet>(set.measurements);
        both.sensors.push_back(both.sensors.front());
        both.sensors.back().label = "other";
        for (const double x : {nearer_first ? 5.05 : 5.2, nearer_first ? 5.2 : 5.05}) {
            both.detections.push_back(nameless({x, 0}));
            both.detections.back().sensor = 1;
        }
        Particle particle;
        particle.take(set);
        ASSERT_EQ(particle.all().size(), 2u);
        EXPECT_EQ(particle.all()[0].seen, 2);
        EXPECT_NEAR(particle.all()[0].point.mean.x(), 5.025, 1e-3);
        EXPECT_EQ(particle.all()[1].seen, 1);
        EXPECT_NEAR(particle.all()[1].point.mean.x(), 5.2, 1e-9);
    }
}

TEST(LandmarkFiltersTest, AScanCopiesNoPageThatIsOutOfReach) {
    Particle particle;
    for (int k = 0; k < 64; ++k) {
        const double x = 5 + 100.0 * (k / 16);
        particle.take(scanAt(k, {seen({}, {x, 0.1 * (k % 16)}, ObjectKind::landmark, k)}));
    }
    LandmarkFilters copy = particle.map;
    copy.renew(2);
    particle.map.renew(3);
    EXPECT_EQ(particle.map.features().bytes()[0], 0u);
    particle.take(scanAt(100, {seen({}, {5, 0}, ObjectKind::landmark, 0), nameless({5, 5})}));
    // The page of the landmark that was seen and the last one, where the new one is.
    EXPECT_EQ(particle.map.features().pages(), 5);
    EXPECT_EQ(particle.map.features().bytes()[0] * 5, particle.map.features().bytes()[1] * 2);
}

}  // namespace landmark_filters_test
}  // namespace slamot
