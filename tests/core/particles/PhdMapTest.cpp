#include "OneParticle.h"
#include "slamot/core/particles/PhdMap.h"
#include "support/Expect.h"

namespace slamot {
namespace phd_map_test {

using test::nameless;
using test::sensorOf;

constexpr double p_d = 0.8;

/// A scan that sees these points and no identities.
DetectionSet scanAt(double t, const std::vector<Vector2>& points, const Pose2& robot = {}) {
    std::vector<RangeBearingDetection> detections;
    for (const Vector2& point : points) detections.push_back(test::nameless(point, robot));
    return test::scanAt(t, std::move(detections));
}

/// Births weigh 0.75: with lambda = 2, c = 1 / (20 pi).
PhdMapParameters parameters() {
    PhdMapParameters out;
    out.detection_probability = p_d;
    out.clutter_per_scan = 2;
    out.new_per_scan = 6;
    out.largest_birth = 1;
    return out;
}
const double c = 2 / (20 * 2 * pi);

/// Of a detection 5 m or 8 m away that lies `off` [m] farther than expected, expected with twice its own
/// variance.
double density(double off) {
    return std::exp(-0.5 * off * off / 0.02) / (2 * pi * std::sqrt(0.02 * 0.0008));
}

struct Particle : test::OneParticle<PhdMap, PhdFeature> {
    explicit Particle(PhdMapParameters p = parameters())
        : OneParticle({p, GaussianTransform::linear}, {p.clutter(), true}) {}

    double total() const {
        double out = 0;
        for (const PhdFeature& feature : all()) out += feature.weight;
        return out;
    }
};

TEST(PhdMapTest, BirthsJoinAtTheNextStep) {
    Particle particle;
    EXPECT_NEAR(particle.take(scanAt(0, {{5, 0}, {0, 8}})), 2 * std::log(c), 1e-12);
    ASSERT_EQ(particle.all().size(), 2u);
    EXPECT_EQ(particle.all()[1].weight, 0.75);
    EXPECT_TRUE(test::near(particle.all()[1].point.mean, Vector2(0, 8), 1e-14));
    EXPECT_TRUE(test::near(particle.all()[1].point.covariance,
                           Matrix2(Vector2(64 * 0.0004, 0.01).asDiagonal()), 1e-15));
    EXPECT_EQ(particle.records[1].outcome, Outcome::tentative);
    EXPECT_EQ(particle.records[1].landmark, particle.all()[1].id);

    // Both in view, none detected: exp(-sum P_D w), and 1 - P_D of the weights.
    EXPECT_NEAR(particle.take(scanAt(1, {})), -p_d * 1.5, 1e-12);
    EXPECT_NEAR(particle.total(), (1 - p_d) * 1.5, 1e-12);
}

// Two components of 0.75 at (5, 0), covariance 0.01 I, and (0, 8). Detections: A exact, B 0.2 m beyond the
// first, C far off. Neither pruned nor merged there are four terms of the first component and one of the
// second:
//   not detected 0.2 0.75 each; A, B of the first P_D 0.75 q / (c + P_D 0.75 q).
TEST(PhdMapTest, UpdateByHandWithTwoComponentsAndClutter) {
    PhdMapParameters p = parameters();
    p.merge_within = 0;
    Particle particle(p);
    particle.take(scanAt(0, {{5, 0}, {0, 8}}));
    const double log_likelihood = particle.take(scanAt(1, {{5, 0}, {5.2, 0}, {0, -10}}));

    const double a = p_d * 0.75 * density(0), b = p_d * 0.75 * density(0.2);
    EXPECT_NEAR(log_likelihood, std::log(c + a) + std::log(c + b) + std::log(c) - p_d * 1.5, 1e-9);

    // The first goes on in the place of its heaviest term, A, which has not moved: what was not detected lies
    // at a distance of 0 and joins it. B takes its own number, 3; C starts 4.
    const double missed = 0.2 * 0.75;
    const std::vector<PhdFeature> all = particle.all();
    ASSERT_EQ(all.size(), 4u);
    EXPECT_EQ(all[0].id.value, 0);
    EXPECT_NEAR(all[0].weight, a / (c + a) + missed, 1e-9);
    EXPECT_TRUE(test::near(all[0].point.mean, Vector2(5, 0), 1e-12));
    EXPECT_EQ(all[0].seen, 2);
    EXPECT_EQ(all[0].last_seen, Stamp::fromSeconds(1));
    EXPECT_EQ(all[1].id.value, 1);
    EXPECT_NEAR(all[1].weight, missed, 1e-12);
    EXPECT_EQ(all[1].seen, 1);
    EXPECT_EQ(all[2].id.value, 3);
    EXPECT_NEAR(all[2].weight, b / (c + b), 1e-9);
    EXPECT_TRUE(test::near(all[2].point.mean, Vector2(5.1, 0), 1e-12));
    EXPECT_TRUE(test::near(all[2].point.covariance, Matrix2(0.005 * Matrix2::Identity()), 1e-12));
    EXPECT_EQ(all[3].id.value, 4);
    EXPECT_EQ(all[3].weight, 0.75);

    EXPECT_EQ(particle.records[0].outcome, Outcome::updated);
    EXPECT_EQ(particle.records[0].landmark.value, 0);
    EXPECT_NEAR(particle.records[0].S(0, 0), 0.02, 1e-14);
    EXPECT_EQ(particle.records[1].outcome, Outcome::tentative);
    EXPECT_EQ(particle.records[1].landmark.value, 0);
    EXPECT_EQ(particle.records[2].landmark.value, 4);
}

// The same where B's term joins A's: it lies 0.1 m off, its covariance is 0.005 I, and 0.01 / 0.005 <= 4.
TEST(PhdMapTest, TermsThatLieTogetherAreMerged) {
    Particle particle;
    particle.take(scanAt(0, {{5, 0}}));
    particle.take(scanAt(1, {{5, 0}, {5.2, 0}}));
    const double a = p_d * 0.75 * density(0), b = p_d * 0.75 * density(0.2);
    const double w_a = a / (c + a), w_b = b / (c + b), w_0 = 0.2 * 0.75, w = w_a + w_b + w_0;
    ASSERT_EQ(particle.all().size(), 1u);
    const PhdFeature feature = particle.all()[0];
    const double mean = 5 + 0.1 * w_b / w;
    EXPECT_NEAR(feature.weight, w, 1e-9);
    EXPECT_TRUE(test::near(feature.point.mean, Vector2(mean, 0), 1e-12));
    const double within = (0.005 * (w_a + w_b) + 0.01 * w_0) / w;
    const double between = (w_b * 0.01) / w - (mean - 5) * (mean - 5);
    EXPECT_TRUE(
        test::near(feature.point.covariance, Matrix2(Vector2(within + between, within).asDiagonal()), 1e-12));
    EXPECT_EQ(feature.existenceProbability(), 1);
}

TEST(PhdMapTest, WhatIsNotSeenAgainIsPruned) {
    Particle particle;
    particle.take(scanAt(0, {{5, 0}}));
    // 0.75 0.2^4 = 0.0012, and the fifth miss takes it below 0.001.
    for (int k = 1; k <= 4; ++k) particle.take(scanAt(k, {}));
    EXPECT_NEAR(particle.total(), 0.0012, 1e-12);
    particle.take(scanAt(5, {}));
    EXPECT_TRUE(particle.all().empty());
}

// A component has four terms and one place. The numbers of detections that start nothing are all that new
// ones may have: where they run out a split stays with what it came from, and no weight is lost.
TEST(PhdMapTest, SplitsWithoutANumberStayWithWhatTheyCameFrom) {
    PhdMapParameters p = parameters();
    p.merge_within = 0;
    p.births = PhdBirths::all;
    Particle particle(p);
    particle.take(scanAt(0, {{5, 0}}));
    particle.take(scanAt(1, {{5.1, 0}, {4.8, 0}}));
    const double a = p_d * 0.75 * density(0.1), b = p_d * 0.75 * density(0.2);
    const double w_a = a / (c + a), w_b = b / (c + b), w_0 = 0.2 * 0.75, w = w_a + w_b + w_0;
    const std::vector<PhdFeature> all = particle.all();
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0].id.value, 0);
    EXPECT_NEAR(all[0].weight, w, 1e-9);
    EXPECT_TRUE(test::near(all[0].point.mean, Vector2(5 + (0.05 * w_a - 0.1 * w_b) / w, 0), 1e-9));
    EXPECT_EQ(all[1].id.value, 1);
    EXPECT_EQ(all[2].id.value, 2);
    EXPECT_EQ(all[1].weight, 0.75);
}

TEST(PhdMapTest, BirthsAreTheUnexplainedOrAll) {
    for (const PhdBirths births : {PhdBirths::unexplained, PhdBirths::all}) {
        PhdMapParameters p = parameters();
        p.births = births;
        Particle particle(p);
        particle.take(scanAt(0, {{5, 0}}));
        particle.take(scanAt(1, {{5, 0}}));
        EXPECT_EQ(particle.all().size(), births == PhdBirths::all ? 2u : 1u);
    }
}

// Where a pose is known a birth is what the sensor's model makes of the detection there.
TEST(PhdMapTest, BirthsFromAnyPoseAndSensor) {
    const Pose2 pose{3, -2, 2.1}, mount{0.5, 0.2, -0.8};
    for (const GaussianTransform transform : {GaussianTransform::linear, GaussianTransform::unscented}) {
        DetectionSet set = scanAt(0, {});
        sensorOf(set).pose = mount;
        const RangeBearingDetection z = nameless({7, 4}, pose, mount);
        std::get<RangeBearingSet>(set.measurements).detections.push_back(z);
        Particle particle;
        particle.settings.transform = transform;
        particle.take(set, pose);
        const GaussianPoint expected =
            firstSight(placeOf(pose.vector(), mount), z.z(), z.covariance, transform);
        EXPECT_TRUE(test::near(particle.all().at(0).point.mean, expected.mean, 1e-13));
        EXPECT_TRUE(test::near(particle.all().at(0).point.covariance, expected.covariance, 1e-14));
    }
}

/// A particle with one landmark of weight `weight`, seen at `range` straight ahead.
Particle withLandmark(double range, double weight, PhdMapParameters p = parameters()) {
    p.largest_birth = weight;
    p.new_per_scan = 1000;
    Particle particle(p);
    particle.take(scanAt(0, {{range, 0}}));
    return particle;
}

TEST(PhdMapTest, MissesCountWithinTheMarginAndForWhatIsNoLandmarkYetUpToTheOuterOne) {
    const auto left = [](double range, double weight) {
        Particle particle = withLandmark(range, weight);
        const double log_likelihood = particle.take(scanAt(1, {}));
        EXPECT_NEAR(log_likelihood, particle.total() == weight ? 0 : -p_d * weight, 1e-12);
        return particle.total() / weight;
    };
    EXPECT_NEAR(left(19.3, 0.75), 1 - p_d, 1e-12);
    EXPECT_EQ(left(19.5, 0.75), 1);
    EXPECT_EQ(left(20.5, 0.75), 1);
    EXPECT_EQ(left(20.7, 0.75), 1);
    EXPECT_NEAR(left(19.5, 0.4), 1 - p_d, 1e-12);
    EXPECT_NEAR(left(20.5, 0.4), 1 - p_d, 1e-12);
    EXPECT_EQ(left(20.7, 0.4), 1);
    EXPECT_EQ(left(0.2, 0.75), 1);
}

// Detected at the rim, where a miss would not count, a landmark is not there twice.
TEST(PhdMapTest, WeightsDoNotPileUpAtTheRim) {
    Particle particle = withLandmark(19.7, 0.75);
    for (int k = 1; k < 10; ++k) {
        particle.take(scanAt(k, {{19.7, 0}}));
        EXPECT_GT(particle.total(), 0.98);
        // What was detected, and what was not: (1 - P_D) of at most 1 / P_D.
        EXPECT_LT(particle.total(), 1.25);
    }
    EXPECT_EQ(particle.all().at(0).seen, 10);
}

// The set likelihood leaves out what does not depend on the pose; so do the others, with Bayes' rule at their
// map: without a landmark exp(sum w after - sum w before), with the best known one besides (1 - P_D + P_D
// N(z; h(m), R) / c) v-(m) / v(m).
TEST(PhdMapTest, LikelihoodsByHand) {
    const double a = p_d * 0.75 * density(0.1);
    const double after = a / (c + a) + 0.2 * 0.75;
    PhdMapParameters p = parameters();
    p.likelihood = PhdLikelihood::empty_map;
    Particle empty(p);
    empty.take(scanAt(0, {{5, 0}}));
    EXPECT_NEAR(empty.take(scanAt(1, {{5.1, 0}})), after - 0.75, 1e-9);

    p.likelihood = PhdLikelihood::single_feature;
    Particle single(p);
    single.take(scanAt(0, {{5, 0}}));
    const double exact = std::exp(-0.5) / (2 * pi * 0.1 * 0.02);
    const double before_at = 0.75 / (2 * pi * 0.01);
    const double after_at =
        0.2 * before_at + a / (c + a) * std::exp(-0.5 * 0.05 * 0.05 / 0.005) / (2 * pi * 0.005);
    EXPECT_NEAR(single.take(scanAt(1, {{5.1, 0}})),
                after - 0.75 + std::log((1 - p_d + p_d * exact / c) * before_at / after_at), 1e-9);
    // Nothing there that counts for a landmark: the empty map's.
    Particle light = withLandmark(5, 0.4, p);
    EXPECT_NEAR(light.take(scanAt(1, {})), -p_d * 0.4, 1e-12);
}

// Variances 0.01, 0.005 after the update, and 0.01 0.005 / 0.015 after the second with the same detection.
TEST(PhdMapTest, ThePaperUpdatesLandmarksTwice) {
    PhdMapParameters p = parameters();
    p.merge_within = 0;
    p.correction = PhdCorrection::twice;
    Particle particle(p);
    particle.take(scanAt(0, {{5, 0}}));
    particle.take(scanAt(1, {{5.1, 0}}));
    EXPECT_NEAR(particle.all().at(0).point.mean.x(), 5.05 + 0.05 / 3, 1e-12);
    EXPECT_NEAR(particle.all().at(0).point.covariance(0, 0), 0.01 / 3, 1e-12);
}

TEST(PhdMapTest, OnlyLandmarksRefineThePoseAndEachByOneDetection) {
    const PoseBelief belief{Vector3::Zero(), 0.1 * Matrix3::Identity()};
    const auto refined = [&](Particle& particle, const std::vector<Vector2>& points) {
        const ParticleScan scan = particle.scans.scan(scanAt(1, points));
        particle.work = {};
        particle.map.pairUp(particle.settings, belief, scan, particle.work, particle.records);
        RefinedPose out(belief);
        particle.map.refine(particle.settings, scan, particle.work, out);
        return out.belief();
    };
    Particle light = withLandmark(5, 0.4), heavy = withLandmark(5, 0.6);
    EXPECT_EQ(refined(light, {{5, 0}}).factor, belief.factor);
    EXPECT_EQ(light.records.at(0).outcome, Outcome::ignored);

    const PoseBelief once = refined(heavy, {{5, 0}});
    const PointSight sight = sightOf(heavy.all().at(0).point, belief, {}, GaussianTransform::linear);
    RefinedPose expected(belief);
    const RangeBearingDetection z = nameless({5, 0});
    expected.take(sight, PointInnovation(sight, z.z(), z.covariance));
    EXPECT_EQ(once.factor, expected.belief().factor);

    // Two detections of one landmark: the nearer is taken.
    EXPECT_EQ(refined(heavy, {{5.1, 0}, {5, 0}}).mean, once.mean);
    EXPECT_EQ(heavy.records.at(0).outcome, Outcome::ignored);
    EXPECT_EQ(heavy.records.at(1).outcome, Outcome::updated);
}

// One after the other: what the first sensor has seen the second may miss.
TEST(PhdMapTest, TwoSensorsUpdateTheMapInTurn) {
    Particle particle;
    DetectionSet set = test::scanOfTwo(0, {nameless({5, 0}), nameless({0, 8})});
    particle.take(set);
    ASSERT_EQ(particle.all().size(), 2u);
    set.stamp = Stamp::fromSeconds(1);
    const double q = p_d * 0.75 * density(0), w = q / (c + q) + 0.2 * 0.75, missed = 0.2 * 0.75;
    const double q_missed = p_d * missed * density(0);
    // The first sees (5, 0) and misses (0, 8); the second sees (0, 8), by now light, and misses (5, 0). At 8
    // m the detection is as likely as at 5 m, in polar coordinates.
    EXPECT_NEAR(particle.take(set), std::log(c + q) - p_d * 1.5 + std::log(c + q_missed) - p_d * (w + missed),
                1e-9);
    EXPECT_NEAR(particle.all()[0].weight, 0.2 * w, 1e-9);
    EXPECT_NEAR(particle.all()[1].weight, q_missed / (c + q_missed) + 0.2 * missed, 1e-9);
}

TEST(PhdMapTest, LightComponentsOutOfReachAreDropped) {
    PhdMapParameters p = parameters();
    p.largest_birth = 0.09;
    Particle particle(p);
    particle.take(scanAt(0, {{5, 0}}));
    // Behind a sensor that looks ahead nothing is missed and nothing is out of reach.
    DetectionSet ahead = scanAt(1, {});
    sensorOf(ahead).field_of_view = pi;
    particle.take(ahead, {10, 0, 0});
    EXPECT_EQ(particle.total(), 0.09);
    ahead.stamp = Stamp::fromSeconds(2);
    particle.take(ahead, {26, 0, 0});
    EXPECT_TRUE(particle.all().empty());
}

TEST(PhdMapTest, NumbersAscendInAnyClutter) {
    Particle particle;
    particle.settings.parameters.merge_within = 0.5;
    RandomStream random(3, RandomPurpose::test, 0, 0);
    std::size_t most = 0;
    for (int k = 0; k < 300; ++k) {
        const Pose2 pose{0.05 * k, 0, 0};
        std::vector<Vector2> points;
        for (int i = 0; i < 8; ++i) points.push_back({5 + random.normal(), random.normal()});
        for (int i = 0; i < 8; ++i)
            if (random.uniform() < p_d) points.push_back({3.0 * i, 4 + 0.1 * random.normal()});
        particle.take(scanAt(k, points, pose), pose);
        std::int64_t last = -1;
        for (const PhdFeature& feature : particle.all()) {
            EXPECT_GT(feature.id.value, last);
            last = feature.id.value;
            EXPECT_EQ(particle.map.find(feature.id)->weight, feature.weight);
            EXPECT_TRUE(feature.weight > 0 && feature.point.mean.allFinite());
        }
        most = std::max(most, particle.all().size());
    }
    EXPECT_GT(most, 20u);
}

// Four pages of landmarks, 100 m apart. A narrow view finds one of the second page.
TEST(PhdMapTest, AScanCopiesNoPageThatIsOutOfReachAndNoneThatItDoesNotChange) {
    const auto look = [](int k, const Pose2& pose, const std::vector<Vector2>& points) {
        DetectionSet set = scanAt(k, points, pose);
        sensorOf(set).field_of_view = radians(1);
        return set;
    };
    Particle particle;
    for (int k = 0; k < 64; ++k) {
        const double x = 100.0 * (k / 16), y = 3 + k % 16;
        particle.take(look(k, {x, 0, 0}, {{x + 5, y}}), {x, 0, 0});
    }
    ASSERT_EQ(particle.all().size(), 64u);
    const PhdMap copy = particle.map;
    particle.map.renew(3);
    const auto owned = [&] {
        const auto bytes = particle.map.features().bytes();
        return 4 * bytes[0] / bytes[1];
    };
    // Within reach, but not in view.
    particle.take(look(100, {100, 0, pi}, {}), {100, 0, pi});
    EXPECT_EQ(owned(), 0u);
    // In view with its neighbours, which lie on the margin: nothing becomes of them.
    const Pose2 pose{100, 0, std::atan2(8.0, 5.0)};
    particle.take(look(101, pose, {{105, 8}}), pose);
    EXPECT_EQ(particle.all().size(), 64u);
    EXPECT_EQ(particle.all()[21].seen, 2);
    EXPECT_EQ(owned(), 1u);
    EXPECT_EQ(copy.features().find(particle.all()[21].id)->seen, 1);
}

TEST(PhdMapTest, IdentitiesAreNotUsed) {
    DetectionSet named = scanAt(0, {{5, 0}});
    std::get<RangeBearingSet>(named.measurements).detections.front().source = SourceId{3};
    EXPECT_FALSE(withoutIdentities(named).rangeBearing().detections.front().source.valid());
    Particle particle;
    particle.take(withoutIdentities(named));
    EXPECT_FALSE(particle.all().at(0).source.valid());
}

}  // namespace phd_map_test
}  // namespace slamot
