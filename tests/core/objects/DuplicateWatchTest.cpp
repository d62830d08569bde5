#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "slamot/core/objects/DuplicateWatch.h"
#include "slamot/core/random/RandomStream.h"
#include "support/Expect.h"

namespace slamot {
namespace duplicate_watch_test {

using Pairs = std::vector<std::pair<BlockId, BlockId>>;

TEST(DuplicateWatchTest, OneDetectedSaysOneAsOftenAsItIsLikelier) {
    // P_D = 0.9: each look is 1 / (2 * 0.1) = 5 times likelier if the pair is one. 5^2 = 25 makes 25 / 26 =
    // 0.9615, 5^3 = 125 makes 0.9921.
    DuplicateWatch watch(0.9, 0.97);
    watch.look(3, 7, true, false);
    watch.look(3, 7, false, true);
    EXPECT_EQ(watch.merged(), Pairs{});
    watch.look(3, 7, true, false);
    EXPECT_EQ(watch.merged(), (Pairs{{3, 7}}));
    EXPECT_EQ(watch.merged(), (Pairs{{3, 7}})) << "reported until forgotten";
}

TEST(DuplicateWatchTest, NoneDetectedSaysOneToo) {
    // P_D = 0.6: 1 / 0.4 = 2.5 times likelier. 2.5^2 = 6.25 makes 0.862, 2.5^3 = 15.6 makes 0.940.
    DuplicateWatch watch(0.6, 0.9);
    for (int i = 0; i < 2; ++i) watch.look(1, 2, false, false);
    EXPECT_EQ(watch.merged(), Pairs{});
    watch.look(1, 2, false, false);
    EXPECT_EQ(watch.merged(), (Pairs{{1, 2}}));
}

TEST(DuplicateWatchTest, BothDetectedTakesThousandfoldEvidenceBack) {
    // 5^4 = 625 < 1000 < 5^5 / 1.
    DuplicateWatch watch(0.9, 0.51);
    watch.look(1, 2, true, true);
    for (int i = 0; i < 4; ++i) watch.look(1, 2, true, false);
    EXPECT_EQ(watch.merged(), Pairs{}) << "625 / 1000";
    watch.look(1, 2, true, false);
    EXPECT_EQ(watch.merged(), (Pairs{{1, 2}})) << "3125 / 1000";
}

TEST(DuplicateWatchTest, BelowOneHalfOneDetectedSpeaksOfTwo) {
    // P_D = 0.3: one detected has 1 / 1.4, none 1 / 0.7 = 2 / 1.4. n of each make (2 / 1.96)^n, which passes
    // 3 at n = 55 (2.0408^... 1.0204^54 = 2.976, 1.0204^55 = 3.037).
    DuplicateWatch alone(0.3, 0.75), both(0.3, 0.75);
    for (int i = 0; i < 1000; ++i) alone.look(1, 2, true, false);
    EXPECT_EQ(alone.merged(), Pairs{});
    for (int i = 0; i < 54; ++i) {
        both.look(1, 2, true, false);
        both.look(1, 2, false, false);
    }
    EXPECT_EQ(both.merged(), Pairs{});
    both.look(1, 2, true, false);
    both.look(1, 2, false, false);
    EXPECT_EQ(both.merged(), (Pairs{{1, 2}}));
    // At one half one detected says nothing at all.
    DuplicateWatch half(0.5, 0.501);
    for (int i = 0; i < 1000; ++i) half.look(1, 2, true, false);
    EXPECT_EQ(half.merged(), Pairs{});
}

TEST(DuplicateWatchTest, TheOrderOfThePairIsTheOlderFirst) {
    DuplicateWatch watch(0.9, 0.97);
    watch.look(7, 3, true, false);
    watch.look(3, 7, true, false);
    watch.look(7, 3, false, true);
    EXPECT_EQ(watch.merged(), (Pairs{{3, 7}}));
}

TEST(DuplicateWatchTest, ForgetsPairsAndLandmarks) {
    DuplicateWatch watch(0.9, 0.97);
    const Pairs all{{1, 2}, {1, 3}, {2, 3}, {4, 5}};
    for (const auto& [a, b] : all)
        for (int i = 0; i < 3; ++i) watch.look(a, b, true, false);
    EXPECT_EQ(watch.merged(), all);
    watch.forget(3, 1);
    EXPECT_EQ(watch.merged(), (Pairs{{1, 2}, {2, 3}, {4, 5}}));
    watch.forget(2);
    EXPECT_EQ(watch.merged(), (Pairs{{4, 5}}));
    for (int i = 0; i < 2; ++i) watch.look(1, 3, true, false);
    EXPECT_EQ(watch.merged(), (Pairs{{4, 5}})) << "the evidence starts anew";
    watch.look(1, 3, true, false);
    EXPECT_EQ(watch.merged(), (Pairs{{1, 3}, {4, 5}}));
}

TEST(DuplicateWatchTest, WrongMergesAreAsRareAsAskedFor) {
    // Wald: a pair that is two is ever reported with probability at most (1 - p) / p, here 1/19 = 0.0526.
    // Over 2000 pairs the count is below 2000 / 19 + 5 standard deviations of 10 = 155. Those that are one
    // are all found.
    const double P_D = 0.8;
    DuplicateWatch two(P_D, 0.95), one(P_D, 0.95);
    RandomStream random(5, RandomPurpose::test);
    int wrong = 0, found = 0;
    for (int pair = 0; pair < 2000; ++pair) {
        bool reported = false;
        for (int k = 0; k < 200; ++k) {
            two.look(0, 1, random.uniform() < P_D, random.uniform() < P_D);
            reported = reported || !two.merged().empty();
            const bool detected = random.uniform() < P_D, as_first = random.uniform() < 0.5;
            one.look(0, 1, detected && as_first, detected && !as_first);
        }
        wrong += reported;
        found += !one.merged().empty();
        two.forget(0);
        one.forget(1);
    }
    EXPECT_LT(wrong, 155);
    EXPECT_GT(wrong, 0) << "or the test shows nothing";
    EXPECT_EQ(found, 2000);
}

TEST(DuplicateWatchTest, RefusesWhatIsNoProbability) {
    EXPECT_EQ(test::messageOf<std::invalid_argument>([] { DuplicateWatch(1, 0.9); }),
              "DuplicateWatch: detection probability 1.000000, expected one within (0, 1)");
    EXPECT_EQ(test::messageOf<std::invalid_argument>([] { DuplicateWatch(0.9, std::nan("")); }),
              "DuplicateWatch: merge probability nan, expected one within (0, 1)");
}

}  // namespace duplicate_watch_test
}  // namespace slamot
