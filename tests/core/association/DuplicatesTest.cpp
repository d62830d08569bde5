// A dozen landmarks 0.25 m apart, most of them copies of one another: each detection fits several, and all
// hypotheses are about equally good. Without a budget the search takes seconds.
#include <gtest/gtest.h>

#include "PairScene.h"
#include "slamot/core/association/JointCompatibility.h"
#include "slamot/core/association/LinearInnovations.h"
#include "slamot/core/association/SequentialCompatibility.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot {
namespace {

/// 12 landmarks in a row 10 m ahead, and a noisy detection of each.
test::PairScene row(std::uint64_t seed, double spacing, double landmark_std) {
    RandomStream random(seed, RandomPurpose::test);
    std::vector<Vector2> around, z;
    for (int i = 0; i < 12; ++i) {
        around.emplace_back(10, spacing * (i - 5.5));
        const Vector2 seen = around.back() + Vector2(random.normal(0, 0.1), random.normal(0, 0.2));
        z.emplace_back(seen.norm(), std::atan2(seen.y(), seen.x()));
    }
    return test::pairScene(0.5, around, z, {0.2, 0.2, 0.03}, landmark_std, Consistency::classic);
}

TEST(Duplicates, StayWithinTheNodeBudget) {
    PairGates gates(0.99);
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        const test::PairScene scene = row(seed, 0.25, 0.1);
        const GatedPairs gated = scene.gated(gates);
        LinearInnovations innovations(scene.state(), gated.measurements);
        for (int b : {2000, 20000, 200000, 2000000}) {
        const JointCompatibility found = jointCompatibility(gated.problem, innovations, gates, b);
        std::cout << seed << " cand " << gated.problem.candidates() << " nodes " << found.nodes << " exh " << found.exhausted << " pairs " << found.pairing.pairs() << " nis " << found.nis << " seq " << found.is_sequential << "\n";
        }
    }
}

}  // namespace
}  // namespace slamot
