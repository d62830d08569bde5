#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "slamot/core/config/Config.h"
#include "slamot/core/data/Angle.h"
#include "support/Expect.h"
#include "support/TemporaryFolder.h"

namespace slamot {
namespace config_test {

using test::messageOf;
using testing::AllOf;
using testing::HasSubstr;

std::string refusal(const std::string& text) {
    return messageOf<ConfigError>([&] { Config::fromText(text, "my.ini"); });
}

std::string value(const Config& config, const std::string& section, const std::string& key) {
    return config.section(section).at(key).value;
}

TEST(ConfigTest, ReadsSectionsKeysAndPlaces) {
    const auto config = Config::fromText(
        "# about\n[run]\nestimator = ekf // why\n\n  ; note\n[a.b] ; part\n x=1=2\n", "my.ini");
    EXPECT_EQ(config.sectionNames(), (std::vector<std::string>{"a.b", "run"}));
    EXPECT_EQ(value(config, "run", "estimator"), "ekf");
    EXPECT_EQ(config.section("run").at("estimator").origin, "my.ini:3");
    EXPECT_EQ(value(config, "a.b", "x"), "1=2");
    EXPECT_EQ(config.origin("a.b"), "my.ini:6");
    EXPECT_TRUE(config.has("run"));
    EXPECT_FALSE(config.has("nothing"));
    EXPECT_TRUE(config.section("nothing").empty());
}

TEST(ConfigTest, ReadsWindowsLinesContinuationsAndALastLineWithoutEnd) {
    EXPECT_EQ(value(Config::fromText("[a]\r\nx = 1\r\ny = 2\r\n"), "a", "x"), "1");
    const auto continued = Config::fromText("[a]\nx = 1, \\\n 2\ny = 3");
    EXPECT_THAT(value(continued, "a", "x"), AllOf(HasSubstr("1,"), HasSubstr("2")));
    EXPECT_EQ(value(continued, "a", "y"), "3");
}

TEST(ConfigTest, SpacesAroundSectionNamesDoNotLoseValues) {
    const auto config = Config::fromText("[ a ]\nx = 1\n");
    ASSERT_TRUE(config.has("a"));
    EXPECT_EQ(value(config, "a", "x"), "1");
}

TEST(ConfigTest, DefinesAndVariables) {
    const auto config = Config::fromText("@define V 3.5\n[a]\nx = ${V}\n@define W 4\ny = $eval{2*W}\n");
    EXPECT_EQ(value(config, "a", "x"), "3.5");
    EXPECT_EQ(numberFromText(value(config, "a", "y")), 8);
    EXPECT_THAT(refusal("[a]\nx = ${NOPE}\n"), AllOf(HasSubstr("my.ini"), HasSubstr("NOPE")));
    // One sentence, not MRPT's call stack.
    const std::string bad = refusal("[a]\nx = $eval{nope+}\n");
    EXPECT_THAT(bad, AllOf(HasSubstr("my.ini"), HasSubstr("nope")));
    EXPECT_EQ(bad.find('\n'), std::string::npos) << bad;
}

TEST(ConfigTest, RefusesABackslashThatWouldSwallowTheNextKey) {
    // MRPT joins each of these with the line below, where x = 1 is then part of a comment.
    for (const char* comment : {"# why \\", "; why \\", "// why \\", "y = 2 // why \\", "# why \\\r"})
        EXPECT_THAT(refusal(std::string("[a]\n") + comment + "\nx = 1\n"),
                    AllOf(HasSubstr("my.ini:2: the comment of"), HasSubstr("ends in '\\'")))
            << comment;
    EXPECT_THAT(refusal("[a]\ny = 1, \\\n 2 // why \\\nx = 1\n"), HasSubstr("my.ini:3: the comment of"));
    EXPECT_THAT(refusal("[a] \\\nx = 1\n"), HasSubstr("my.ini:1: '[a] \\' is no section header"));
}

TEST(ConfigTest, ABackslashBeforeABlankJoinsNothing) {
    // As MRPT reads it: the '\' is part of the value, the next line a key of its own.
    const auto config = Config::fromText("[a]\nx = 1 \\ \ny = 2\n# why \\ \nz = 3\n");
    EXPECT_EQ(value(config, "a", "x"), "1 \\");
    EXPECT_EQ(value(config, "a", "y"), "2");
    EXPECT_EQ(value(config, "a", "z"), "3");
}

TEST(ConfigTest, RefusesDirectivesMrptDoesNotHave) {
    for (const char* line : {"@x = 1", "@include other.ini", "@define", "@define x = 1", "@defineX 1",
                             "@DEFINE X 1", "@define X 1 \\"})
        EXPECT_EQ(
            refusal(std::string("[a]\n") + line + "\nx = 1\n"),
            std::string("my.ini:2: '") + line + "' is no directive, expected @define NAME value on one line");
}

TEST(ConfigTest, RefusesLinesThatAreNoIni) {
    EXPECT_EQ(refusal("[a]\nx = 1\nwhat\n"), "my.ini:3: 'what' is no setting, expected key = value");
    EXPECT_EQ(refusal("[a]\n= 1\n"), "my.ini:2: '= 1' is no setting, expected key = value");
    EXPECT_EQ(refusal("x = 1\n[a]\n"), "my.ini:1: 'x = 1' stands before any section, expected [name] first");
    for (const char* header : {"[a", "[]", "[a] b", "[ ]"})
        EXPECT_EQ(refusal(std::string("\n") + header + "\n"),
                  std::string("my.ini:2: '") + header + "' is no section header, expected [name]");
    EXPECT_THAT(refusal(std::string("[a]\nx = \0 1\n", 11)), HasSubstr("my.ini: holds binary data"));
}

TEST(ConfigTest, RefusesDoublesWithBothLines) {
    EXPECT_EQ(refusal("[a]\nx = 1\n\nx = 2\n"), "my.ini:4: key 'x' of [a] is there twice, first at line 2");
    EXPECT_EQ(refusal("[a]\nx = 1\n[b]\n[a]\n"), "my.ini:4: section [a] is there twice, first at line 1");
    // MRPT's reader takes no notice of case and would mix the two.
    EXPECT_EQ(refusal("[a]\nx = 1\nX = 2\n"), "my.ini:3: key 'X' of [a] is there twice, first at line 2");
    EXPECT_EQ(refusal("[a]\nx = 1\n[A]\nx = 2\n"), "my.ini:3: section [A] is there twice, first at line 1");
    EXPECT_EQ(value(Config::fromText("[a]\nx = 1\n[b]\nx = 2\n"), "a", "x"), "1");
}

class ConfigFileTest : public testing::Test {
  protected:
    std::string path(const std::string& name) const { return folder_.path(name); }
    void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
    static std::string refusalOf(const std::string& path) {
        return messageOf<ConfigError>([&] { Config::fromFile(path); });
    }

  private:
    const test::TemporaryFolder folder_;
};

TEST_F(ConfigFileTest, ReadsAFileAndItsFolder) {
    write("good.ini", "[a]\nx = 1\n");
    const auto config = Config::fromFile(path("good.ini"));
    EXPECT_EQ(value(config, "a", "x"), "1");
    EXPECT_EQ(config.section("a").at("x").origin, path("good.ini") + ":2");
    EXPECT_EQ(config.folder(), std::filesystem::path(path("good.ini")).parent_path().string());
    EXPECT_EQ(Config().folder(), ".");
}

TEST_F(ConfigFileTest, RefusesWhatIsNoFile) {
    EXPECT_EQ(refusalOf(path("none.ini")), path("none.ini") + ": no such config file");
    EXPECT_THAT(refusalOf(path("")), HasSubstr("config file"));
    write("program", std::string("\x7f"
                                 "ELF\0\0\1",
                                 7));
    EXPECT_THAT(refusalOf(path("program")), AllOf(HasSubstr(path("program")), HasSubstr("binary")));
}

TEST_F(ConfigFileTest, AnEmptyFileHasNoSections) {
    write("empty.ini", "");
    EXPECT_TRUE(Config::fromFile(path("empty.ini")).sectionNames().empty());
}

TEST(ConfigTest, AssignmentsSplitAtTheFirstEqualsAndTheLastDotBeforeIt) {
    Config config = Config::fromText("[a.b]\nc = old\n");
    config.setFromAssignment("a.b.c=x=y.z");
    EXPECT_EQ(value(config, "a.b", "c"), "x=y.z");
    EXPECT_EQ(config.section("a.b").at("c").origin, "--set a.b.c=x=y.z");
    config.setFromAssignment(" run . seed = 5 ");
    EXPECT_EQ(value(config, "run", "seed"), "5");
    config.setFromAssignment("a.empty=");
    EXPECT_EQ(value(config, "a", "empty"), "");
    for (const char* bad : {"", "a", "a.b", "a=1", ".b=1", "a.=1", "=1", "a=b.c", " .b=1", "a. =1"}) {
        Config none;
        EXPECT_EQ(messageOf<ConfigError>([&] { none.setFromAssignment(bad); }),
                  std::string("--set ") + bad + ": expected section.key=value");
    }
}

TEST(ConfigTest, CanonicalTextForgetsOrderAndComments) {
    const auto a = Config::fromText("[b]\ny = 2\nx = 1 // one\n[a]\nz=3\n"),
               b = Config::fromText("[a]\nz = 3\n[b]\nx=1\ny=2\n");
    EXPECT_EQ(a.canonicalText(), "[a]\nz = 3\n[b]\nx = 1\ny = 2\n");
    EXPECT_EQ(a.canonicalText(), b.canonicalText());
}

TEST(ConfigTest, LoadTakesWhatIsThereAndKeepsDefaults) {
    double speed = 1, angle = 2;
    ParameterTable table("robot", "A robot.");
    table.real("speed", speed, "m/s", Interval::positive(), "Speed.")
        .real("angle_deg", angle, "deg", Interval::any(), "");
    load(table, Config::fromText("[robot]\nangle_deg = 90\n[other]\nx = 1\n"));
    EXPECT_EQ(speed, 1);
    EXPECT_EQ(angle, pi / 2);
    load(table, Config());
    EXPECT_EQ(angle, pi / 2);
}

TEST(ConfigTest, LoadNamesFileLineKeyAndWhatWasExpected) {
    double speed = 1;
    int count = 1;
    ParameterTable table("robot", "A robot.");
    table.real("max_speed", speed, "m/s", Interval::positive(), "")
        .integer("count", count, Interval::between(1, 9), "");
    const auto loading = [&](const std::string& line) {
        return messageOf<ConfigError>(
            [&] { load(table, Config::fromText("[robot]\n" + line + "\n", "my.ini")); });
    };
    EXPECT_EQ(loading("max_sped = 1"),
              "my.ini:2: unknown key 'max_sped' in [robot]; did you mean 'max_speed'?");
    EXPECT_EQ(loading("zebra = 1"), "my.ini:2: unknown key 'zebra' in [robot]");
    EXPECT_EQ(loading("max_speed = fast"),
              "my.ini:2: max_speed = 'fast' in [robot], expected a number [m/s] above 0");
    EXPECT_EQ(loading("max_speed = 0"),
              "my.ini:2: max_speed = '0' in [robot], expected a number [m/s] above 0");
    EXPECT_EQ(loading("max_speed ="), "my.ini:2: max_speed = '' in [robot], expected a number [m/s] above 0");
    EXPECT_EQ(loading("count = 3.9"),
              "my.ini:2: count = '3.9' in [robot], expected a whole number in [1, 9]");
    Config set;
    set.setFromAssignment("robot.count=10");
    EXPECT_EQ(messageOf<ConfigError>([&] { load(table, set); }),
              "--set robot.count=10: count = '10' in [robot], expected a whole number in [1, 9]");
    EXPECT_EQ(speed, 1);
    EXPECT_EQ(count, 1);
}

TEST(ConfigTest, UnknownSectionsAreRefusedWithTheNearest) {
    const auto config = Config::fromText("[run]\n[ekf_slamod]\n[sensors.front]\n", "my.ini");
    EXPECT_EQ(messageOf<ConfigError>([&] {
                  requireKnownSections(config, {"run", "ekf_slamot"}, {"sensors."});
              }),
              "my.ini:2: unknown section [ekf_slamod]; did you mean 'ekf_slamot'?");
    EXPECT_NO_THROW(requireKnownSections(config, {"run", "ekf_slamod"}, {"sensors."}));
}

}  // namespace config_test
}  // namespace slamot
