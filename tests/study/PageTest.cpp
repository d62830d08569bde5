#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "slamot/core/Version.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/report/FigureWriter.h"
#include "slamot/study/Page.h"
#include "study/Builders.h"
#include "support/Expect.h"
#include "support/TemporaryFolder.h"

namespace slamot::study {
namespace page_test {

using test::messageOf;
using testing::HasSubstr;
using testing::Not;

const char* const analysis_text = R"([table.errors]
kind = means
figures = robot.position.rmse
sources = paper1
[figure.nees]
kind = bands
series = robot_nees
title = Mean NEES
)";
const Provenance provenance = {"2026-01-31", "Some CPU", 2, "slamot study demo.ini --db demo.db"};

class Page : public testing::Test {
  protected:
    void fill(const std::vector<Row>& rows, const CheckReport* checks = nullptr) const {
        fillPage(folder_.path("page.md"), {study_, analysis_, rows}, provenance, checks);
    }
    void write(const std::string& text) const { folder_.write("page.md", text); }
    std::string page() const { return folder_.read("page.md"); }
    std::string refusal(const std::string& text) const {
        write(text);
        const std::string message = messageOf<ConfigError>([&] { fill({}); });
        EXPECT_EQ(page(), text) << "a refused page stays as it was";
        return message;
    }

    const StudyFile study_ = studyOf(analysis_text);
    const Analysis analysis_ = readAnalysis(study_);
    const test::TemporaryFolder folder_;
};

TEST_F(Page, FillsTablesAndStamp) {
    write(
        "# Title\n\n<!-- study demo table errors -->\nold\nolder\n<!-- end -->\n\nWords.\n"
        "<!-- study demo stamp -->\n<!-- end -->\n<!-- study other table errors -->\nkept\n<!-- end -->\n");
    auto rows = rowsOf("paper1", "classic", {0.25});
    rows.push_back(failedRow("paper1", "invariant", 1));
    fill(rows);
    EXPECT_EQ(page(),
              "# Title\n\n<!-- study demo table errors -->\n"
              "| config    | runs | robot.position.rmse |\n"
              "|-----------|-----:|--------------------:|\n"
              "| classic   |    1 |               0.250 |\n"
              "| invariant |    1 |                   – |\n"
              "<!-- end -->\n\nWords.\n<!-- study demo stamp -->\n"
              "Filled on 2026-01-31, Some CPU, 2 cores, slamot " +
                  std::string(version) +
                  ", from 2 runs (1 failed): `slamot study demo.ini --db demo.db`\n"
                  "<!-- end -->\n<!-- study other table errors -->\nkept\n<!-- end -->\n");
}

TEST_F(Page, FillingTwiceIsFillingOnce) {
    write(
        "<!-- study demo table errors -->\n<!-- end -->\n\n<!-- study demo stamp -->\n<!-- end -->\nlast\n");
    const auto rows = rowsOf("paper1", "classic", {0.25, 0.5});
    fill(rows);
    const std::string once = page();
    fill(rows);
    EXPECT_EQ(page(), once);
}

TEST_F(Page, FiguresAreDrawnBesideThePage) {
    write("<!-- study demo figure nees -->\n<!-- end -->\n");
    auto rows = rowsOf("paper1", "classic", {1});
    rows[0].series["robot_nees"] = {{0, 1}, {3, 3}, {3, 3}};
    try {
        fill(rows);
    } catch (const report::ReportError& error) {
        GTEST_SKIP() << error.what();
    }
    EXPECT_EQ(page(), "<!-- study demo figure nees -->\n![Mean NEES](page_nees.svg)\n<!-- end -->\n");
    EXPECT_THAT(folder_.read("page_nees.svg"), HasSubstr("<svg"));
}

TEST_F(Page, FillsChecks) {
    CheckReport report;
    report.results.resize(1);
    report.results[0].name = "aim";
    report.results[0].state = CheckState::passed;
    write("<!-- study demo checks -->\n<!-- end -->\n");
    fill({}, &report);
    EXPECT_THAT(page(), HasSubstr("| aim   |"));
    EXPECT_THAT(page(), HasSubstr("| passed |"));
}

TEST_F(Page, RefusesWhatItCannotFill) {
    EXPECT_THAT(refusal("# No mark\n"), HasSubstr("page.md: has no mark of the study 'demo'"));
    EXPECT_THAT(refusal("<!-- study other stamp -->\n<!-- end -->\n"),
                HasSubstr("has no mark of the study 'demo'"));
    EXPECT_THAT(refusal("\n<!-- study demo table erors -->\n<!-- end -->\n"),
                HasSubstr("page.md:2: the study has no table 'erors'; did you mean 'errors'?"));
    EXPECT_THAT(refusal("<!-- study demo figure errors -->\n<!-- end -->\n"),
                HasSubstr("no figure 'errors'"));
    EXPECT_THAT(refusal("<!-- study demo tabel errors -->\n<!-- end -->\n"),
                HasSubstr("'tabel errors' is no mark, expected table NAME, figure NAME, checks or stamp"));
    EXPECT_THAT(refusal("<!-- study demo stamp -->\nno end\n"), HasSubstr("page.md:1:"));
    EXPECT_THAT(refusal("<!-- study demo stamp -->\n<!-- study demo stamp -->\n<!-- end -->\n"),
                HasSubstr("has no end, expected <!-- end --> before the next mark"));
    EXPECT_THAT(refusal("<!-- study demo checks -->\n<!-- end -->\n"), HasSubstr("were not made"));
}

TEST_F(Page, KeepsTheLineEndsOfWindows) {
    write("# Title\r\n<!-- study demo table errors -->\r\nold\r\n<!-- end -->\r\nlast\r\n");
    fill(rowsOf("paper1", "classic", {0.25}));
    EXPECT_EQ(page(),
              "# Title\r\n<!-- study demo table errors -->\r\n"
              "| config  | runs | robot.position.rmse |\r\n"
              "|---------|-----:|--------------------:|\r\n"
              "| classic |    1 |               0.250 |\r\n"
              "<!-- end -->\r\nlast\r\n");
}

TEST_F(Page, AStudysNameMayHoldBlanks) {
    StudyFile study = study_;
    study.name = "my own study";
    write(
        "<!-- study my own study stamp -->\n<!-- end -->\n"
        "<!-- study my own studystamp stamp -->\nkept\n<!-- end -->\n");
    fillPage(folder_.path("page.md"), {study, analysis_, {}}, provenance, nullptr);
    EXPECT_THAT(page(), HasSubstr("-->\nFilled on"));
    EXPECT_THAT(page(), HasSubstr("-->\nkept\n"));
}

TEST_F(Page, LinksToFiguresOfPagesWithBlanks) {
    const StudyFile study = studyOf("[figure.f]\nkind = bands\nseries = robot_nees\ntitle = a * b [x](y)\n");
    const Analysis analysis = readAnalysis(study);
    folder_.write("a page.md", "<!-- study demo figure f -->\n<!-- end -->\n");
    try {
        fillPage(folder_.path("a page.md"), {study, analysis, {}}, provenance, nullptr);
    } catch (const report::ReportError& error) {
        GTEST_SKIP() << error.what();
    }
    EXPECT_THAT(folder_.read("a page.md"), HasSubstr("![a \\* b \\[x\\](y)](a%20page_f.svg)"));
    EXPECT_THAT(folder_.read("a page_f.svg"), HasSubstr("<svg"));
}

TEST_F(Page, AFullDiskLeavesThePageAsItWas) {
    const std::string text = "<!-- study demo stamp -->\n<!-- end -->\n";
    write(text);
    std::filesystem::create_symlink("/dev/full", folder_.path("page.md.part"));
    EXPECT_THAT(messageOf<LogError>([&] { fill({}); }),
                HasSubstr("page.md: cannot be written to its end (is the disk full?)"));
    EXPECT_EQ(page(), text);
}

TEST_F(Page, OfALinkThePageItLeadsToIsFilledAndKeepsItsMode) {
    namespace fs = std::filesystem;
    fs::create_directory(folder_.path("real"));
    const std::string real =
        folder_.write("real/there.md", "<!-- study demo table errors -->\n<!-- end -->\n");
    fs::permissions(real, fs::perms(0640));
    fs::create_symlink("real/there.md", folder_.path("page.md"));
    fill(rowsOf("paper1", "classic", {0.25}));
    EXPECT_TRUE(fs::is_symlink(folder_.path("page.md")));
    EXPECT_THAT(folder_.read("real/there.md"), HasSubstr("| classic |    1 |"));
    EXPECT_EQ(fs::status(real).permissions(), fs::perms(0640));
}

TEST_F(Page, ACommandWithBackticksIsStillCode) {
    EXPECT_THAT(stampLine({"d", "p", 1, "slamot study 'a`b.ini'"}, {study_, analysis_, {}}),
                HasSubstr(": ``slamot study 'a`b.ini'``"));
}

TEST_F(Page, StampCountsMachinesButDoesNotNameThem) {
    auto rows = rowsOf("paper1", "classic", {1, 2, 3});
    rows[0].cost.host = "alpha";
    rows[1].cost.host = rows[2].cost.host = "beta";
    const std::string line = stampLine(provenance, {study_, analysis_, rows});
    EXPECT_THAT(line, HasSubstr("3 runs on 2 machines: `slamot"));
    EXPECT_THAT(line, Not(HasSubstr("alpha")));
}

TEST_F(Page, StampSaysWhatIsNotThere) {
    Plan plan;
    plan.study = study_;
    plan.worlds.emplace_back();  // of paper1
    plan.kinds.emplace_back().runs.resize(5);
    plan.skipped = {"source quiet is skipped: no *.rawlog in /some/folder"};
    auto rows = rowsOf("paper1", "classic", {1, 2, 3});
    rows[1].status = "truncated";
    rows[2].status = "corrupt";
    rows.push_back(failedRow("paper1", "classic", 4));
    const std::string some = stampLine(provenance, {study_, analysis_, rows, &plan});
    EXPECT_THAT(some,
                HasSubstr(", from 4 of 5 runs (1 failed, 1 truncated, 1 corrupt; no runs of: quiet): `"));
    EXPECT_THAT(some, Not(HasSubstr("/some/folder")));
    plan.kinds[0].runs.resize(1);
    plan.skipped.clear();
    rows.resize(1);
    EXPECT_THAT(stampLine(provenance, {study_, analysis_, rows, &plan}), HasSubstr(", from 1 runs: `slamot"));
}

TEST_F(Page, MarksOfAnotherKeywordAreFilledByTheirOwner) {
    const std::string others = "<!-- study speed table a -->\nkept\n<!-- end -->\n";
    write(others +
          "<!-- bench speed table a -->\nold\n<!-- end -->\n<!-- bench size stamp -->\n<!-- end -->\n");
    const auto content = [](const std::vector<std::string>& words) {
        return words.front() + "+" + words.back() + "\n";
    };
    const std::string file = folder_.path("page.md");
    EXPECT_EQ(filledText(file, "bench", "speed", content),
              others +
                  "<!-- bench speed table a -->\ntable+a\n<!-- end -->\n<!-- bench size stamp -->\n"
                  "<!-- end -->\n");
    EXPECT_THAT(messageOf<ConfigError>([&] { filledText(file, "bench", "weight", content); }),
                HasSubstr("has no mark of the bench 'weight', expected <!-- bench weight table NAME -->"));
}

TEST(ProvenanceHere, KnowsDayAndMachine) {
    const Provenance here = provenanceHere("slamot study x.ini");
    EXPECT_THAT(here.date, testing::MatchesRegex("20[0-9][0-9]-[01][0-9]-[0-3][0-9]"));
    EXPECT_GE(here.cores, 1u);
    EXPECT_FALSE(here.processor.empty());
    EXPECT_EQ(here.command, "slamot study x.ini");
}

}  // namespace page_test
}  // namespace slamot::study
