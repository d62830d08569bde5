#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "slamot/core/association/DetectionModel.h"
#include "support/Expect.h"

namespace slamot {
namespace detection_model_test {

using testing::HasSubstr;

TEST(DetectionModel, ClutterIsUniformInRangeAndBearing) {
    RangeBearingSensor sensor;
    sensor.min_range = 2;
    sensor.max_range = 22;
    sensor.field_of_view = 0.5;
    EXPECT_DOUBLE_EQ(clutterDensity(5, sensor), 5 / (20 * 0.5));
    sensor.max_range = 0;
    sensor.min_range = 0;
    sensor.label = "radar";
    EXPECT_THAT(test::messageOf<std::invalid_argument>([&] { clutterDensity(5, sensor); }),
                HasSubstr("radar"));
}

TEST(DetectionModel, RatioOfAPairByHand) {
    // 0.9 * 3 / (0.2 * (1 - 0.9 * 0.99)) = 2.7 / 0.0218
    const AssociationProblem problem(1, 1, {{0, 0, 1, std::log(3.0)}});
    const std::vector<double> ratios = logPairRatios(problem, {{0.9}, {0.2}, 0.99});
    EXPECT_NEAR(ratios[0], std::log(2.7 / 0.0218), 1e-12);
}

TEST(DetectionModel, RefusesWhatNeverLetsGo) {
    const AssociationProblem problem(1, 1, {{0, 0, 1, 0}});
    const auto message = [&problem](const DetectionModel& model) {
        return test::messageOf<std::invalid_argument>([&] { logPairRatios(problem, model); });
    };
    EXPECT_THAT(message({{1.0}, {0.1}, 1}), HasSubstr("detection probability 1"));
    EXPECT_THAT(message({{-0.1}, {0.1}, 1}), HasSubstr("detection probability -0.1"));
    EXPECT_THAT(message({{0.9}, {0.0}, 1}), HasSubstr("clutter density 0"));
    EXPECT_THAT(message({{0.9, 0.9}, {0.1}, 1}), HasSubstr("expected 1 and 1"));
    EXPECT_NO_THROW(logPairRatios(problem, {{1.0}, {0.1}, 0.99}));
    EXPECT_EQ(logPairRatios(problem, {{0.0}, {0.1}, 1})[0], -std::numeric_limits<double>::infinity());
}

}  // namespace detection_model_test
}  // namespace slamot
