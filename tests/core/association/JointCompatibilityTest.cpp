#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "AssociationProblems.h"
#include "slamot/core/association/JointCompatibility.h"
#include "slamot/core/association/SequentialCompatibility.h"

namespace slamot {
namespace joint_compatibility_test {

constexpr int unlimited = std::numeric_limits<int>::max();

struct BruteForce {
    int pairs = 0;
    double nis = 0;
};

/// Of all pairings that are compatible after each decision, the one with the most pairs, then the smallest
/// NIS.
BruteForce bruteForce(const AssociationProblem& problem, const test::MatrixInnovations& innovations,
                      PairGates& gates) {
    BruteForce best;
    test::forEachPairing(problem, problem.unambiguousFirst(), [&](const std::vector<int>& candidates) {
        double nis = 0;
        for (std::size_t n = 1; n <= candidates.size(); ++n) {
            nis = innovations.nis({candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(n)});
            if (nis > gates(static_cast<int>(n))) return;
        }
        const int pairs = static_cast<int>(candidates.size());
        if (pairs > best.pairs || (pairs == best.pairs && nis < best.nis)) best = {pairs, nis};
    });
    return best;
}

std::vector<int> chosen(const AssociationProblem& problem, const Pairing& pairing) {
    std::vector<int> out;
    for (const int d : problem.unambiguousFirst())
        if (pairing.of(d) >= 0) out.push_back(pairing.of(d));
    return out;
}

TEST(JointCompatibility, AgreesWithBruteForceOnRandomProblems) {
    RandomStream random(11, RandomPurpose::test);
    int better_than_sequential = 0, incompatible = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const AssociationProblem problem = test::randomProblem(random, 1 + trial % 5, 1 + trial % 4, 0.6);
        test::MatrixInnovations innovations = test::randomInnovations(random, problem.candidates(), 1.5);
        PairGates gates(0.9);
        const BruteForce best = bruteForce(problem, innovations, gates);
        const JointCompatibility found = jointCompatibility(problem, innovations, gates, unlimited);
        ASSERT_EQ(found.pairing.pairs(), best.pairs) << trial;
        // Both factor matrices of up to 10 rows and a condition number below 1e3.
        ASSERT_NEAR(found.nis, best.nis, 1e-9) << trial;
        ASSERT_NEAR(innovations.nis(chosen(problem, found.pairing)), found.nis, 1e-9) << trial;
        ASSERT_FALSE(found.exhausted);
        better_than_sequential += !found.is_sequential;
        incompatible += best.pairs < problem.detections();
    }
    // The problems are of the kind that tells methods apart.
    EXPECT_GT(better_than_sequential, 30);
    EXPECT_GT(incompatible, 30);
}

TEST(JointCompatibility, TakesBackAGreedyChoice) {
    // Three objects on a line and a robot whose position along it is unknown by 2 m. Detection 0 lies between
    // two candidates and is likelier to be object 0 alone (residual 0.4, not -0.6), but 1 and 2, which have
    // two candidates as well and come later, only fit object 1's error of -0.6.
    const std::vector<double> residuals{0.4, -0.6, 1.4, -0.6, 1.4, -0.6};
    test::MatrixInnovations innovations;
    innovations.nu = Eigen::VectorXd::Zero(12);
    innovations.S = Eigen::MatrixXd::Zero(12, 12);
    for (int i = 0; i < 6; ++i) {
        innovations.nu(2 * i) = residuals[static_cast<std::size_t>(i)];
        innovations.S(2 * i + 1, 2 * i + 1) = 1;
        for (int j = 0; j < 6; ++j) innovations.S(2 * i, 2 * j) = 4 + (i == j ? 0.01 : 0);
    }
    std::vector<Candidate> candidates;
    for (int c = 0; c < 6; ++c) {
        const double nis = innovations.nis({c});
        const int d = c / 2;
        candidates.push_back({d, c, nis, -0.5 * nis - 0.1 * d});
    }
    const AssociationProblem problem(3, 6, candidates);
    PairGates gates(0.99);
    EXPECT_THAT(sequentialCompatibility(problem, innovations, gates).objects(problem),
                testing::ElementsAre(0, -1, -1));
    const JointCompatibility found = jointCompatibility(problem, innovations, gates, unlimited);
    EXPECT_THAT(found.pairing.objects(problem), testing::ElementsAre(1, 3, 5));
    EXPECT_FALSE(found.is_sequential);
}

TEST(JointCompatibility, WithoutBudgetItIsTheSequentialPairing) {
    RandomStream random(12, RandomPurpose::test);
    for (int trial = 0; trial < 50; ++trial) {
        const AssociationProblem problem = test::randomProblem(random, 5, 4, 0.7);
        test::MatrixInnovations innovations = test::randomInnovations(random, problem.candidates(), 1.5);
        PairGates gates(0.9);
        const JointCompatibility found = jointCompatibility(problem, innovations, gates, 0);
        const Pairing sequential = sequentialCompatibility(problem, innovations, gates);
        ASSERT_EQ(found.pairing.candidate_of_detection, sequential.candidate_of_detection);
        ASSERT_EQ(found.nodes, 0);
        ASSERT_TRUE(found.is_sequential);
        ASSERT_NEAR(found.nis, innovations.nis(chosen(problem, sequential)), 1e-9);
    }
}

TEST(JointCompatibility, MoreNodesNeverMakeItWorse) {
    RandomStream random(13, RandomPurpose::test);
    for (int trial = 0; trial < 50; ++trial) {
        const AssociationProblem problem = test::randomProblem(random, 6, 6, 0.8);
        test::MatrixInnovations innovations = test::randomInnovations(random, problem.candidates(), 1.5);
        PairGates gates(0.95);
        const JointCompatibility best = jointCompatibility(problem, innovations, gates, unlimited);
        int pairs = 0;
        double nis = std::numeric_limits<double>::infinity();
        for (const int budget : {1, 3, 10, 30, 100, 300, 1000}) {
            const JointCompatibility found = jointCompatibility(problem, innovations, gates, budget);
            ASSERT_LE(found.nodes, budget);
            ASSERT_EQ(found.exhausted, budget < best.nodes);
            const int now = found.pairing.pairs();
            ASSERT_TRUE(now > pairs || (now == pairs && found.nis <= nis)) << trial << " " << budget;
            pairs = now;
            nis = found.nis;
        }
        ASSERT_LE(pairs, best.pairing.pairs());
    }
}

TEST(JointCompatibility, NothingToPair) {
    test::MatrixInnovations innovations;
    PairGates gates(0.95);
    const JointCompatibility found = jointCompatibility({3, 2, {}}, innovations, gates, unlimited);
    EXPECT_EQ(found.pairing.pairs(), 0);
    EXPECT_EQ(found.nis, 0);
    EXPECT_EQ(found.nodes, 0);
}

}  // namespace joint_compatibility_test
}  // namespace slamot
