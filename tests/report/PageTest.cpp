#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "page/CompactSpec.h"
#include "page/Html.h"
#include "slamot/report/FigureSpec.h"
#include "slamot/report/FigureWriter.h"
#include "slamot/report/Page.h"
#include "support/TemporaryFolder.h"

namespace slamot::report {
namespace page_test {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

Figure lineFigure(Points2 points, bool logarithmic = false) {
    Figure figure;
    figure.panels.emplace_back();
    figure.panels[0].x = timeAxis();
    figure.panels[0].y.logarithmic = logarithmic;
    figure.panels[0].layers = {Line{"a <line>", std::move(points)}};
    return figure;
}

TEST(Html, nothingFromAFileIsMarkup) {
    EXPECT_EQ(escaped("<b a=\"1\" c='2'>&amp;"), "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;amp;");
    EXPECT_EQ(escaped("a\xFFz"), "a\xEF\xBF\xBDz");                // no UTF-8
    EXPECT_EQ(escaped(std::string("a\0z", 3)), "a\xEF\xBF\xBDz");  // a character that HTML forbids
    EXPECT_EQ(escaped("3σ\n"), "3σ\n");
    EXPECT_EQ(inScript(R"({"a":"</script><!--"})"), R"({"a":"\u003c/script>\u003c!--"})");
}

TEST(Page, everythingOfItIsText) {
    const std::string evil = "<script>alert(1)</script>\"'";
    Page page;
    page.title = page.subtitle = page.footer = evil;
    PageTable table{evil, {{evil, false}, {evil}}, {{{{evil}, {evil}}}, {{{evil}}, true}}};
    Figure figure = lineFigure({{0, 0}, {1, 1}});
    figure.title = figure.panels[0].title = evil;
    page.sections.push_back(
        {"id",
         evil,
         evil,
         {Paragraph{evil}, Verbatim{evil, evil, true}, table, PageFigure{"name", evil, figure, evil},
          ReplayView{evil,
                     json({{"text", evil}}).dump(),
                     evil,
                     {{evil, evil, true}},
                     {{ReplayKey::Symbol::disc, evil, evil}}}}});
    EXPECT_THAT(toHtml(page), Not(HasSubstr("<script>alert")));
}

TEST(Page, needsNothingFromElsewhere) {
    Page page;
    page.sections.push_back(
        {"id", "title", "", {PageFigure{"name", "alt", lineFigure({{0, 0}, {1, 1}}), ""}}});
    const std::string html = toHtml(page);
    for (const char* way : {"<link", "<img", " src=", "@import", "url("}) {
        EXPECT_EQ(html.substr(0, html.find("<script>")).find(way), std::string::npos) << way;
    }
    EXPECT_THAT(html, HasSubstr("Interactive Data Lab"));  // Vega's licence goes with it
    EXPECT_THAT(html, Not(HasSubstr("sourceMappingURL")));
    EXPECT_EQ(html, toHtml(page));
}

TEST(Page, marksTheBestAndHeadsGroups) {
    Page page;
    page.sections.push_back(
        {"id",
         "title",
         "",
         {PageTable{
             "T", {{"", false}, {"a"}, {"b"}}, {{{{"Robot"}}, true}, {{{"x"}, {"1", true}, {"2"}}}}}}});
    const std::string html = toHtml(page);
    EXPECT_THAT(html, HasSubstr("<th scope=\"colgroup\" colspan=\"3\">Robot</th>"));
    EXPECT_THAT(html, HasSubstr("<td class=\"number best\">1</td><td class=\"number\">2</td>"));
}

TEST(Page, aFileThatCannotBeWrittenIsASentence) {
    EXPECT_THROW(writePage({}, "/no/such/folder/page.html"), ReportError);
}

TEST(CompactSpec, keepsAHundredthOfAPixel) {
    // 1000 s on fewer than 900 pixels: 0.01 pixel is more than 0.01 s, so two digits are enough.
    const Points2 points = {{0, 0}, {0.123456789, 1.23456789}, {1000, 2}};
    const json spec = compactSpec(figureSpec(lineFigure(points)));
    const json& set = spec.at("data").at(0);
    ASSERT_EQ(set.at("columns"), json({"x", "y"}));
    const json& panel = spec.at("usermeta").at("panels").at(0);
    const double pixel = 1000 / panel.at("width").get<double>();
    EXPECT_NEAR(set.at("values")[0][1].get<double>(), 0.123456789, 0.01 * pixel);
    EXPECT_LT(set.at("values")[0][1].dump().size(), 6u);
    EXPECT_EQ(set.at("values")[0][2].dump(), "1000");
}

TEST(CompactSpec, farFromZeroNothingIsLost) {
    const json spec = compactSpec(figureSpec(lineFigure({{5000000, 0}, {5000000.5, 1}, {5000001, 2}})));
    EXPECT_EQ(spec.at("data")[0].at("values")[0][1], 5000000.5);
}

TEST(CompactSpec, logarithmicAxesKeepFiveDigitsOfAnySize) {
    const json spec = compactSpec(figureSpec(lineFigure({{0, 1.23456789e-7}, {1, 9.87654321e6}}, true)));
    EXPECT_NEAR(spec.at("data")[0].at("values")[1][0].get<double>(), 1.2346e-7, 1e-15);
    EXPECT_EQ(spec.at("data")[0].at("values")[1][1], 9876500);
}

TEST(CompactSpec, gapsStayGaps) {
    const json spec = compactSpec(figureSpec(lineFigure({{0, 0}, {1, std::nan("")}, {2, 1}})));
    EXPECT_TRUE(spec.at("data")[0].at("values")[1][1].is_null());
}

TEST(FigureMeta, saysWhichMarksALabelStandsForAndWhichAxesMove) {
    Figure figure = lineFigure({{0, 1}, {1, 1}}, true);
    figure.panels.push_back(lineFigure({{0, 1}, {1, 2}}).panels[0]);
    const json meta = figureSpec(figure).at("usermeta");
    EXPECT_EQ(meta.at("layers"),
              json::parse(R"([{"label":"a <line>","marks":["mark_p0_l0","mark_p1_l0"]}])"));
    EXPECT_FALSE(meta.at("panels")[0].at("y").at("moves").get<bool>());  // logarithmic
    EXPECT_TRUE(meta.at("panels")[1].at("y").at("moves").get<bool>());
}

TEST(Rounded, isTheNearestDecimal) {
    EXPECT_EQ(rounded(0.12345, 2), 0.12);
    EXPECT_EQ(rounded(1.15, 5), 1.15);
    EXPECT_EQ(rounded(12345, -2), 12300);
    EXPECT_TRUE(std::isnan(rounded(std::nan(""), 2)));
}

}  // namespace page_test
}  // namespace slamot::report
