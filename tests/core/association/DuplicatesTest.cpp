// A dozen landmarks 0.25 m apart, each seen with an error of about as much: every detection fits most of
// them, and thousands of hypotheses are about equally good.
#include <gtest/gtest.h>

#include "PairScene.h"
#include "slamot/core/association/JointCompatibility.h"
#include "slamot/core/association/LinearInnovations.h"
#include "slamot/core/association/SequentialCompatibility.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot {
namespace duplicates_test {

/// 12 landmarks in a row 10 m ahead, a noisy detection of each, and some that come from none of them.
test::PairScene row(std::uint64_t seed, int clutter) {
    RandomStream random(seed, RandomPurpose::test);
    std::vector<Vector2> around, z;
    for (int i = 0; i < 12; ++i) {
        around.emplace_back(10, 0.25 * (i - 5.5));
        const Vector2 seen = around.back() + Vector2(random.normal(0, 0.1), random.normal(0, 0.2));
        z.emplace_back(seen.norm(), std::atan2(seen.y(), seen.x()));
    }
    for (int i = 0; i < clutter; ++i) z.emplace_back(random.normal(10, 0.3), random.uniform(-0.15, 0.15));
    return test::pairScene(0.5, around, z, {0.2, 0.2, 0.03}, 0.1, Consistency::classic);
}

TEST(Duplicates, StayWithinTheNodeBudget) {
    PairGates gates(0.99);
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        const test::PairScene scene = row(seed, 4);
        const GatedPairs gated = scene.gated(gates);
        LinearInnovations innovations(scene.state(), gated.measurements);
        const JointCompatibility none = jointCompatibility(gated.problem, innovations, gates, 0),
                                 found = jointCompatibility(gated.problem, innovations, gates, 1000),
                                 again = jointCompatibility(gated.problem, innovations, gates, 1000);
        // Not even a hundred times as many nodes are enough here: the budget is what ends the search.
        EXPECT_TRUE(jointCompatibility(gated.problem, innovations, gates, 100000).exhausted);
        EXPECT_TRUE(found.exhausted);
        EXPECT_EQ(found.nodes, 1000);
        EXPECT_EQ(found.pairing.pairs(), 12);  // there are no more landmarks
        EXPECT_LE(found.nis, gates(12));
        EXPECT_TRUE(none.pairing.pairs() < 12 || found.nis <= none.nis);
        EXPECT_EQ(found.pairing.candidate_of_detection, again.pairing.candidate_of_detection);
    }
}

TEST(Duplicates, WithoutClutterTheSearchEndsByItself) {
    // All 12 pairs are soon made, and their NIS cuts off most of the tree: 11,505 nodes are the most here.
    PairGates gates(0.99);
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        const test::PairScene scene = row(seed, 0);
        const GatedPairs gated = scene.gated(gates);
        LinearInnovations innovations(scene.state(), gated.measurements);
        const JointCompatibility found = jointCompatibility(gated.problem, innovations, gates, 20000);
        EXPECT_FALSE(found.exhausted) << seed;
        EXPECT_EQ(found.pairing.pairs(), 12);
    }
}

}  // namespace duplicates_test
}  // namespace slamot
