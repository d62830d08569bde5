#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>

#include "slamot/core/data/Stamp.h"

namespace slamot {
namespace stamp_test {

TEST(StampTest, PrintsSevenDecimalsFromTheTicks) {
    EXPECT_EQ(toText(Stamp{0}), "0.0000000");
    EXPECT_EQ(toText(Stamp{1}), "0.0000001");
    EXPECT_EQ(toText(Stamp{-1}), "-0.0000001");
    EXPECT_EQ(toText(Stamp{-10'000'001}), "-1.0000001");
    // 2023-11-14 in ticks: more digits than a double holds.
    EXPECT_EQ(toText(Stamp{17'000'000'001'234'567}), "1700000000.1234567");
    EXPECT_EQ(toText(Stamp{INT64_MIN}), "-922337203685.4775808");
    EXPECT_EQ(toText(Stamp{INT64_MAX}), "922337203685.4775807");
}

TEST(StampTest, TextRoundTrips) {
    for (const std::int64_t ticks :
         {0L, 1L, -1L, 9'999'999L, 10'000'000L, -10'000'001L, 17'000'000'001'234'567L,
          -17'000'000'001'234'567L, 900'000'000'000'000'000L})
        EXPECT_EQ(stampFromText(toText(Stamp{ticks})).ticks, ticks);
}

TEST(StampTest, RoundsTheEighthDecimal) {
    EXPECT_EQ(stampFromText("0.00000004").ticks, 0);
    EXPECT_EQ(stampFromText("0.00000005").ticks, 1);
    EXPECT_EQ(stampFromText("0.000000149999").ticks, 1);
    EXPECT_EQ(stampFromText("0.99999995").ticks, 10'000'000);
    EXPECT_EQ(stampFromText("-0.00000005").ticks, -1);
    EXPECT_EQ(stampFromText("1.123456749999999999999999999").ticks, 11'234'567);
}

TEST(StampTest, ReadsShortForms) {
    EXPECT_EQ(stampFromText("5").ticks, 50'000'000);
    EXPECT_EQ(stampFromText("5.").ticks, 50'000'000);
    EXPECT_EQ(stampFromText(".5").ticks, 5'000'000);
    EXPECT_EQ(stampFromText("-2.5").ticks, -25'000'000);
    EXPECT_EQ(stampFromText("0000001.5").ticks, 15'000'000);
}

TEST(StampTest, RefusesWhatIsNoTime) {
    for (const char* text : {"", "-", ".", "-.", "1.2.3", "1e5", "abc", "1 ", " 1", "+1", "1,5", "0x10",
                             "nan", "inf", "--1", "1-", "99999999999999999999999999"})
        EXPECT_THROW(stampFromText(text), std::invalid_argument) << "'" << text << "'";
}

TEST(StampTest, SecondsAndStampsAgree) {
    EXPECT_EQ(Stamp::fromSeconds(0.15).ticks, 1'500'000);
    EXPECT_EQ(Stamp::fromSeconds(-0.15).ticks, -1'500'000);
    EXPECT_EQ(secondsBetween({17'000'000'000'000'000}, {17'000'000'001'500'000}), 0.15);
    EXPECT_EQ(later({10}, 0.15).ticks, 1'500'010);
    EXPECT_TRUE(Stamp{1} < Stamp{2} && Stamp{2} > Stamp{1} && Stamp{1} <= Stamp{1} && Stamp{1} >= Stamp{1});
    EXPECT_TRUE(Stamp{1} == Stamp{1} && Stamp{1} != Stamp{2});
}

}  // namespace stamp_test
}  // namespace slamot
