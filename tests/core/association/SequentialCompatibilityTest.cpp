#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "AssociationProblems.h"
#include "slamot/core/association/SequentialCompatibility.h"

namespace slamot {
namespace sequential_compatibility_test {

using testing::ElementsAre;

/// First rows share an error of variance 4, as under an unknown position along x; each has `own` beside it.
/// Second rows are zero with variance 1.
test::MatrixInnovations alongX(const std::vector<double>& residuals, double own = 0.01) {
    const auto n = static_cast<Eigen::Index>(residuals.size());
    test::MatrixInnovations out;
    out.nu = Eigen::VectorXd::Zero(2 * n);
    out.S = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
        out.nu(2 * i) = residuals[static_cast<std::size_t>(i)];
        out.S(2 * i + 1, 2 * i + 1) = 1;
        for (Eigen::Index j = 0; j < n; ++j) out.S(2 * i, 2 * j) = 4 + (i == j ? own : 0);
    }
    return out;
}

TEST(SequentialCompatibility, TheCertainPairTellsWhichOfTwoIsMeant) {
    // The robot is 1 m off. Detection 1 has one candidate, at residual 1. Detection 0 is nearest to object 0
    // at residual 0, but object 1, at 0.95, is off by the same error. Alone 0 is likelier, jointly 1.
    const AssociationProblem problem(2, 3,
                                     {{0, 0, 0, -1.5}, {0, 1, 0.9025 / 4.01, -1.7}, {1, 2, 1 / 4.01, -1.8}});
    test::MatrixInnovations innovations = alongX({0, 0.95, 1});
    PairGates gates(0.99);
    EXPECT_THAT(sequentialCompatibility(problem, innovations, gates).objects(problem), ElementsAre(1, 2));
}

TEST(SequentialCompatibility, TakesTheLikeliestGivenThoseBeforeNotTheLikeliestAlone) {
    // As above with 0.2 of their own: given a residual of 1, the next is expected at 4 / 4.2 = 0.95 with
    // variance 4.2 - 16 / 4.2 = 0.39. Both of its candidates are compatible; the one at 0.95 is likelier,
    // alone the one at 0.
    const AssociationProblem problem(2, 3,
                                     {{0, 0, 0, -1.5}, {0, 1, 0.9025 / 4.2, -1.7}, {1, 2, 1 / 4.2, -1.8}});
    test::MatrixInnovations innovations = alongX({0, 0.95, 1}, 0.2);
    PairGates gates(0.99);
    EXPECT_LT(innovations.nis({2, 0}), gates(2));
    EXPECT_THAT(sequentialCompatibility(problem, innovations, gates).objects(problem), ElementsAre(1, 2));
}

TEST(SequentialCompatibility, LeavesOutWhatDoesNotFitThoseBefore) {
    // Alone each is within its gate of 9.21; together with residuals of 1 and -1 the joint NIS is about
    // (2^2 / 2) / 0.01 = 200, above 13.28.
    const AssociationProblem problem(2, 2, {{0, 0, 1 / 4.01, -1.8}, {1, 1, 1 / 4.01, -1.9}});
    test::MatrixInnovations innovations = alongX({1, -1});
    PairGates gates(0.99);
    EXPECT_THAT(sequentialCompatibility(problem, innovations, gates).objects(problem), ElementsAre(0, -1));
}

TEST(SequentialCompatibility, AnObjectIsTakenOnce) {
    const AssociationProblem problem(2, 1, {{0, 0, 0.2, -2}, {1, 0, 0.1, -1}});
    test::MatrixInnovations innovations = alongX({0.1, 0.1});
    PairGates gates(0.99);
    EXPECT_THAT(sequentialCompatibility(problem, innovations, gates).objects(problem), ElementsAre(-1, 0));
}

TEST(InnovationFactor, GrowsAndShrinksLikeTheWhole) {
    RandomStream random(3, RandomPurpose::test);
    test::MatrixInnovations innovations = test::randomInnovations(random, 8, 2);
    InnovationFactor factor(innovations, 8);
    // log N of the last given the others: the difference of two joint densities, determinants by LU.
    const auto logDensity = [&innovations](const std::vector<int>& list) -> double {
        if (list.empty()) return 0;
        const auto n = static_cast<Eigen::Index>(list.size());
        Eigen::MatrixXd S(2 * n, 2 * n);
        for (Eigen::Index i = 0; i < n; ++i)
            for (Eigen::Index j = 0; j < n; ++j)
                S.block<2, 2>(2 * i, 2 * j) = innovations.covariance(list[static_cast<std::size_t>(i)],
                                                                     list[static_cast<std::size_t>(j)]);
        return -0.5 * (innovations.nis(list) + std::log(S.determinant())) -
               std::log(2 * pi) * static_cast<double>(n);
    };
    for (const int c : {5, 2, 7, 0}) {
        const double before = logDensity(factor.candidates());
        ASSERT_TRUE(factor.push(c));
        // Condition numbers are below 1e3 here: twelve digits are left.
        EXPECT_NEAR(factor.nis(), innovations.nis(factor.candidates()), 1e-10);
        EXPECT_NEAR(factor.logConditional(), logDensity(factor.candidates()) - before, 1e-10);
    }
    const double three = innovations.nis({5, 2, 7});
    factor.pop();
    EXPECT_NEAR(factor.nis(), three, 1e-10);
    ASSERT_TRUE(factor.push(6));
    EXPECT_NEAR(factor.nis(), innovations.nis({5, 2, 7, 6}), 1e-10);
    EXPECT_THAT(factor.candidates(), ElementsAre(5, 2, 7, 6));
}

TEST(InnovationFactor, RefusesWhatIsNotPositiveDefinite) {
    test::MatrixInnovations innovations = alongX({1, 1});
    innovations.S(0, 0) = innovations.S(2, 2) = 4;  // no noise of their own: the second says nothing new
    InnovationFactor factor(innovations, 2);
    ASSERT_TRUE(factor.push(0));
    const double nis = factor.nis();
    EXPECT_FALSE(factor.push(1));
    EXPECT_EQ(factor.pairs(), 1);
    EXPECT_EQ(factor.nis(), nis);
}

}  // namespace sequential_compatibility_test
}  // namespace slamot
