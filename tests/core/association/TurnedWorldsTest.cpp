// Every method gives the same answer in a world turned by any angle. Detections lie all around, several
// straight behind, where the bearing turns over, and headings go through the full circle, pi and -pi
// included.
#include <gtest/gtest.h>

#include "PairScene.h"
#include "slamot/core/association/AssociationMarginals.h"
#include "slamot/core/association/GlobalNearestNeighbour.h"
#include "slamot/core/association/JointCompatibility.h"
#include "slamot/core/association/LandmarkIndex.h"
#include "slamot/core/association/LinearInnovations.h"
#include "slamot/core/association/NearestNeighbour.h"
#include "slamot/core/association/SequentialCompatibility.h"

namespace slamot {
namespace turned_worlds_test {

test::PairScene turned(double heading, Consistency consistency) {
    // Pairs of landmarks 0.4 to 0.6 m apart; a robot turned by 0.05 rad and shifted by 0.1 m from where it
    // believes to be, so that the nearest is often the wrong one; clutter at the end.
    const std::vector<Vector2> around{{-8, 0.1}, {-8, -0.4}, {-6, 3},  {-6.2, 3.5}, {5, 5},   {5.4, 4.8},
                                      {0, -7},   {0.5, -7},  {-3, -4}, {9, 0},      {9, 0.5}, {-5, 0}};
    std::vector<Vector2> z;
    for (const std::size_t i : {0, 1, 2, 4, 5, 6, 8, 9, 11}) {
        const Vector2 rel = around[i] - Vector2(0.1, -0.05);
        z.emplace_back(rel.norm(), std::atan2(rel.y(), rel.x()) - 0.05);
    }
    z.emplace_back(8.05, pi);
    z.emplace_back(8.0, -pi + 1e-9);
    z.emplace_back(3.0, 1.0);
    return test::pairScene(heading, around, z, {0.1, 0.1, 0.04}, 0.05, consistency);
}

struct Answers {
    std::vector<std::vector<int>> hard;
    AssociationMarginals exact, loopy;
    std::vector<Candidate> candidates;
    std::vector<BlockId> in_view, behind;
};

Answers answersAt(double heading, Consistency consistency) {
    const test::PairScene scene = turned(heading, consistency);
    PairGates gates(0.99);
    const GatedPairs gated = scene.gated(gates);
    const AssociationProblem& problem = gated.problem;
    LinearInnovations innovations(scene.state(), gated.measurements);
    const DetectionModel model{
        std::vector<double>(scene.landmarks.size(), 0.9),
        std::vector<double>(scene.all.size(), clutterDensity(5, scene.seen.sensors[0])), 0.99};
    Answers out;
    out.hard = {nearestNeighbour(problem).objects(problem),
                sequentialCompatibility(problem, innovations, gates).objects(problem),
                jointCompatibility(problem, innovations, gates, 100000).pairing.objects(problem),
                globalNearestNeighbour(problem, model).objects(problem)};
    out.exact = associationMarginals(problem, model, 100000);
    out.loopy = associationMarginals(problem, model, 0);
    for (int c = 0; c < problem.candidates(); ++c) out.candidates.push_back(problem.candidate(c));

    LandmarkIndex index;
    for (std::size_t i = 0; i < scene.landmarks.size(); ++i)
        index.set(scene.landmarks[i], scene.positions[i]);
    const PoseGaussian robot{scene.robot, scene.state().covariance(robot_block, robot_block)};
    RangeBearingSensor narrow = scene.seen.sensors[0];
    narrow.max_range = 7;
    narrow.field_of_view = radians(100);
    out.in_view = index.inView(robot, narrow, 0.99, 0.1);
    narrow.pose.theta = pi;
    out.behind = index.inView(robot, narrow, 0.99, 0.1);
    return out;
}

void expectSame(const std::vector<double>& a, const std::vector<double>& b) {
    // Turning rounds positions of 20 m to 4e-15, gates of 0.05 m and 0.02 rad make of it 1e-12; sums do the
    // rest.
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-9);
}

class TurnedWorlds : public testing::TestWithParam<Consistency> {};

TEST_P(TurnedWorlds, GiveTheSameAnswers) {
    const Answers straight = answersAt(0, GetParam());
    // The scene tells methods apart, and the true pairs are found by those that look at all pairs together.
    const std::vector<int> truth{0, 1, 2, 4, 5, 6, 8, 9, 11, -1, -1, -1};
    EXPECT_EQ(straight.hard[2], truth);
    EXPECT_NE(straight.hard[0], truth);
    EXPECT_GT(straight.exact.states, 20);
    EXPECT_FALSE(straight.in_view.empty());
    EXPECT_FALSE(straight.behind.empty());
    for (int k = 0; k <= 24; ++k) {
        SCOPED_TRACE(k);
        const Answers answers = answersAt(wrapAngle(radians(15.0 * k)), GetParam());
        ASSERT_EQ(answers.candidates.size(), straight.candidates.size());
        for (std::size_t c = 0; c < answers.candidates.size(); ++c) {
            const Candidate &a = answers.candidates[c], &b = straight.candidates[c];
            ASSERT_EQ(a.detection, b.detection);
            ASSERT_EQ(a.object, b.object);
            expectSame({a.nis, a.log_likelihood}, {b.nis, b.log_likelihood});
        }
        EXPECT_EQ(answers.hard, straight.hard);
        for (const auto& [a, b] : {std::make_pair(&answers.exact, &straight.exact),
                                   std::make_pair(&answers.loopy, &straight.loopy)}) {
            expectSame(a->pair, b->pair);
            expectSame(a->none, b->none);
            expectSame(a->missed, b->missed);
        }
        EXPECT_EQ(answers.in_view, straight.in_view);
        EXPECT_EQ(answers.behind, straight.behind);
    }
}

INSTANTIATE_TEST_SUITE_P(Both, TurnedWorlds, testing::Values(Consistency::classic, Consistency::invariant));

}  // namespace turned_worlds_test
}  // namespace slamot
