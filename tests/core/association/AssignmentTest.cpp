#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "slamot/core/association/Assignment.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot {
namespace assignment_test {

struct BruteForce {
    int pairs = 0;
    double cost = 0;
};

/// All ways to give the rows distinct columns or none, by permuting columns plus one 'none' per row.
BruteForce bruteForce(const Eigen::MatrixXd& cost) {
    const int rows = static_cast<int>(cost.rows()), columns = static_cast<int>(cost.cols());
    std::vector<int> order(static_cast<std::size_t>(rows + columns));
    std::iota(order.begin(), order.end(), 0);
    BruteForce best;
    do {
        BruteForce now;
        for (int r = 0; r < rows; ++r) {
            const int c = order[static_cast<std::size_t>(r)];
            if (c >= columns || cost(r, c) == forbidden_pair) continue;
            ++now.pairs;
            now.cost += cost(r, c);
        }
        if (now.pairs > best.pairs || (now.pairs == best.pairs && now.cost < best.cost)) best = now;
    } while (std::next_permutation(order.begin(), order.end()));
    return best;
}

TEST(Assignment, AgreesWithBruteForceOnRandomMatrices) {
    RandomStream random(5, RandomPurpose::test);
    for (int trial = 0; trial < 150; ++trial) {
        const int rows = 1 + static_cast<int>(random.uniform(0, 4)),
                  columns = 1 + static_cast<int>(random.uniform(0, 4));
        Eigen::MatrixXd cost(rows, columns);
        for (Eigen::Index i = 0; i < cost.size(); ++i)
            cost.data()[i] = random.uniform() < 0.25 ? forbidden_pair : random.uniform(-3, 8);
        const Assignment found = optimalAssignment(cost);
        const BruteForce best = bruteForce(cost);
        ASSERT_EQ(found.pairs, best.pairs) << cost;
        // Costs are rounded in steps of 11 * 2^-50: four pairs are within 1e-13; sums round to about 1e-14.
        ASSERT_NEAR(found.cost, best.cost, 2e-13) << cost;
        std::vector<int> used;
        for (int r = 0; r < rows; ++r) {
            const int c = found.column_of_row[static_cast<std::size_t>(r)];
            if (c < 0) continue;
            ASSERT_NE(cost(r, c), forbidden_pair);
            used.push_back(c);
        }
        std::sort(used.begin(), used.end());
        ASSERT_TRUE(std::adjacent_find(used.begin(), used.end()) == used.end());
        ASSERT_EQ(static_cast<int>(used.size()), found.pairs);
    }
}

TEST(Assignment, TakesTheTotalNotTheNearest) {
    // Greedy takes (0,0) = 1 and is left with 10: 11. The optimum is 2 + 3 = 5.
    Eigen::MatrixXd cost(2, 2);
    cost << 1, 2, 3, 10;
    const Assignment found = optimalAssignment(cost);
    EXPECT_EQ(found.column_of_row, (std::vector<int>{1, 0}));
    EXPECT_DOUBLE_EQ(found.cost, 5);
}

TEST(Assignment, PairsAreNeverGivenUpForCost) {
    // One pair alone would cost -5; two pairs cost 1 + 1000.
    Eigen::MatrixXd cost(2, 2);
    cost << -5, 1, 1000, forbidden_pair;
    const Assignment found = optimalAssignment(cost);
    EXPECT_EQ(found.pairs, 2);
    EXPECT_EQ(found.column_of_row, (std::vector<int>{1, 0}));
}

TEST(Assignment, LeavesOutRowsWithoutAllowedColumns) {
    Eigen::MatrixXd cost(3, 2);
    cost << forbidden_pair, forbidden_pair, 4, forbidden_pair, 1, forbidden_pair;
    const Assignment found = optimalAssignment(cost);
    EXPECT_EQ(found.column_of_row, (std::vector<int>{-1, -1, 0}));
    EXPECT_DOUBLE_EQ(found.cost, 1);
}

TEST(Assignment, EmptyMatricesAndEqualCosts) {
    EXPECT_EQ(optimalAssignment(Eigen::MatrixXd(0, 3)).pairs, 0);
    EXPECT_EQ(optimalAssignment(Eigen::MatrixXd(2, 0)).column_of_row, (std::vector<int>{-1, -1}));
    EXPECT_EQ(optimalAssignment(Eigen::MatrixXd::Constant(2, 3, 7.0)).pairs, 2);
    EXPECT_EQ(optimalAssignment(Eigen::MatrixXd::Constant(2, 2, forbidden_pair)).pairs, 0);
}

TEST(Assignment, LargeProblemsStayWithinTheIntegers) {
    // cost(i, j) = (i - j)^2 has the identity as its only optimum of cost 0; rows are listed backwards.
    const int n = 150;
    Eigen::MatrixXd cost(n, n);
    for (int r = 0; r < n; ++r)
        for (int c = 0; c < n; ++c) cost(r, c) = (n - 1.0 - r - c) * (n - 1.0 - r - c);
    const Assignment found = optimalAssignment(cost);
    EXPECT_EQ(found.pairs, n);
    EXPECT_DOUBLE_EQ(found.cost, 0);
}

TEST(Assignment, RefusesNan) {
    EXPECT_THROW(optimalAssignment(Eigen::MatrixXd::Constant(1, 1, std::nan(""))), std::invalid_argument);
}

}  // namespace assignment_test
}  // namespace slamot
