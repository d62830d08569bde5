#include <algorithm>

#include "slamot/core/particles/PhdTerms.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace phd_terms_test {

PhdTerm term(int sight, double weight, double x, double variance = 1) {
    return {0, sight, weight, {{x, 0}, variance * Matrix2::Identity()}};
}

// 0.6 at 0 and 0.3 at 1.5, variance 1 each: 1.5^2 <= 4. Mean 0.5, variance 1 + (0.6 0.5^2 + 0.3 1^2) / 0.9
// = 1.5. What lies 2.5 from the heaviest stays alone, though it is near the lighter one.
TEST(PhdTermsTest, WhatLiesNearTheHeaviestJoinsIt) {
    PhdGroups out;
    mergeTerms({term(-1, 0.3, 1.5), term(2, 0.6, 0), term(-1, 0.1, 2.5), term(-1, 9e-4, 0)}, 1e-3, 4, out);
    ASSERT_EQ(out.groups.size(), 2u);
    EXPECT_EQ(out.order, (std::vector<int>{1, 0, 2}));
    EXPECT_EQ(out.groups[0].first, 0);
    EXPECT_EQ(out.groups[0].last, 2);
    EXPECT_NEAR(out.groups[0].weight, 0.9, 1e-15);
    EXPECT_NEAR(out.groups[0].detected, 0.6, 1e-15);
    EXPECT_TRUE(test::near(out.groups[0].point.mean, Vector2(0.5, 0), 1e-15));
    EXPECT_TRUE(test::near(out.groups[0].point.covariance, Matrix2(Vector2(1.5, 1).asDiagonal()), 1e-15));
    EXPECT_EQ(out.groups[1].weight, 0.1);
    EXPECT_EQ(out.groups[1].detected, 0);
    EXPECT_EQ(out.groups[1].point.mean, Vector2(2.5, 0));
}

// Eq. 30 has the covariance of the term that may join.
TEST(PhdTermsTest, TheLighterOnesCovarianceDecides) {
    PhdGroups out;
    mergeTerms({term(-1, 0.6, 0, 0.01), term(-1, 0.3, 1, 100)}, 1e-3, 4, out);
    EXPECT_EQ(out.groups.size(), 1u);
    mergeTerms({term(-1, 0.6, 0, 100), term(-1, 0.3, 1, 0.01)}, 1e-3, 4, out);
    EXPECT_EQ(out.groups.size(), 2u);
    mergeTerms({}, 1e-3, 4, out);
    EXPECT_TRUE(out.groups.empty());
}

TEST(PhdTermsTest, EveryTermIsInOneGroupAndMomentsAreKept) {
    PhdGroups out;
    for (std::uint32_t k = 0; k < 50; ++k) {
        RandomStream random(11, RandomPurpose::test, 0, k);
        std::vector<PhdTerm> terms;
        double weight = 0;
        Vector2 first = Vector2::Zero();
        Matrix2 second = Matrix2::Zero();
        for (int i = 0; i < 30; ++i) {
            const GaussianPoint point{{random.uniform(-3, 3), random.uniform(-3, 3)},
                                      test::randomCovariance(random, 2, 0.3)};
            terms.push_back({i, i % 3 - 1, random.uniform(0, 1), point});
            if (terms.back().weight < 0.1) continue;
            weight += terms.back().weight;
            first += terms.back().weight * point.mean;
            second += terms.back().weight * (point.covariance + point.mean * point.mean.transpose());
        }
        mergeTerms(terms, 0.1, 4, out);
        double left = 2;
        std::vector<int> met;
        int next = 0;
        for (const PhdGroup& group : out.groups) {
            EXPECT_EQ(group.first, next);
            next = group.last;
            double before = terms[static_cast<std::size_t>(out.order[group.first])].weight;
            EXPECT_LE(before, left);
            left = before;
            for (int m = group.first; m < group.last; ++m) {
                met.push_back(out.order[m]);
                EXPECT_LE(terms[static_cast<std::size_t>(out.order[m])].weight, before);
                before = terms[static_cast<std::size_t>(out.order[m])].weight;
            }
            weight -= group.weight;
            first -= group.weight * group.point.mean;
            second -=
                group.weight * (group.point.covariance + group.point.mean * group.point.mean.transpose());
        }
        EXPECT_EQ(next, static_cast<int>(out.order.size()));
        std::sort(met.begin(), met.end());
        EXPECT_EQ(std::adjacent_find(met.begin(), met.end()), met.end());
        EXPECT_NEAR(weight, 0, 1e-12);
        EXPECT_TRUE(test::near(first, Vector2(0, 0), 1e-12));
        EXPECT_TRUE(test::near(second, Matrix2(Matrix2::Zero()), 1e-12));
    }
}

TEST(PhdTermsTest, DensityOfAGaussian) {
    const GaussianPoint point{{1, 2}, Vector2(0.25, 4).asDiagonal()};
    EXPECT_NEAR(densityAt({1, 2}, point), 1 / (2 * pi * 0.5 * 2), 1e-15);
    EXPECT_NEAR(densityAt({1.5, 0}, point), std::exp(-1.0) / (2 * pi), 1e-15);
}

}  // namespace phd_terms_test
}  // namespace slamot
