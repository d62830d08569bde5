#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "slamot/core/association/NearestNeighbour.h"

namespace slamot {
namespace nearest_neighbour_test {

using testing::ElementsAre;

TEST(NearestNeighbour, AnObjectGoesToTheDetectionItExplainsBest) {
    // Both detections want object 0. Detection 1 is likelier; 0 takes its next best.
    const AssociationProblem problem(2, 2, {{0, 0, 2, -1}, {0, 1, 5, -3}, {1, 0, 1, -0.5}});
    EXPECT_THAT(nearestNeighbour(problem).objects(problem), ElementsAre(1, 0));
}

TEST(NearestNeighbour, WhoHasNoOtherChoiceStaysAlone) {
    const AssociationProblem problem(3, 1, {{0, 0, 2, -1}, {1, 0, 1, -0.5}});
    const Pairing pairing = nearestNeighbour(problem);
    EXPECT_THAT(pairing.objects(problem), ElementsAre(-1, 0, -1));
    EXPECT_EQ(pairing.pairs(), 1);
}

TEST(NearestNeighbour, LikelihoodNotDistance) {
    // An object of large uncertainty has the smaller NIS and the lower density.
    const AssociationProblem problem(1, 2, {{0, 0, 0.5, -4}, {0, 1, 2, -1}});
    EXPECT_THAT(nearestNeighbour(problem).objects(problem), ElementsAre(1));
}

TEST(NearestNeighbour, TiesGoToTheSmallerDistanceThenToTheEarlier) {
    const AssociationProblem by_distance(1, 2, {{0, 0, 2, -1}, {0, 1, 1, -1}});
    EXPECT_THAT(nearestNeighbour(by_distance).objects(by_distance), ElementsAre(1));
    const AssociationProblem by_number(2, 1, {{0, 0, 1, -1}, {1, 0, 1, -1}});
    EXPECT_THAT(nearestNeighbour(by_number).objects(by_number), ElementsAre(0, -1));
}

TEST(NearestNeighbour, NothingToPair) {
    EXPECT_THAT(nearestNeighbour({2, 3, {}}).candidate_of_detection, ElementsAre(-1, -1));
    EXPECT_TRUE(nearestNeighbour({0, 0, {}}).candidate_of_detection.empty());
}

}  // namespace nearest_neighbour_test
}  // namespace slamot
