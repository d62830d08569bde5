#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "PairScene.h"
#include "slamot/core/association/GatedPairs.h"
#include "slamot/core/random/RandomStream.h"
#include "support/Expect.h"

namespace slamot {
namespace gated_pairs_test {

/// Landmarks strewn over a disk of 12 m and detections likewise, some of them near a landmark.
test::PairScene strewn(std::uint64_t seed, Consistency consistency) {
    RandomStream random(seed, RandomPurpose::test);
    std::vector<Vector2> around, z;
    for (int i = 0; i < 60; ++i) {
        const double r = random.uniform(0.5, 12), b = random.uniform(-pi, pi);
        around.emplace_back(r * std::cos(b), r * std::sin(b));
        if (i % 3 == 0) z.emplace_back(r + random.normal(0, 0.3), b + random.normal(0, 0.05));
        if (i % 5 == 0) z.emplace_back(random.uniform(0.5, 12), random.uniform(-pi, pi));
    }
    return test::pairScene(2.9, around, z, {0.2, 0.1, 0.03}, 0.1, consistency);
}

TEST(GatedPairs, AreAllPairsWithinTheGate) {
    PairGates gates(0.99);
    for (const Consistency consistency : {Consistency::classic, Consistency::invariant}) {
        for (std::uint64_t seed = 0; seed < 20; ++seed) {
            const test::PairScene scene = strewn(seed, consistency);
            const GatedPairs found = scene.gated(gates);
            ASSERT_EQ(found.measurements.size(), static_cast<std::size_t>(found.problem.candidates()));
            int next = 0;
            for (const int d : scene.all) {
                for (std::size_t o = 0; o < scene.landmarks.size(); ++o) {
                    const Linearisation pair =
                        linearise(scene.state(), scene.landmarks[o],
                                  scene.seen.detections[static_cast<std::size_t>(d)], {}, consistency);
                    if (pair.nis > gates(1)) continue;
                    ASSERT_LT(next, found.problem.candidates());
                    const Candidate& candidate = found.problem.candidate(next);
                    ASSERT_EQ(candidate.detection, d);
                    ASSERT_EQ(candidate.object, static_cast<int>(o));
                    ASSERT_EQ(candidate.nis, pair.nis);
                    // log N by S's eigenvalues instead of its determinant
                    const Vector2 eigenvalues = pair.S.selfadjointView<Eigen::Lower>().eigenvalues();
                    ASSERT_NEAR(candidate.log_likelihood,
                                -0.5 * pair.nis - 0.5 * eigenvalues.array().log().sum() - std::log(2 * pi),
                                1e-9);
                    ASSERT_EQ(found.measurements[static_cast<std::size_t>(next)].residual,
                              pair.measurement.residual);
                    ++next;
                }
            }
            ASSERT_EQ(next, found.problem.candidates());
            ASSERT_GT(next, 20);
        }
    }
}

TEST(GatedPairs, OnlyTheDetectionsAskedFor) {
    const test::PairScene scene = strewn(3, Consistency::classic);
    PairGates gates(0.99);
    const GatedPairs all = scene.gated(gates);
    const std::vector<int> some{1, 4, 5, 20};
    const GatedPairs found =
        gatedPairs(scene.state(), scene.landmarks, scene.seen, some, Consistency::classic, gates);
    ASSERT_EQ(found.problem.detections(), all.problem.detections());
    int total = 0;
    for (int d = 0; d < all.problem.detections(); ++d) {
        const bool asked = std::find(some.begin(), some.end(), d) != some.end();
        EXPECT_EQ(found.problem.candidatesOf(d), asked ? all.problem.candidatesOf(d) : 0);
        total += found.problem.candidatesOf(d);
    }
    EXPECT_GT(total, 0);
}

TEST(GatedPairs, EachDetectionFromItsOwnSensor) {
    // One landmark straight behind; a second sensor that looks backwards sees it at bearing 0.
    test::PairScene scene = test::pairScene(1.0, {{-5, 0}}, {{5, pi}, {5, 0}, {5, 0}, {5, pi}},
                                            {0.1, 0.1, 0.02}, 0.1, Consistency::classic);
    scene.seen.sensors.emplace_back();
    scene.seen.sensors[1].pose = {0, 0, pi};
    scene.seen.detections[2].sensor = scene.seen.detections[3].sensor = 1;
    PairGates gates(0.99);
    const GatedPairs found = scene.gated(gates);
    ASSERT_EQ(found.problem.candidates(), 2);
    EXPECT_EQ(found.problem.candidate(0).detection, 0);
    EXPECT_EQ(found.problem.candidate(1).detection, 2);
    EXPECT_NEAR(found.problem.candidate(0).nis, 0, 1e-20);
}

TEST(GatedPairs, AcrossTheTurnOfTheBearing) {
    // Seen 0.01 rad on either side of straight behind.
    const test::PairScene scene =
        test::pairScene(0.0, {{-5, -0.05}, {-5, 0.05}}, {{5, pi - 0.01}, {5, -pi + 0.01}}, {0.1, 0.1, 0.02},
                        0.1, Consistency::classic);
    PairGates gates(0.99);
    EXPECT_EQ(scene.gated(gates).problem.candidates(), 4);
}

}  // namespace gated_pairs_test
}  // namespace slamot
