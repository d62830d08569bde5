#include <gmock/gmock.h>

#include "slamot/report/FigureWriter.h"
#include "slamot/study/Report.h"
#include "study/Builders.h"
#include "support/TemporaryFolder.h"

namespace slamot::study {
namespace report_test {

using testing::HasSubstr;
using testing::Not;

const char* const analysis_text = R"([table.errors]
kind = means
figures = robot.position.rmse
sources = paper1
caption = Errors of <all>
)";
const Provenance provenance = {"2026-01-31", "Some CPU", 2,
                               "slamot study demo.ini --db demo.db --report page.html"};

class StudyReport : public testing::Test {
  protected:
    std::string page(const CheckReport* checks = nullptr) const {
        const auto rows = rowsOf("paper1", "classic", {0.25, 0.25});
        writeReport(folder_.path("page.html"), {study_, analysis_, rows}, provenance, checks);
        const std::string html = folder_.read("page.html");
        return html.substr(0, html.find("<script>\n"));  // without Vega: failures stay readable
    }

    const StudyFile study_ = studyOf(analysis_text);
    const Analysis analysis_ = readAnalysis(study_);
    const test::TemporaryFolder folder_;
};

TEST_F(StudyReport, hasTheTablesOfTheStudyFileAsText) {
    const std::string html = page();
    EXPECT_THAT(html, HasSubstr("<title>Study demo</title>"));
    EXPECT_THAT(html, HasSubstr("<caption>Errors of &lt;all&gt;</caption>"));
    EXPECT_THAT(html, HasSubstr("<th scope=\"row\">classic</th><td class=\"number\">2</td>"));
    EXPECT_THAT(html, HasSubstr("0.250"));
    EXPECT_THAT(html, Not(HasSubstr("id=\"checks\"")));
}

TEST_F(StudyReport, saysOnceHowItIsMadeAgain) {
    const std::string html = page();
    EXPECT_THAT(html, HasSubstr("Made on 2026-01-31, Some CPU, 2 cores"));
    EXPECT_THAT(html, HasSubstr("from 2 runs.</p>"));
    EXPECT_THAT(html, HasSubstr(">slamot study demo.ini --db demo.db --report page.html</pre>"));
}

TEST_F(StudyReport, saysWhetherTheChecksPassed) {
    CheckReport checks;
    checks.results.push_back({"one", "mean of robot RMSE", CheckState::passed, 0.25, {0.2, 0.3}, "", ""});
    EXPECT_THAT(page(&checks), HasSubstr("All checks passed."));
    checks.results.push_back({"two", "mean of robot RMSE", CheckState::failed, 0.5, {0.2, 0.3}, "", ""});
    EXPECT_THAT(page(&checks), HasSubstr("Not all checks passed."));
}

TEST_F(StudyReport, aFileThatCannotBeWrittenIsASentence) {
    EXPECT_THROW(writeReport("/no/such/folder/page.html", {study_, analysis_, {}}, provenance, nullptr),
                 report::ReportError);
}

}  // namespace report_test
}  // namespace slamot::study
