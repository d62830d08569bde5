#include <gtest/gtest.h>

#include <cmath>

#include "slamot/core/association/ChiSquare.h"

namespace slamot {
namespace chi_square_test {

TEST(ChiSquare, TwoDegreesHaveAClosedForm) {
    for (const double p : {0.01, 0.5, 0.95, 0.99, 0.999999})
        EXPECT_NEAR(chiSquareQuantile(p, 2), -2 * std::log1p(-p), 1e-10) << p;
}

TEST(ChiSquare, TabulatedValues) {
    // To the digits of the usual tables.
    EXPECT_NEAR(chiSquareQuantile(0.95, 1), 3.841, 5e-4);
    EXPECT_NEAR(chiSquareQuantile(0.99, 10), 23.209, 5e-4);
    EXPECT_NEAR(chiSquareQuantile(0.95, 100), 124.342, 5e-4);
}

TEST(ChiSquare, GatesOfPairsHaveTwoDegreesEach) {
    PairGates gates(0.95);
    EXPECT_EQ(gates(0), 0);
    EXPECT_NEAR(gates(5), 18.307, 5e-4);  // asked for out of order
    EXPECT_NEAR(gates(2), 9.488, 5e-4);
    EXPECT_NEAR(gates(1), 5.991, 5e-4);
}

}  // namespace chi_square_test
}  // namespace slamot
