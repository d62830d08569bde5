#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "slamot/core/config/Config.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Angle.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot {
namespace parameters_test {

enum class Colour { red, green };

/// One of every kind.
struct Everything {
    double number = 0.1, angle = radians(3.0), limit = std::numeric_limits<double>::infinity();
    std::optional<double> maybe;
    std::vector<double> list{1, 0.1};
    std::vector<double> angles;
    int count = -3;
    std::uint64_t seed = std::numeric_limits<std::uint64_t>::max();
    bool flag = false;
    std::string words = "two words";
    Colour colour = Colour::green;

    ParameterTable table() {
        ParameterTable t("all", "All kinds.");
        t.real("number", number, "m", Interval::any(), "A number.")
            .real("angle_deg", angle, "deg", Interval::any(), "An angle.")
            .real("limit", limit, "s", Interval::positiveOrInfinite(), "A limit.")
            .optionalReal("maybe", maybe, "m", Interval::nonNegative(), "Perhaps a number.")
            .reals("list", list, "-", Interval::any(), "Numbers.")
            .reals("angles_deg", angles, "deg", Interval::any(), "Angles.")
            .integer("count", count, Interval::any(), "A count.")
            .seed("seed", seed, "A seed.")
            .flag("flag", flag, "A flag.")
            .text("words", words, "Words.")
            .choice("colour", colour, {{"red", Colour::red}, {"green", Colour::green}}, "A colour.");
        return t;
    }
    bool operator==(const Everything& o) const {
        return number == o.number && angle == o.angle && limit == o.limit && maybe == o.maybe &&
               list == o.list && angles == o.angles && count == o.count && seed == o.seed && flag == o.flag &&
               words == o.words && colour == o.colour;
    }
};

std::optional<std::string> parse(ParameterTable table, const std::string& key, const std::string& text) {
    return table.find(key)->parse(text);
}

TEST(ParametersTest, IniLoadsBackToEqualFields) {
    Everything out;
    out.maybe = 2.5;
    out.angles = {0.1, -3, radians(45)};
    out.colour = Colour::red;
    out.flag = true;
    Everything in;
    EXPECT_FALSE(in == out);
    load(in.table(), Config::fromText(toIni(out.table())));
    EXPECT_TRUE(in == out) << toIni(out.table()) << toIni(in.table());
    // Defaults, an empty list and 'auto' too.
    load(in.table(), Config::fromText(toIni(Everything().table())));
    EXPECT_TRUE(in == Everything());
    EXPECT_EQ(toIni(in.table()), toIni(Everything().table()));
}

TEST(ParametersTest, IniIsCommented) {
    double speed = 2;
    ParameterTable table("robot", "A robot.");
    table.real("speed", speed, "m/s", Interval::positive(), "How fast.");
    EXPECT_EQ(toIni(table),
              "# A robot.\n[robot]\n# How fast. Expected: a number [m/s] above 0.\nspeed = 2\n");
}

double randomNumber(RandomStream& random) {
    std::uint64_t bits = 0;
    double value = 0;
    do {
        bits = (static_cast<std::uint64_t>(random.bits()) << 32) | random.bits();
        std::memcpy(&value, &bits, sizeof value);
    } while (!std::isfinite(value));
    return value;
}

TEST(ParametersTest, NumbersRoundTripToTheSameBits) {
    RandomStream random(1, RandomPurpose::test);
    Everything fields;
    const ParameterTable table = fields.table();
    for (int i = 0; i < 100000; ++i) {
        const double value = randomNumber(random);  // any finite bit pattern
        fields.number = value;
        const std::string text = table.find("number")->print();
        fields.number = 0;
        ASSERT_FALSE(table.find("number")->parse(text)) << text;
        ASSERT_EQ(std::memcmp(&fields.number, &value, sizeof value), 0) << text;
    }
}

TEST(ParametersTest, AnglesRoundTripToTheSameBits) {
    RandomStream random(2, RandomPurpose::test);
    Everything fields;
    const ParameterTable table = fields.table();
    for (int i = 0; i < 100000; ++i) {
        const double value =
            i % 2 ? random.uniform(-pi, pi) : random.normal() * std::exp(random.uniform(-30, 10));
        fields.angle = value;
        const std::string text = table.find("angle_deg")->print();
        ASSERT_FALSE(table.find("angle_deg")->parse(text)) << text;
        ASSERT_EQ(fields.angle, value) << text << " i " << i;
    }
}

TEST(ParametersTest, AnglesPrintAsAPersonWouldWriteThem) {
    Everything fields;
    const ParameterTable table = fields.table();
    for (const char* text : {"3", "-90", "0.1", "180", "0", "12.5", "0.0573", "33.3333"}) {
        ASSERT_FALSE(table.find("angle_deg")->parse(text));
        EXPECT_EQ(fields.angle, radians(std::stod(text)));
        EXPECT_EQ(table.find("angle_deg")->print(), text);
    }
}

TEST(ParametersTest, RefusesNumbersThatDoNotParseWhole) {
    Everything fields;
    for (const char* key : {"number", "angle_deg", "limit", "maybe", "list", "count", "seed"})
        for (const char* text :
             {"abc", "1e", "nan", "1,5x", "3.9.1", "1 2", "0x10", "--1", "+-1", "1e999", "-", "+", "e5"})
            EXPECT_TRUE(parse(fields.table(), key, text)) << key << " '" << text << "'";
    for (const char* key : {"number", "limit", "maybe", "count", "seed"}) {
        EXPECT_TRUE(parse(fields.table(), key, "1,5")) << key;
        EXPECT_TRUE(parse(fields.table(), key, "")) << key;
    }
    for (const char* text : {"3.9", "1e3", "99999999999", "3."})
        EXPECT_TRUE(parse(fields.table(), "count", text));
    for (const char* text : {"-1", "1.5", "18446744073709551616"})
        EXPECT_TRUE(parse(fields.table(), "seed", text));
    for (const char* text : {"1,", ",1", "1,,2", ","})
        EXPECT_TRUE(parse(fields.table(), "list", text)) << text;
    for (const char* text : {"yes", "1", "True", ""})
        EXPECT_TRUE(parse(fields.table(), "flag", text)) << text;
    EXPECT_TRUE(fields == Everything()) << "a refused text changes nothing";
}

TEST(ParametersTest, TakesNumbersInAllUsualForms) {
    Everything fields;
    const ParameterTable table = fields.table();
    for (const auto& [text, value] :
         {std::pair{"1.5", 1.5}, {"+1.5", 1.5}, {" 2 ", 2.0}, {"1e-3", 1e-3}, {".5", .5}, {"-7", -7.}}) {
        EXPECT_FALSE(table.find("number")->parse(text)) << text;
        EXPECT_EQ(fields.number, value);
    }
}

TEST(ParametersTest, InfinityOnlyWhereTheIntervalSaysSo) {
    double open = 1, closed = 1, finite = 1;
    ParameterTable table("a", "");
    table.real("open", open, "", Interval::positiveOrInfinite(), "")
        .real("closed", closed, "", Interval::between(0, 2), "")
        .real("finite", finite, "", Interval::any(), "");
    EXPECT_TRUE(table.find("finite")->parse("inf"));
    EXPECT_FALSE(table.find("open")->parse("inf"));
    EXPECT_TRUE(std::isinf(open));
    EXPECT_EQ(table.find("open")->print(), "inf");
    EXPECT_TRUE(table.find("closed")->parse("inf"));
    EXPECT_TRUE(table.find("open")->parse("-inf"));
}

TEST(ParametersTest, IntervalsKnowTheirEnds) {
    EXPECT_FALSE(Interval::positive().contains(0));
    EXPECT_TRUE(Interval::nonNegative().contains(0));
    EXPECT_FALSE(Interval::openProbability().contains(1));
    EXPECT_TRUE(Interval::probability().contains(1));
    EXPECT_FALSE(Interval::probability().contains(1.0000001));
    EXPECT_FALSE(Interval::atLeast(2).contains(1.9));
    EXPECT_EQ(Interval::any().text(), "");
    EXPECT_EQ(Interval::positive().text(), "above 0");
    EXPECT_EQ(Interval::atLeast(2).text(), "of at least 2");
    EXPECT_EQ(Interval::openProbability().text(), "in (0, 1)");
    EXPECT_EQ((Interval{-std::numeric_limits<double>::infinity(), 4, false, true}.text()), "below 4");
    EXPECT_EQ((Interval{-std::numeric_limits<double>::infinity(), 4, false, false}.text()), "of at most 4");
}

TEST(ParametersTest, ChoicesSuggestTheNearestWord) {
    Everything fields;
    EXPECT_EQ(parse(fields.table(), "colour", "gren"), "one of red | green (did you mean 'green'?)");
    EXPECT_EQ(parse(fields.table(), "colour", "blue-ish"), "one of red | green");
}

TEST(ParametersTest, AKeyDescribedTwiceIsAMistakeOfTheProgram) {
    double a = 0;
    ParameterTable table("a", "");
    table.real("x", a, "", Interval::any(), "");
    EXPECT_THROW(table.real("x", a, "", Interval::any(), ""), std::logic_error);
}

TEST(ParametersTest, MarkdownEscapesBars) {
    std::string words = "a|b";
    Colour colour = Colour::red;
    ParameterTable table("all", "About.");
    table.text("words", words, "This | that.")
        .choice("colour", colour, {{"red", Colour::red}, {"green", Colour::green}}, "Which.");
    EXPECT_EQ(
        toMarkdown(table),
        "### `[all]`\n\nAbout.\n\n| key | default | unit | expected | meaning |\n|---|---|---|---|---|\n"
        "| `words` | `a\\|b` | - | text | This \\| that. |\n"
        "| `colour` | `red` | - | one of red \\| green | Which. |\n");
}

TEST(ParametersTest, NearestWordIsNearEnough) {
    const std::vector<std::string> words{"range", "bearing", "speed_std"};
    EXPECT_EQ(nearestWord("rnage", words), std::nullopt);  // two edits in five letters are too many
    EXPECT_EQ(nearestWord("rang", words), "range");        // one letter lost
    EXPECT_EQ(nearestWord("baering", words), "bearing");   // 2 edits, 7 / 3 = 2 allowed
    EXPECT_EQ(nearestWord("speed_sdt", words), "speed_std");
    EXPECT_EQ(nearestWord("speed", words), std::nullopt);  // 4 edits
    EXPECT_EQ(nearestWord("", words), std::nullopt);
    EXPECT_EQ(nearestWord("x", {}), std::nullopt);
}

}  // namespace parameters_test
}  // namespace slamot
