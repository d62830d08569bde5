#include <gtest/gtest.h>

#include "slamot/core/filter/SensorLimits.h"

namespace slamot {
namespace sensor_limits_test {

RangeBearingSet twoSensors(const std::vector<std::pair<int, double>>& ranges) {
    RangeBearingSet set;
    set.sensors.resize(3);
    set.sensors[0].label = "near";
    set.sensors[1].label = "far";
    set.sensors[2].label = "stated";
    set.sensors[2].max_range = 12;
    for (const auto& [sensor, range] : ranges) {
        set.detections.emplace_back();
        set.detections.back().sensor = sensor;
        set.detections.back().range = range;
    }
    return set;
}

std::vector<double> limitsOf(const RangeBearingSet& set) {
    std::vector<double> out;
    for (const RangeBearingSensor& sensor : set.sensors) out.push_back(sensor.max_range);
    return out;
}

TEST(SensorLimitsTest, WhatASensorHasDetectedIsHowFarItSees) {
    SensorLimits limits;
    EXPECT_EQ(limitsOf(limits.completed(twoSensors({}))), (std::vector<double>{0, 0, 12}));
    EXPECT_EQ(limitsOf(limits.completed(twoSensors({{0, 3}, {0, 5}, {0, 4}, {2, 30}}))),
              (std::vector<double>{5, 0, 12}));
    EXPECT_EQ(limitsOf(limits.completed(twoSensors({{1, 40}, {0, 2}}))), (std::vector<double>{5, 40, 12}))
        << "by label, the longest so far; a stated limit stays";
    const RangeBearingSet same = twoSensors({{1, 7}, {2, 1}});
    EXPECT_EQ(limits.completed(same).detections.size(), same.detections.size());
    limits.clear();
    EXPECT_EQ(limitsOf(limits.completed(twoSensors({{1, 7}}))), (std::vector<double>{0, 7, 12}));
}

TEST(SensorLimitsTest, TheOrderOfSensorsInASetIsNoMatter) {
    SensorLimits limits;
    limits.completed(twoSensors({{0, 3}, {1, 40}}));
    RangeBearingSet swapped = twoSensors({});
    std::swap(swapped.sensors[0], swapped.sensors[1]);
    EXPECT_EQ(limitsOf(limits.completed(swapped)), (std::vector<double>{40, 3, 12}));
}

}  // namespace sensor_limits_test
}  // namespace slamot
