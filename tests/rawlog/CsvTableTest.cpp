#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "rawlog/TestLogs.h"
#include "slamot/rawlog/CsvTable.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::test {
namespace csv_table_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

class CsvTable : public RawlogTest {};

std::string messageOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const LogError& error) {
        return error.what();
    }
    return "no LogError";
}

TEST_F(CsvTable, ReadsColumnsByNameInAnyOrder) {
    writeBytes(path("a.csv"), "x, t ,name\r\n1.5,0.0000001,left\n\n-2,10,right\n");
    CsvReader csv(path("a.csv"));
    const int t = csv.column("t"), x = csv.column("x"), name = csv.column("name");
    ASSERT_TRUE(csv.next());
    EXPECT_EQ(csv.stamp(t).ticks, 1);
    EXPECT_EQ(csv.number(x), 1.5);
    EXPECT_EQ(csv.text(name), "left");
    ASSERT_TRUE(csv.next());
    EXPECT_EQ(csv.stamp(t).ticks, 100'000'000);
    EXPECT_EQ(csv.integer(x), -2);
    EXPECT_FALSE(csv.next());
    EXPECT_FALSE(csv.has("y"));
}

TEST_F(CsvTable, EmptyAndSpecialNumbers) {
    writeBytes(path("a.csv"), "a,b,c,d\n,nan,inf,-inf\n");
    CsvReader csv(path("a.csv"));
    ASSERT_TRUE(csv.next());
    EXPECT_TRUE(csv.empty(0));
    EXPECT_TRUE(std::isnan(csv.number(0)));
    EXPECT_TRUE(std::isnan(csv.number(1)));
    EXPECT_EQ(csv.number(2), std::numeric_limits<double>::infinity());
    EXPECT_EQ(csv.number(3), -std::numeric_limits<double>::infinity());
}

TEST_F(CsvTable, ErrorsNameFileLineColumnAndWhatWasExpected) {
    writeBytes(path("a.csv"), "t,x\n1,2\n3,4z\n");
    CsvReader csv(path("a.csv"));
    ASSERT_TRUE(csv.next());
    ASSERT_TRUE(csv.next());
    EXPECT_THAT(messageOf([&] { csv.number(1); }),
                AllOf(HasSubstr("a.csv:3"), HasSubstr("'x'"), HasSubstr("'4z'"), HasSubstr("a number")));
    EXPECT_THAT(messageOf([&] { csv.column("y"); }), AllOf(HasSubstr("a.csv:1"), HasSubstr("'y'")));
    EXPECT_THAT(messageOf([&] { CsvReader(path("none.csv")); }), HasSubstr("none.csv"));
    writeBytes(path("empty.csv"), "");
    EXPECT_THAT(messageOf([&] { CsvReader(path("empty.csv")); }), HasSubstr("header"));
    EXPECT_THAT(messageOf([&] { CsvReader reader(folder_.string()); }), HasSubstr("cannot be opened"));
}

TEST_F(CsvTable, AShortRowIsAnErrorButABrokenOffLastLineMayEndTheTable) {
    writeBytes(path("a.csv"), "t,x\n1\n2,3\n");
    CsvReader bad(path("a.csv"));
    EXPECT_THAT(messageOf([&] { bad.next(); }), AllOf(HasSubstr("a.csv:2"), HasSubstr("1 fields")));
    writeBytes(path("b.csv"), "t,x\n1,2\n3");
    CsvReader broken(path("b.csv"), LastLine::may_be_cut);
    EXPECT_TRUE(broken.next());
    EXPECT_FALSE(broken.next());
    CsvReader whole(path("b.csv"));
    EXPECT_TRUE(whole.next());
    EXPECT_THAT(messageOf([&] { whole.next(); }), AllOf(HasSubstr("b.csv:3"), HasSubstr("1 fields")));
}

TEST_F(CsvTable, TextsComeBackWhateverTheyHold) {
    const std::vector<std::string> texts = {"", "a,b", "say \"so\"", " blanks ", "\"", ",\",\"", "plain"};
    std::string line;
    for (const std::string& text : texts) line += (&text == &texts.front() ? "" : ",") + csvField(text);
    writeBytes(path("a.csv"), "0,1,2,3,4,5,6\n" + line + "\n1, \"x, y\" ,3,4,5,6,7\n");
    CsvReader table(path("a.csv"));
    ASSERT_TRUE(table.next());
    for (int column = 0; column < 7; ++column)
        EXPECT_EQ(table.text(column), texts[static_cast<std::size_t>(column)]);
    ASSERT_TRUE(table.next());
    EXPECT_EQ(table.text(1), "x, y");
    EXPECT_EQ(csvField("two\r\nlines"), "two  lines") << "a row is one line";
}

TEST_F(CsvTable, QuotesThatDoNotFitAreErrors) {
    writeBytes(path("a.csv"), "t,x\n1,2\n\"abc\"def,3\n");
    CsvReader behind(path("a.csv"));
    ASSERT_TRUE(behind.next());
    EXPECT_THAT(messageOf([&] { behind.next(); }),
                AllOf(HasSubstr("a.csv:3: field 1"), HasSubstr("closing quote, expected a comma")));
    writeBytes(path("b.csv"), "t,x\n1,\"2\n3,4\n");
    CsvReader open(path("b.csv"));
    EXPECT_THAT(messageOf([&] { open.next(); }),
                AllOf(HasSubstr("b.csv:2: field 2"), HasSubstr("no closing quote, expected one")));
    writeBytes(path("c.csv"), "t,\"x\n1,2\n");
    EXPECT_THAT(messageOf([&] { CsvReader reader(path("c.csv")); }), HasSubstr("c.csv:1: field 2"));
}

TEST_F(CsvTable, AQuoteBrokenOffInTheLastLineMayEndTheTable) {
    writeBytes(path("a.csv"), "t,x\n1,2\n3,\"fo");
    CsvReader broken(path("a.csv"), LastLine::may_be_cut);
    EXPECT_TRUE(broken.next());
    EXPECT_FALSE(broken.next());
    CsvReader whole(path("a.csv"));
    EXPECT_TRUE(whole.next());
    EXPECT_THAT(messageOf([&] { whole.next(); }), HasSubstr("a.csv:3: field 2"));
}

TEST(CsvFields, NumbersComeBackUnchanged) {
    std::string line;
    appendField(line, 0.1 + 0.2);
    appendField(line, std::int64_t{-7});
    appendField(line, std::string_view("word"));
    appendField(line, std::numeric_limits<double>::quiet_NaN());
    appendField(line, Stamp{15'000'001});
    EXPECT_EQ(line, "0.30000000000000004,-7,word,nan,1.5000001");
}

}  // namespace csv_table_test
}  // namespace slamot::test
