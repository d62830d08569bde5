#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "slamot/report/Decimation.h"

namespace slamot::report {
namespace decimation_test {

using ::testing::ElementsAre;

TEST(Decimation, columnsKeepFirstLowestHighestAndLast) {
    // Pixel column 0 holds five points, column 1 one, column 2 two.
    const Points2 pixels = {{0.0, 5}, {0.2, 9}, {0.4, 6}, {0.6, 1}, {0.8, 4}, {1.5, 3}, {2.1, 7}, {2.2, 8}};
    EXPECT_THAT(keepColumnExtremes(pixels), ElementsAre(0, 1, 3, 4, 5, 6, 7));  // only 2 (y 6) adds nothing
}

TEST(Decimation, oneSpikeAmongManySamplesSurvives) {
    Points2 pixels;
    for (int i = 0; i < 100000; ++i) {
        pixels.emplace_back(i * 0.005, i == 61234 ? 1000.0 : std::sin(i * 0.1));
    }
    const std::vector<std::size_t> kept = keepColumnExtremes(pixels);
    EXPECT_LE(kept.size(), 4 * 500u);  // 100000 * 0.005 = 500 columns, four points each at most
    EXPECT_TRUE(std::find(kept.begin(), kept.end(), 61234u) != kept.end());
}

TEST(Decimation, pathKeepsCornersWithinTolerance) {
    // The second point is 0.05 off the straight line, the third is a corner.
    const Points2 pixels = {{0, 0}, {5, 0.05}, {10, 0}, {10, 10}};
    EXPECT_THAT(simplifyPath(pixels, 0.1), ElementsAre(0, 2, 3));
    EXPECT_THAT(simplifyPath(pixels, 0.01), ElementsAre(0, 1, 2, 3));
}

TEST(Decimation, oneMarkPerPixel) {
    EXPECT_THAT(keepOnePerPixel({{0.1, 0.1}, {0.9, 0.9}, {1.1, 0.1}, {-0.1, 0.1}}), ElementsAre(0, 2, 3));
}

}  // namespace decimation_test
}  // namespace slamot::report
