#include <gtest/gtest.h>

#include <cmath>

#include "slamot/eval/ErrorSummary.h"

namespace slamot::eval {
namespace error_summary_test {

TEST(ErrorSummary, ByHand) {
    // |e| = 3, 4, 0, 1: rmse sqrt((9 + 16 + 0 + 1) / 4) = sqrt(6.5), mean 2, median (1 + 3) / 2 = 2.
    const ErrorSummary s = summariseErrors({-3, 4, std::nan(""), 0, -1});
    EXPECT_EQ(s.count, 4);
    EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(6.5));
    EXPECT_DOUBLE_EQ(s.mean, 2);
    EXPECT_DOUBLE_EQ(s.median, 2);
    EXPECT_DOUBLE_EQ(s.maximum, 4);
    EXPECT_DOUBLE_EQ(s.final, 1);
    // Of an odd number the middle one: 0, 2, 7.
    EXPECT_DOUBLE_EQ(summariseErrors({7, 0, 2}).median, 2);
}

TEST(ErrorSummary, NothingIsNotZero) {
    const ErrorSummary s = summariseErrors({std::nan("")});
    EXPECT_EQ(s.count, 0);
    EXPECT_TRUE(std::isnan(s.rmse));
    EXPECT_TRUE(std::isnan(s.final));
}

}  // namespace error_summary_test
}  // namespace slamot::eval
