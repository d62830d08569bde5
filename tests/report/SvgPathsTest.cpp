#include <gtest/gtest.h>

#include "SvgPaths.h"

namespace slamot::report {
namespace svg_paths_test {

TEST(SvgPaths, roundsPathsToHundredthsAndNothingElse) {
    EXPECT_EQ(roundPathCoordinates(
                  R"(<path d="M1.23456,-0.5L2e-17,10.999A2.5,3"/><text x="1.23456">0.12345</text>)"),
              R"(<path d="M1.23,-0.5L0,11A2.5,3"/><text x="1.23456">0.12345</text>)");
}

}  // namespace svg_paths_test
}  // namespace slamot::report
