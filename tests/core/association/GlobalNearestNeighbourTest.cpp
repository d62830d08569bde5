#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "AssociationProblems.h"
#include "slamot/core/association/GlobalNearestNeighbour.h"
#include "slamot/core/association/NearestNeighbour.h"

namespace slamot {
namespace global_nearest_neighbour_test {

using testing::ElementsAre;

/// log of P_D N for pairs, c for detections alone, 1 - P_D P_G for objects missed: the whole batch.
double logOfBatch(const AssociationProblem& problem, const DetectionModel& model,
                  const std::vector<int>& pairs) {
    double log = 0;
    std::vector<char> used(static_cast<std::size_t>(problem.detections()), 0),
        seen(static_cast<std::size_t>(problem.objects()), 0);
    for (const int c : pairs) {
        const Candidate& pair = problem.candidate(c);
        used[static_cast<std::size_t>(pair.detection)] = seen[static_cast<std::size_t>(pair.object)] = 1;
        log += std::log(model.detection_probability[static_cast<std::size_t>(pair.object)]) +
               pair.log_likelihood;
    }
    for (std::size_t d = 0; d < used.size(); ++d) log += used[d] ? 0 : std::log(model.clutter_density[d]);
    for (std::size_t o = 0; o < seen.size(); ++o)
        log += seen[o] ? 0 : std::log(1 - model.detection_probability[o] * model.gate_probability);
    return log;
}

TEST(GlobalNearestNeighbour, AgreesWithBruteForceOnRandomProblems) {
    RandomStream random(21, RandomPurpose::test);
    int alone = 0, better_than_greedy = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const AssociationProblem problem = test::randomProblem(random, 1 + trial % 5, 1 + trial % 4, 0.5);
        const DetectionModel model = test::randomModel(random, problem);
        double best = -1e9;
        std::vector<int> best_pairs;
        test::forEachPairing(problem, test::allDetections(problem), [&](const std::vector<int>& pairs) {
            const double log = logOfBatch(problem, model, pairs);
            if (log <= best) return;
            best = log;
            best_pairs = pairs;
        });
        const auto listed = [](const Pairing& pairing) {
            std::vector<int> out;
            for (const int c : pairing.candidate_of_detection)
                if (c >= 0) out.push_back(c);
            return out;
        };
        // Likelihoods are drawn: no two pairings are equally likely.
        ASSERT_EQ(listed(globalNearestNeighbour(problem, model)), best_pairs) << trial;
        better_than_greedy += listed(nearestNeighbour(problem)) != best_pairs;
        alone += static_cast<int>(best_pairs.size()) < nearestNeighbour(problem).pairs();
    }
    EXPECT_GT(better_than_greedy, 30);
    EXPECT_GT(alone, 10);
}

TEST(GlobalNearestNeighbour, TheWholeNotTheNearest) {
    // Greedy gives object 0 to detection 0 and leaves detection 1 alone; both fit when 0 takes object 1.
    const AssociationProblem problem(2, 2, {{0, 0, 1, 0}, {0, 1, 1.5, -0.5}, {1, 0, 2, -1}});
    const DetectionModel model{{0.9, 0.9}, {0.01, 0.01}, 0.99};
    EXPECT_THAT(nearestNeighbour(problem).objects(problem), ElementsAre(0, -1));
    EXPECT_THAT(globalNearestNeighbour(problem, model).objects(problem), ElementsAre(1, 0));
}

TEST(GlobalNearestNeighbour, ClutterAndMissesHaveTheirPrice) {
    // A pair is made as long as P_D N > c (1 - P_D): 0.5 N > 0.5 c, so N against c.
    const AssociationProblem problem(1, 1, {{0, 0, 3, std::log(0.1)}});
    EXPECT_THAT(globalNearestNeighbour(problem, {{0.5}, {0.099}, 1}).objects(problem), ElementsAre(0));
    EXPECT_THAT(globalNearestNeighbour(problem, {{0.5}, {0.101}, 1}).objects(problem), ElementsAre(-1));
    EXPECT_THAT(globalNearestNeighbour(problem, {{0.0}, {0.099}, 1}).objects(problem), ElementsAre(-1));
}

}  // namespace global_nearest_neighbour_test
}  // namespace slamot
