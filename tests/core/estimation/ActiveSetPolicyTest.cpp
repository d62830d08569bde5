#include <gtest/gtest.h>

#include "slamot/core/estimation/ActiveSetPolicy.h"

namespace slamot {
namespace active_set_policy_test {

RangeBearingDetection sightOf(ObjectKind kind, double range, int sensor = 0) {
    RangeBearingDetection out;
    out.kind = kind;
    out.range = range;
    out.sensor = sensor;
    return out;
}

/// A sensor that sees a landmark.
RangeBearingSet oneSensor(double range, double field_of_view = 2 * pi, const Pose2& pose = {}) {
    RangeBearingSet set;
    RangeBearingSensor sensor;
    sensor.max_range = range;
    sensor.field_of_view = field_of_view;
    sensor.pose = pose;
    set.sensors.push_back(sensor);
    set.detections.push_back(sightOf(ObjectKind::landmark, 1));
    return set;
}

const std::vector<BlockId> nothing;

TEST(ActiveSetPolicyTest, MarginsCountInRanges) {
    ActiveSetParameters parameters;
    parameters.activate_margin = 0.5;
    parameters.keep_margin = 0.75;
    ActiveSetPolicy policy(parameters);
    const RangeBearingSet set = oneSensor(20, 2 * pi, {1, 0, 0});  // at (11, 5)
    policy.look({{10, 5, 0}, set, nothing});
    EXPECT_TRUE(policy.toActivate({11 + 29.9, 5}));
    EXPECT_FALSE(policy.toActivate({11 + 30.1, 5}));
    EXPECT_TRUE(policy.toKeep({11, 5 - 34.9}));
    EXPECT_FALSE(policy.toKeep({11, 5 - 35.1}));
}

TEST(ActiveSetPolicyTest, FieldsOfViewHaveTheirMargin) {
    ActiveSetParameters parameters;
    parameters.view_margin = 0.5;
    parameters.activate_margin = 0.2;
    ActiveSetPolicy policy(parameters);
    const RangeBearingSet set = oneSensor(10, 1.0, {0, 0, pi / 2});  // looks to the left: north
    policy.look({{0, 0, 0}, set, nothing});
    const auto at = [](double distance, double aside) {
        return Vector2(distance * std::cos(pi / 2 + aside), distance * std::sin(pi / 2 + aside));
    };
    EXPECT_TRUE(policy.toActivate(at(9, 0.99)));
    EXPECT_FALSE(policy.toActivate(at(9, 1.01)));
    EXPECT_TRUE(policy.toKeep(at(9, -1.49)));
    EXPECT_FALSE(policy.toKeep(at(9, -1.51)));
    EXPECT_TRUE(policy.toActivate(at(1.9, pi))) << "beside the sensor any side will do";
    EXPECT_FALSE(policy.toActivate(at(2.1, pi)));
}

TEST(ActiveSetPolicyTest, DueWhenAboutHalfAMarginIsUsedUp) {
    ActiveSetParameters parameters;
    parameters.activate_margin = 1;  // 20 m
    parameters.view_margin = 1;
    ActiveSetPolicy policy(parameters);
    const RangeBearingSet set = oneSensor(20, 1.0);
    policy.look({{0, 0, 0}, set, nothing});
    EXPECT_TRUE(policy.due());
    policy.refreshed();
    EXPECT_FALSE(policy.due());
    policy.look({{8.9, 0, 0.44}, set, nothing});
    EXPECT_FALSE(policy.due());
    policy.look({{9.1, 0, 0}, set, nothing});
    EXPECT_TRUE(policy.due());
    policy.refreshed();
    policy.look({{9.1, 0, -0.46}, set, nothing});
    EXPECT_TRUE(policy.due());
}

TEST(ActiveSetPolicyTest, APlanHoldsForTheOtherHalf) {
    ActiveSetParameters parameters;
    parameters.activate_margin = 1;  // 20 m
    parameters.view_margin = 1;
    ActiveSetPolicy policy(parameters);
    RangeBearingSet set = oneSensor(20, 1.0);
    policy.look({{0, 0, 0}, set, nothing});
    EXPECT_FALSE(policy.planHolds()) << "there is none";
    policy.planned();
    EXPECT_TRUE(policy.planHolds());
    EXPECT_TRUE(policy.due()) << "which is another matter";
    policy.look({{0, 10.9, -0.54}, set, nothing});
    EXPECT_TRUE(policy.planHolds());
    policy.look({{0, 11.1, 0}, set, nothing});
    EXPECT_FALSE(policy.planHolds());
    policy.look({{0, 0, 0.56}, set, nothing});
    EXPECT_FALSE(policy.planHolds());
    policy.look({{0, 0, 0}, set, nothing});
    EXPECT_TRUE(policy.planHolds());
    set.sensors.front().max_range = 25;
    policy.look({{0, 0, 0}, set, nothing});
    EXPECT_FALSE(policy.planHolds()) << "there is more within reach than was thought";
}

TEST(ActiveSetPolicyTest, WithoutALimitTheLongestRangeOfALandmarkCounts) {
    ActiveSetPolicy policy({});
    RangeBearingSet set = oneSensor(0);
    set.detections = {sightOf(ObjectKind::landmark, 8), sightOf(ObjectKind::landmark, 5),
                      sightOf(ObjectKind::mover, 40), sightOf(ObjectKind::unknown, 50)};
    policy.look({{}, set, nothing});
    EXPECT_EQ(policy.range(), 8);
    policy.refreshed();
    EXPECT_FALSE(policy.due());
    set.detections[1].range = 12;
    policy.look({{}, set, nothing});
    EXPECT_EQ(policy.range(), 12);
    EXPECT_TRUE(policy.due()) << "there is more within reach than was thought";
    // A limit given by hand stands above what is met.
    ActiveSetParameters parameters;
    parameters.range = 3;
    ActiveSetPolicy fixed(parameters);
    fixed.look({{}, set, nothing});
    EXPECT_EQ(fixed.range(), 3);
}

TEST(ActiveSetPolicyTest, ASensorThatSeesMoversOnlyDoesNotCount) {
    // A scanner that sees landmarks to 20 m, and a radar behind it that sees movers to 200 m.
    for (const std::optional<double>& by_hand : {std::optional<double>(), std::optional<double>(20.0)}) {
        ActiveSetParameters parameters;
        parameters.range = by_hand;
        parameters.activate_margin = 0.5;
        ActiveSetPolicy policy(parameters);
        RangeBearingSet set = oneSensor(20);
        set.sensors.push_back({"radar", {-5, 0, 0}, 0, 200, 2 * pi});
        set.detections = {sightOf(ObjectKind::mover, 150, 1)};
        policy.look({{}, set, nothing});
        EXPECT_EQ(policy.range(), 0) << "no landmark yet";
        EXPECT_FALSE(policy.due());
        EXPECT_FALSE(policy.toActivate({0, 0}));
        EXPECT_FALSE(policy.toKeep({0, 0}));
        set.detections.push_back(sightOf(ObjectKind::landmark, 15, 0));
        policy.look({{}, set, nothing});
        EXPECT_EQ(policy.range(), 20);
        EXPECT_TRUE(policy.due());
        EXPECT_TRUE(policy.toActivate({29.9, 0}));
        EXPECT_FALSE(policy.toActivate({30.1, 0}));
        EXPECT_FALSE(policy.toActivate({-30.1, 0})) << "within reach of the radar only";
        EXPECT_FALSE(policy.toKeep({-30.1, 0}));
        // It has seen a landmark after all.
        set.detections.push_back(sightOf(ObjectKind::landmark, 15, 1));
        policy.look({{}, set, nothing});
        EXPECT_EQ(policy.range(), by_hand.value_or(200));
        EXPECT_TRUE(policy.toActivate({-5 - 1.49 * policy.range(), 0}));
    }
}

TEST(ActiveSetPolicyTest, CommitsWhenThereIsMuchToGain) {
    ActiveSetParameters parameters;
    parameters.base_growth = 3;
    parameters.retirable_part = 0.25;
    parameters.keep_at_least = 50;
    const ActiveSetPolicy policy(parameters);
    EXPECT_TRUE(policy.worthCommit(100, 40, 0, 301));
    EXPECT_FALSE(policy.worthCommit(100, 40, 0, 300));
    // A map that is divided already.
    EXPECT_TRUE(policy.worthCommit(200, 80, 20, 250));
    EXPECT_FALSE(policy.worthCommit(200, 80, 19, 250));
    EXPECT_FALSE(policy.worthCommit(120, 50, 49, 250)) << "few are kept in any case";
    EXPECT_FALSE(policy.worthCommit(100, 60, 0, 250));
    // One that is whole: more than four times what is kept.
    EXPECT_TRUE(policy.worthCommit(180, 90, 68, 0));
    EXPECT_FALSE(policy.worthCommit(180, 90, 67, 0));
    EXPECT_FALSE(policy.worthCommit(240, 90, 68, 0)) << "movers stay and count";
}

}  // namespace active_set_policy_test
}  // namespace slamot
