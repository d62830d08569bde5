#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "slamot/core/objects/Existence.h"

namespace slamot {
namespace existence_test {

using testing::ElementsAre;

/// A few products and sums of numbers up to 1.
constexpr double rounding = 1e-14;

LifeParameters firstSights(double new_per_scan, double clutter_per_scan) {
    LifeParameters p;
    p.new_per_scan = new_per_scan;
    p.clutter_per_scan = clutter_per_scan;
    return p;
}

TEST(ExistenceTest, FirstSightIsNewRatherThanClutter) {
    EXPECT_DOUBLE_EQ(Existence(firstSights(0.1, 1)).probability(), 1.0 / 11);
    EXPECT_DOUBLE_EQ(Existence(firstSights(0.1, 1)).visibility(), 1.0 / 11);
    EXPECT_EQ(Existence(firstSights(0, 1)).probability(), 0);
    for (const double new_per_scan : {0.0, 0.1}) {
        const LifeParameters no_clutter = firstSights(new_per_scan, 0);
        EXPECT_EQ(Existence(no_clutter).probability(), 1);
        EXPECT_TRUE(Existence(no_clutter).confirmed(no_clutter));
    }
}

TEST(ExistenceTest, DetectionsAndMissesByHand) {
    // 1 : 4; a detection ten times as likely of the object: 10 : 4; missed at P_D 0.9: 1 : 4.
    Existence existence(firstSights(1, 4));
    existence.detected(10);
    EXPECT_NEAR(existence.probability(), 10.0 / 14, rounding);
    existence.missed(0.9);
    EXPECT_NEAR(existence.probability(), 1.0 / 5, rounding);
}

TEST(ExistenceTest, AMissSaysNothingOfWhatIsHidden) {
    // Rates of 1 per second both ways: of the visible a quarter is hidden after ln(2)/2 s.
    LifeParameters p = firstSights(4, 1);
    p.hidden_every = p.hidden_for = 1;
    Existence existence(p);
    existence.pass(0.5 * std::log(2.0), p);
    EXPECT_NEAR(existence.visibility(), 0.6, rounding);
    EXPECT_NEAR(existence.probability(), 0.8, rounding);
    // 0.6 visible, 0.2 hidden, 0.2 absent; missed at 0.5: 3 : 2 : 2.
    existence.missed(0.5);
    EXPECT_NEAR(existence.visibility(), 3.0 / 7, rounding);
    EXPECT_NEAR(existence.probability(), 5.0 / 7, rounding);
    // Detected with ratio 2: 6 : 2 : 2.
    existence.detected(2);
    EXPECT_NEAR(existence.visibility(), 0.6, rounding);
    EXPECT_NEAR(existence.probability(), 0.8, rounding);
}

TEST(ExistenceTest, PassingTimeKeepsWhatExistsAndCanBeCutAtWill) {
    const LifeParameters p;
    Existence whole(p), pieces(p);
    whole.pass(3, p);
    for (int i = 0; i < 1000; ++i) pieces.pass(0.003, p);
    // A thousand roundings.
    EXPECT_NEAR(pieces.visibility(), whole.visibility(), 1e-13);
    EXPECT_NEAR(pieces.probability(), 1.0 / 11, 1e-13);
    EXPECT_LT(whole.visibility(), 0.95 * whole.probability());
    whole.pass(1e6, p);
    EXPECT_NEAR(whole.visibility() / whole.probability(), 20.0 / 22, rounding);
}

TEST(ExistenceTest, WhatNothingHidesStaysVisible) {
    LifeParameters p;
    p.hidden_every = std::numeric_limits<double>::infinity();
    Existence existence(p);
    existence.pass(100, p);
    EXPECT_EQ(existence.visibility(), 1.0 / 11);
    EXPECT_EQ(existence.probability(), 1.0 / 11);
}

TEST(ExistenceTest, LostAfterAsManyMissesAsItTakes) {
    // Even odds at first, tenfold less at each miss: below 0.01 * 0.5 after the third, odds of 1 : 1000.
    const LifeParameters p = firstSights(1, 1);
    Existence existence(p);
    for (const bool lost : {false, false, true}) {
        existence.missed(0.9);
        EXPECT_EQ(existence.lost(p), lost) << existence.probability();
    }
}

TEST(ExistenceTest, ConfirmedFromItsProbabilityOn) {
    LifeParameters p = firstSights(1, 1);
    p.confirm_probability = 0.75;
    Existence existence(p);
    existence.detected(2.99);
    EXPECT_FALSE(existence.confirmed(p));
    existence.detected(1.01);
    EXPECT_TRUE(existence.confirmed(p));
}

/// Detected twenty times at 10 Hz, then missed for two seconds.
Existence afterTwoSecondsUnseen(const LifeParameters& p) {
    Existence existence(p);
    for (int i = 0; i < 20; ++i) {
        existence.pass(0.1, p);
        existence.detected(100);
    }
    for (int i = 0; i < 20; ++i) {
        existence.pass(0.1, p);
        existence.missed(0.9);
    }
    return existence;
}

TEST(ExistenceTest, AnEstablishedObjectOutlivesAnOcclusion) {
    LifeParameters p;
    EXPECT_TRUE(afterTwoSecondsUnseen(p).confirmed(p));
    // Where nothing hides it, it is gone: at most 1e9 : 1 after any number of detections, then 1e-20 of that.
    p.hidden_every = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(afterTwoSecondsUnseen(p).lost(p));
    EXPECT_NEAR(afterTwoSecondsUnseen(p).probability(), 1e-11, 1e-12);
}

TEST(ExistenceTest, NothingShakesWhatIsCertain) {
    const LifeParameters p;
    Existence existence = Existence::certain();
    for (int i = 0; i < 100; ++i) {
        existence.pass(1, p);
        existence.missed(0.9);
    }
    EXPECT_EQ(existence.probability(), 1);
    EXPECT_EQ(existence.visibility(), 1);
    EXPECT_FALSE(existence.lost(p));
    LifeParameters strict = p;
    strict.confirm_probability = 1;
    EXPECT_TRUE(existence.confirmed(strict));
}

TEST(ExistenceTest, WhatMayLeaveIsGoneInTime) {
    Existence existence(firstSights(1, 1));  // 1/2
    existence.mayLeave(3, 6);
    EXPECT_NEAR(existence.probability(), 0.5 * std::exp(-0.5), rounding);
    existence.mayLeave(3, std::numeric_limits<double>::infinity());
    EXPECT_NEAR(existence.probability(), 0.5 * std::exp(-0.5), rounding);
    // What is hidden leaves as what is visible does: missed for sure, all that is left is hidden.
    Existence hidden(firstSights(1, 1));
    LifeParameters p;
    p.hidden_every = p.hidden_for = 1;
    hidden.pass(1e6, p);  // 1/4 each
    hidden.mayLeave(6, 6);
    EXPECT_NEAR(hidden.visibility(), 0.25 * std::exp(-1), rounding);
    EXPECT_NEAR(hidden.probability(), 0.5 * std::exp(-1), rounding);
    Existence certain = Existence::certain();
    certain.mayLeave(1e9, 1);
    EXPECT_EQ(certain.probability(), 1);
}

TEST(ExistenceTest, ParametersAreDescribed) {
    LifeParameters p;
    ParameterTable table("objects", "");
    describe(p, "landmarks", table);
    std::vector<std::string> keys;
    for (const Parameter& parameter : table.parameters()) {
        keys.push_back(parameter.key);
        EXPECT_FALSE(parameter.parse(parameter.print())) << parameter.key;
        EXPECT_THAT(parameter.help, testing::Not(testing::IsEmpty()));
    }
    EXPECT_THAT(keys, ElementsAre("detection_probability", "clutter_per_scan", "new_per_scan",
                                  "confirm_probability", "remove_probability", "hidden_every", "hidden_for"));
    EXPECT_TRUE(table.find("detection_probability")->parse("1"));
    EXPECT_TRUE(table.find("hidden_for")->parse("0"));
    EXPECT_TRUE(table.find("clutter_per_scan")->parse("-1"));
    EXPECT_FALSE(table.find("hidden_every")->parse("inf"));
    EXPECT_FALSE(table.find("clutter_per_scan")->parse("12.5"));
    EXPECT_EQ(p.clutter_per_scan, 12.5);
}

}  // namespace existence_test
}  // namespace slamot
