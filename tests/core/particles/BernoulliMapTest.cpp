#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "OneParticle.h"
#include "slamot/core/particles/BernoulliMap.h"
#include "slamot/core/random/RandomStream.h"
#include "support/Expect.h"

namespace slamot {
namespace bernoulli_map_test {

using test::nameless;
using test::scanAt;
using test::seen;

constexpr double p_d = 0.7, range_limit = 20;

/// Without a density of undetected features: what is new comes at the same rate everywhere. However unlikely
/// something is, it is started and kept.
BernoulliMapParameters parameters() {
    BernoulliMapParameters out;
    out.life.detection_probability = p_d;
    out.life.clutter_per_scan = 2;
    out.life.new_per_scan = 0.5;
    out.life.hidden_every = std::numeric_limits<double>::infinity();
    out.life.remove_probability = 1e-12;
    out.density = 0;
    out.gate_probability = 1 - 1e-15;
    return out;
}
constexpr double area = range_limit * 2 * pi, clutter = 2 / area, fresh = 0.5 / area,
                 unexplained = clutter + fresh;

struct Particle : test::OneParticle<BernoulliMap, BernoulliFeature> {
    explicit Particle(BernoulliMapParameters p = parameters())
        : OneParticle({p, GaussianTransform::linear}, {p.life, p.use_nameless}) {
        drawn = true;
    }
};

/// What one detection makes of a feature, by the equations of a Kalman filter in another form than the map's.
struct Corrected {
    double density;  ///< N(z; h, S)
    GaussianPoint point;
};
Corrected corrected(const GaussianPoint& prior, const RangeBearingDetection& detection) {
    const RangeBearingPrediction h = predictRangeBearing(Vector3::Zero(), prior.mean, {});
    const Matrix2 S = h.H_point * prior.covariance * h.H_point.transpose() + detection.covariance;
    const Vector2 nu = rangeBearingResidual(detection.z(), h.z);
    const Matrix2 K = prior.covariance * h.H_point.transpose() * S.inverse();
    const Matrix2 left = Matrix2::Identity() - K * h.H_point;
    return {std::exp(-0.5 * nu.dot(S.inverse() * nu)) / (2 * pi * std::sqrt(S.determinant())),
            {prior.mean + K * nu,
             left * prior.covariance * left.transpose() + K * detection.covariance * K.transpose()}};
}

// --- one feature
// ---------------------------------------------------------------------------------------------------

TEST(BernoulliMapTest, BirthDetectionAndMissByHand) {
    Particle particle;
    EXPECT_NEAR(particle.take(scanAt(0, {nameless({5, 0})})), std::log(unexplained), 1e-12);
    double r = fresh / unexplained;
    ASSERT_EQ(particle.all().size(), 1u);
    EXPECT_NEAR(particle.all().at(0).existence.probability(), r, 1e-12);
    EXPECT_TRUE(
        test::near(particle.all().at(0).point.covariance, Matrix2(0.01 * Matrix2::Identity()), 1e-14));

    // Again, 0.1 m farther: S = diag(0.02, 0.0008). Either the feature was detected, or it was missed or is
    // not there and the detection is false or new; then something new may be there.
    const double N = std::exp(-0.25) / (2 * pi * std::sqrt(0.02 * 0.0008));
    const double hit = r * p_d * N, miss = (1 - r * p_d) * unexplained, all = hit + miss;
    EXPECT_NEAR(particle.take(scanAt(1, {nameless({5.1, 0})})), std::log(all), 1e-9);
    const double there = r * (1 - p_d) / (1 - r * p_d);
    ASSERT_EQ(particle.all().size(), 2u);
    EXPECT_NEAR(particle.all().at(1).existence.probability(), miss / all * fresh / unexplained, 1e-9);
    const BernoulliFeature feature = particle.all().at(0);
    EXPECT_NEAR(feature.existence.probability(), hit / all + miss / all * there, 1e-9);
    // The mixture of what it is detected, at 5.05 with half the variances, and as it was.
    const double w = hit / (hit + miss * there);
    EXPECT_TRUE(test::near(feature.point.mean, Vector2(5 + 0.05 * w, 0), 1e-12));
    EXPECT_NEAR(feature.point.covariance(1, 1), 0.01 - 0.005 * w, 1e-12);
    EXPECT_NEAR(feature.point.covariance(0, 0), 0.01 - 0.005 * w + w * (1 - w) * 0.05 * 0.05, 1e-12);

    // Nothing is seen.
    Particle other = particle;
    r = feature.existence.probability();
    const double second = particle.all().at(1).existence.probability();
    EXPECT_NEAR(other.take(scanAt(2, {})), std::log((1 - r * p_d) * (1 - second * p_d)), 1e-9);
    EXPECT_NEAR(other.all().at(0).existence.probability(), r * (1 - p_d) / (1 - r * p_d), 1e-12);
    EXPECT_TRUE(other.all().at(0).point.mean == feature.point.mean);
}

// What was seen many times outlives many misses, and goes in the end.
TEST(BernoulliMapTest, AFeatureThatIsMissedIsKeptUntilItIsUnlikely) {
    BernoulliMapParameters p = parameters();
    p.life.remove_probability = 0.01;
    p.max_unseen = std::numeric_limits<double>::infinity();
    Particle particle(p);
    for (int k = 0; k < 20; ++k) particle.take(scanAt(k, {nameless({5, 0})}));
    ASSERT_EQ(particle.all().size(), 1u);
    // A billion to one, for each miss by 0.3 less: 15 misses bring it below 0.99.
    int misses = 0;
    for (; BernoulliMap::isConfirmed(particle.settings, particle.all().at(0)); ++misses)
        particle.take(scanAt(20 + misses, {}));
    EXPECT_EQ(misses, static_cast<int>(std::ceil(std::log(1e9 / 99) / std::log(1 / 0.3))));
    for (int k = 0; k < 10; ++k) particle.take(scanAt(50 + k, {}));
    EXPECT_TRUE(particle.all().empty());
}

// --- several
// ---------------------------------------------------------------------------------------------------

/// Exact posterior of features given detections: the sum over all pairings, and over what is there besides
/// what is seen.
struct Enumerated {
    double all = 0;
    std::vector<double> existence, none;
    std::vector<FeatureMixture> points;

    Enumerated(const std::vector<BernoulliFeature>& features,
               const std::vector<RangeBearingDetection>& detections)
        : existence(features.size(), 0), none(detections.size(), 0), points(features.size()) {
        std::vector<int> of(detections.size(), -1);  // which feature each detection is of; -1: unexplained
        do add(features, detections, of);
        while (next(of, static_cast<int>(features.size())));
        for (double& p : existence) p /= all;
        for (double& p : none) p /= all;
    }

  private:
    static bool next(std::vector<int>& of, int features) {
        for (int& each : of) {
            if (++each < features) return true;
            each = -1;
        }
        return false;
    }

    void add(const std::vector<BernoulliFeature>& features,
             const std::vector<RangeBearingDetection>& detections, const std::vector<int>& of) {
        double weight = 1;
        std::vector<int> detection_of(features.size(), -1);
        for (std::size_t d = 0; d < of.size(); ++d) {
            if (of[d] < 0) {
                weight *= unexplained;
                continue;
            }
            int& taken = detection_of[static_cast<std::size_t>(of[d])];
            if (taken >= 0) return;
            taken = static_cast<int>(d);
        }
        std::vector<GaussianPoint> point(features.size());
        std::vector<double> there(features.size(), 1);
        for (std::size_t n = 0; n < features.size(); ++n) {
            const double r = features[n].existence.probability();
            point[n] = features[n].point;
            if (detection_of[n] >= 0) {
                const Corrected hit =
                    corrected(point[n], detections[static_cast<std::size_t>(detection_of[n])]);
                weight *= r * p_d * hit.density;
                point[n] = hit.point;
            } else {
                weight *= r * (1 - p_d) + (1 - r);
                there[n] = r * (1 - p_d) / (r * (1 - p_d) + (1 - r));
            }
        }
        all += weight;
        for (std::size_t n = 0; n < features.size(); ++n) {
            existence[n] += weight * there[n];
            points[n].add(weight * there[n], point[n]);
        }
        for (std::size_t d = 0; d < of.size(); ++d) none[d] += of[d] < 0 ? weight : 0;
    }
};

// Features and detections at several distances from one another: existence, mean and covariance of each
// feature, what may be new, and the likelihood of the scan are those of the sum over all that may be.
TEST(BernoulliMapTest, AgreesWithEnumerationOfAllAssociations) {
    int disputed = 0, compared = 0, most = 0;
    for (const double apart : {0.1, 0.3, 0.6, 1.0}) {
        for (int looks = 1; looks < 4; ++looks) {
            for (const double aside : {-0.4, -0.2, 0.0, 0.15, 0.3, 0.4, 0.5}) {
                Particle particle;
                for (int k = 0; k < looks; ++k)
                    particle.take(scanAt(k, {nameless({5, 0}), nameless({5, apart})}));
                const std::vector<BernoulliFeature> before = particle.all();
                most = std::max(most, static_cast<int>(before.size()));
                const std::vector<RangeBearingDetection> detections{nameless({5.05, aside}),
                                                                    nameless({4.95, apart - aside})};
                const Enumerated exact(before, detections);
                ASSERT_NEAR(particle.take(scanAt(looks, detections)), std::log(exact.all), 1e-9);
                for (std::size_t n = 0; n < before.size(); ++n) {
                    const BernoulliFeature* after = particle.map.find(before[n].id);
                    ASSERT_TRUE(after);
                    EXPECT_NEAR(after->existence.probability(), exact.existence[n], 1e-9);
                    disputed += exact.existence[n] > 0.01 && exact.existence[n] < 0.99;
                    // Pairs below 1e-8 are left out of the mixture, which shows where a feature hardly
                    // exists.
                    if (exact.existence[n] < 0.05) continue;
                    ++compared;
                    const GaussianPoint point = exact.points[n].moments();
                    EXPECT_TRUE(test::near(after->point.mean, point.mean, 1e-6));
                    EXPECT_TRUE(test::near(after->point.covariance, point.covariance, 1e-6));
                }
                for (std::size_t d = 0; d < 2; ++d) {
                    const LandmarkId birth{2 * looks + static_cast<std::int64_t>(d)};
                    const BernoulliFeature* born = particle.map.find(birth);
                    ASSERT_TRUE(born || exact.none[d] < 1e-12);
                    disputed += exact.none[d] > 0.01 && exact.none[d] < 0.99;
                    if (!born) continue;
                    EXPECT_NEAR(born->existence.probability(), exact.none[d] * fresh / unexplained, 1e-9);
                }
            }
        }
    }
    EXPECT_GT(disputed, 20);  // the cases are not all decided
    EXPECT_GT(compared, 80);
    EXPECT_GT(most, 2);
}

TEST(BernoulliMapTest, ClustersAboveTheBudgetAreApproximated) {
    // Two by two, all alike: the exact sum against Bethe's, which is below.
    std::vector<double> logs;
    for (const int budget : {500, 1}) {
        BernoulliMapParameters p = parameters();
        p.state_budget = budget;
        Particle particle(p);
        for (int k = 0; k < 3; ++k) particle.take(scanAt(k, {nameless({5, 0}), nameless({5, 0.02})}));
        logs.push_back(particle.take(scanAt(3, {nameless({5, 0.0}), nameless({5, 0.02})})));
    }
    EXPECT_LT(logs[1], logs[0]);
    EXPECT_NEAR(logs[1], logs[0], std::log(2.0));  // of two perfect pairings it counts one at least
}

// --- what was not seen yet
// ---------------------------------------------------------------------------------------------------

// Nu = P_D lambda r where nobody has looked, P_D lambda r (1 - P_D)^k after k looks; the scan's likelihood
// has the expected number of first detections.
TEST(BernoulliMapTest, WhatIsNewIsLikelierWhereNobodyHasLooked) {
    BernoulliMapParameters p = parameters();
    p.density = 0.01;
    p.life.new_per_scan = 0;
    Particle particle(p);
    // The ground is what cells of 2.5 m have whose centres are in the circle.
    double ground = 0;
    for (double x = -38.75; x < 40; x += 2.5)
        for (double y = -38.75; y < 40; y += 2.5)
            if (x * x + y * y <= range_limit * range_limit) ground += 2.5 * 2.5;
    ASSERT_NEAR(ground, range_limit * range_limit * pi, 50);
    double left = 1;
    for (int k = 0; k < 3; ++k) {
        const double nu = p_d * p.density * left * 5;
        const double log_likelihood =
            particle.take(scanAt(k, {nameless(Vector2(5 * std::cos(k), 5 * std::sin(k)))}));
        const BernoulliFeature born = particle.all().back();
        EXPECT_NEAR(born.existence.probability(), nu / (nu + clutter), 1e-6);
        if (k == 0) {
            EXPECT_NEAR(log_likelihood, std::log(nu + clutter) - p_d * p.density * ground, 1e-5);
        }
        left *= 1 - p_d;
    }
}

TEST(BernoulliMapTest, NothingStartsWhereNothingNewIsExpected) {
    BernoulliMapParameters p = parameters();
    p.density = p.life.new_per_scan = 0;
    Particle particle(p);
    for (int k = 0; k < 3; ++k) particle.take(scanAt(k, {nameless({5, 0})}));
    EXPECT_TRUE(particle.all().empty());
}

// --- one or two
// ---------------------------------------------------------------------------------------------------

/// A scan of points of which each is detected with P_D.
DetectionSet drawnScan(int k, const std::vector<Vector2>& points, RandomStream& random) {
    std::vector<RangeBearingDetection> detections;
    for (const Vector2& point : points) {
        if (random.uniform() >= p_d) continue;
        RangeBearingDetection each = nameless(point);
        each.range += 0.1 * random.normal();
        each.bearing += 0.02 * random.normal();
        detections.push_back(each);
    }
    return scanAt(k, detections);
}

int confirmed(const Particle& particle) {
    int count = 0;
    particle.map.forEachConfirmed(particle.settings, [&](const BernoulliFeature&) { ++count; });
    return count;
}

// A map that has one feature twice, 0.15 m apart, as after a loop: it becomes one, be it that they are merged
// or that one of them is missed too often.
TEST(BernoulliMapTest, FeaturesThatAreOneAreMerged) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        RandomStream random(seed, RandomPurpose::test);
        Particle particle;
        for (int k = 0; k < 8; ++k) particle.take(scanAt(k, {nameless({5, 0}), nameless({5.15, 0})}));
        ASSERT_EQ(confirmed(particle), 2);
        int k = 8;
        for (; confirmed(particle) == 2 && k < 60; ++k) particle.take(drawnScan(k, {{5.08, 0}}, random));
        EXPECT_LT(k, 40) << seed;
        for (int more = 0; more < 40; ++more) particle.take(drawnScan(k + more, {{5.08, 0}}, random));
        EXPECT_EQ(confirmed(particle), 1) << seed;
    }
}

/// One thing that the map has twice, half a metre apart, as after a loop: never both seen in one scan.
Particle withDouble(const BernoulliMapParameters& p) {
    Particle particle(p);
    for (int k = 0; k < 8; ++k) particle.take(scanAt(k, {nameless({5, 0})}));
    for (int k = 8; k < 16; ++k) particle.take(scanAt(k, {nameless({5.5, 0})}));
    return particle;
}

// What is merged has the number of the older, the sights of both and a place between.
TEST(BernoulliMapTest, TheYoungerGoesIntoTheOlder) {
    for (const bool merges : {true, false}) {
        BernoulliMapParameters p = parameters();
        p.merge_probability = merges ? 0.99 : 1 - 1e-15;
        Particle particle = withDouble(p);
        const std::vector<BernoulliFeature> before = particle.all();
        ASSERT_EQ(confirmed(particle), 2);
        for (int k = 16; k < 21; ++k) particle.take(scanAt(k, {nameless({5.25, 0})}));
        EXPECT_EQ(confirmed(particle), merges ? 1 : 2);
        if (!merges) continue;
        const BernoulliFeature* kept = particle.map.find(before[0].id);
        ASSERT_TRUE(kept);
        EXPECT_GE(kept->seen, 16 + 5 - 1);
        EXPECT_NEAR(kept->point.mean.x(), 5.25, 0.03);
        EXPECT_FALSE(particle.map.find(before[1].id));
    }
}

// What was seen side by side for long may still turn out to be one.
TEST(BernoulliMapTest, OddsOfBeingTwoAreBounded) {
    Particle particle;
    // Near enough to be taken for one by a detection between them, and always seen both.
    for (int k = 0; k < 60; ++k) particle.take(scanAt(k, {nameless({5, 0}), nameless({5.45, 0})}));
    ASSERT_EQ(confirmed(particle), 2);
    const BernoulliFeature second = particle.all().at(1);
    ASSERT_EQ(second.rival, particle.all().at(0).id);
    EXPECT_EQ(second.same, -particle.settings.merge_odds);
    // As after a loop: from now on there is one thing, between them.
    int k = 60;
    for (; confirmed(particle) == 2 && k < 100; ++k) particle.take(scanAt(k, {nameless({5.22, 0})}));
    EXPECT_EQ(confirmed(particle), 1);
    EXPECT_LT(k, 100);
}

// The second sensor does not meet what was merged in the first one's turn: its sights would count twice.
TEST(BernoulliMapTest, WhatIsMergedIsMergedOnce) {
    Particle particle = withDouble(parameters());
    std::int64_t seen = 0;
    for (int k = 16; confirmed(particle) == 2 && k < 30; ++k) {
        seen = particle.all()[0].seen + particle.all()[1].seen;
        particle.take(test::scanOfTwo(k, {nameless({5.25, 0}), nameless({5.25, 0})}));
    }
    ASSERT_EQ(confirmed(particle), 1);
    EXPECT_LE(particle.all()[0].seen, seen + 4);
}

// Two features 0.4 m apart, four deviations of what a detection says, stay two.
TEST(BernoulliMapTest, FeaturesThatAreTwoStayTwo) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        RandomStream random(seed, RandomPurpose::test);
        Particle particle;
        for (int k = 0; k < 200; ++k) particle.take(drawnScan(k, {{5, 0}, {5.4, 0}}, random));
        EXPECT_EQ(confirmed(particle), 2) << seed;
    }
}

// --- sensors, names, memory
// ---------------------------------------------------------------------------------------------------

TEST(BernoulliMapTest, OnlyLooksThatWouldShowAFeatureSpeakAgainstIt) {
    Particle particle;
    for (int k = 0; k < 5; ++k) particle.take(scanAt(k, {nameless({5, 0})}));
    const double before = particle.all().at(0).existence.probability();
    EXPECT_EQ(particle.take(test::scanBehind(5)), 0);
    EXPECT_EQ(particle.all().at(0).existence.probability(), before);
}

// Two sensors that see the same thing at the same time: what the first starts, the second confirms.
TEST(BernoulliMapTest, SensorsHaveTheirTurns) {
    Particle particle;
    particle.take(test::scanOfTwo(0, {nameless({5, 0}), nameless({5, 0})}));
    double r = fresh / unexplained;
    const double N = 1 / (2 * pi * std::sqrt(0.02 * 0.0008)), hit = r * p_d * N,
                 miss = (1 - r * p_d) * unexplained;
    r = hit / (hit + miss) + miss / (hit + miss) * r * (1 - p_d) / (1 - r * p_d);
    EXPECT_NEAR(particle.all().at(0).existence.probability(), r, 1e-9);
}

TEST(BernoulliMapTest, NamedFeaturesWeighByTheirInnovationAlone) {
    Particle particle;
    EXPECT_EQ(particle.take(scanAt(0, {seen({}, {5, 0}, ObjectKind::landmark, 7)})), 0);
    EXPECT_EQ(particle.records.at(0).outcome, Outcome::initiated);
    // As in LandmarkFiltersTest.
    const double log_likelihood = particle.take(scanAt(1, {seen({}, {5.1, 0}, ObjectKind::landmark, 7)}));
    EXPECT_NEAR(log_likelihood, -0.5 * 0.01 / 0.02 - 0.5 * std::log(0.02 * 0.0008) - std::log(2 * pi), 1e-12);
    EXPECT_TRUE(test::near(particle.all().at(0).point.mean, Vector2(5.05, 0), 1e-14));
    EXPECT_EQ(particle.take(scanAt(2, {})), 0);
    EXPECT_EQ(particle.all().size(), 1u);
}

TEST(BernoulliMapTest, AScanCopiesNoPageThatIsOutOfReach) {
    Particle particle;
    for (int k = 0; k < 64; ++k) {
        const double x = 5 + 100.0 * (k / 16);
        particle.take(scanAt(k, {seen({}, {x, 0.1 * (k % 16)}, ObjectKind::landmark, k)}));
    }
    BernoulliMap copy = particle.map;
    copy.renew(2);
    particle.map.renew(3);
    EXPECT_EQ(particle.map.features().bytes()[0], 0u);
    particle.take(scanAt(100, {seen({}, {5, 0}, ObjectKind::landmark, 0), nameless({-5, 5})}));
    // The page of the feature that was seen and its neighbours in view, and the last one, where the new one
    // is.
    EXPECT_EQ(particle.map.features().pages(), 5);
    EXPECT_EQ(particle.map.features().bytes()[0] * 5, particle.map.features().bytes()[1] * 2);
}

// A detection half-way between two features is of each with a probability of half at most.
TEST(BernoulliMapTest, PairsInDoubtDoNotRefineThePose) {
    const PoseBelief belief{Vector3::Zero(), 0.1 * Matrix3::Identity()};
    const auto refines = [&](Particle& particle, const Vector2& point) {
        const ParticleScan scan = particle.scans.scan(scanAt(8, {nameless(point)}));
        particle.map.pairUp(particle.settings, belief, scan, particle.work, particle.records);
        RefinedPose out(belief);
        particle.map.refine(particle.settings, scan, particle.work, out);
        return !(out.belief().factor == belief.factor);
    };
    Particle in_doubt, sure;
    for (int k = 0; k < 8; ++k) {
        in_doubt.take(scanAt(k, {nameless({5, 0}), nameless({5, 0.3})}));
        sure.take(scanAt(k, {nameless({5, 0})}));
    }
    EXPECT_FALSE(refines(in_doubt, {5, 0.15}));
    EXPECT_TRUE(refines(sure, {5, 0}));
}

}  // namespace bernoulli_map_test
}  // namespace slamot
