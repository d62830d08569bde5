#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "report/RunFiles.h"
#include "sections/Courses.h"
#include "sections/ReplayData.h"
#include "slamot/report/ReportSection.h"
#include "slamot/report/RunReport.h"

namespace slamot::report {
namespace {

using nlohmann::json;
using test::TemporaryFolder;
using ::testing::HasSubstr;

class RunReport : public ::testing::Test {
  protected:
    RunReport() {
        test::writeRun(folder_);
        test::writeTruth(truth_);
    }
    RunFolder run(bool with_truth = true) const {
        return readRunFolder(folder_.path(), with_truth ? truth_.path() : "none");
    }
    static const PageSection* sectionOf(const Page& page, const std::string& id) {
        for (const PageSection& section : page.sections) {
            if (section.id == id) {
                return &section;
            }
        }
        return nullptr;
    }
    static const Figure& figureOf(const Page& page, const std::string& id) {
        return std::get<PageFigure>(sectionOf(page, id)->blocks.at(0)).figure;
    }

    TemporaryFolder folder_, truth_;
};

TEST_F(RunReport, theRobotsErrorStandsWithThreeSigma) {
    const Page page = runPage(run());
    const Figure& figure = figureOf(page, "robot-errors");
    ASSERT_EQ(figure.panels.size(), 3u);
    const Band& band = std::get<Band>(figure.panels[1].layers.at(0));
    EXPECT_NEAR(band.rows.at(2).high, 0.6, 1e-12);  // 3 sqrt(0.04)
    const Line& error = std::get<Line>(figure.panels[1].layers.at(1));
    EXPECT_NEAR(error.points.at(3).x(), 3, 1e-12);
    EXPECT_NEAR(error.points.at(3).y(), 0.3, 1e-12);
}

TEST_F(RunReport, neesIsTheSquaredErrorInItsCovariance) {
    const Figure figure = figureOf(runPage(run()), "nees");
    const Line& line = std::get<Line>(figure.panels.at(0).layers.at(2));
    EXPECT_NEAR(line.points.at(2).y(), 0.2 * 0.2 / 0.04, 1e-12);
    // Quantiles 0.025 and 0.975 of chi-square with 3 degrees of freedom, from tables.
    const Band& band = std::get<Band>(figure.panels.at(0).layers.at(0));
    EXPECT_NEAR(band.rows.at(0).low, 0.2158, 1e-4);
    EXPECT_NEAR(band.rows.at(0).high, 9.3484, 1e-4);
}

TEST_F(RunReport, nisLeavesOutWhatHadNoPrediction) {
    const Figure figure = figureOf(runPage(run()), "nis");
    ASSERT_EQ(figure.panels.size(), 1u);
    EXPECT_EQ(std::get<Points>(figure.panels[0].layers.at(0)).points, (Points2{{1, 2.5}}));
    EXPECT_EQ(std::get<Points>(figure.panels[0].layers.at(1)).points, (Points2{{2, 20}}));
}

TEST_F(RunReport, landmarkErrorsAreThoseKnownAtTheTime) {
    const Figure figure = figureOf(runPage(run()), "landmark-errors");
    const Line& median = std::get<Line>(figure.panels.at(0).layers.at(2));
    EXPECT_NEAR(median.points.front().y(), 2,
                1e-12);  // (5, 7) against (5, 5); landmark 2 has no truth near it
    EXPECT_NEAR(median.points.back().y(), 0.5, 1e-12);  // seen again
}

TEST_F(RunReport, withoutTruthOrFilesThePageSaysWhatIsMissing) {
    const Page page = runPage(run(false));
    EXPECT_EQ(sectionOf(page, "nees"), nullptr);
    EXPECT_NE(sectionOf(page, "nis"), nullptr);
    std::string missing;
    for (const Block& block : sectionOf(page, "not-shown")->blocks) {
        missing += std::get<Paragraph>(block).text + "\n";
    }
    EXPECT_THAT(missing, HasSubstr("NEES: no truth: the report was made without."));
    EXPECT_THAT(missing, HasSubstr("Correlations: correlation.bin is not there"));
    EXPECT_THAT(missing, HasSubstr("Track errors"));
}

TEST_F(RunReport, aFolderWithNothingButASummaryStillHasAPage) {
    const TemporaryFolder bare;
    bare.write("trajectory.csv", "t,x,y,theta,c_xx,c_xy,c_xt,c_yy,c_yt,c_tt\n");
    bare.write("summary.json", R"({"program": "slamot"})");
    EXPECT_THAT(toHtml(runPage(readRunFolder(bare.path()))), HasSubstr("the run has no step"));
}

TEST_F(RunReport, theSameFilesGiveTheSameBytes) {
    EXPECT_EQ(toHtml(runPage(run())), toHtml(runPage(run())));
}

TEST_F(RunReport, sectionsHaveNamesOfTheirOwn) {
    std::set<std::string> ids;
    for (const ReportSection* section : runSections()) {
        EXPECT_TRUE(ids.insert(section->id).second) << section->id;
    }
}

TEST_F(RunReport, droppedDataIsTextInATable) {
    const std::string html = toHtml(runPage(run()));
    EXPECT_THAT(
        html,
        HasSubstr("<th scope=\"row\">&lt;b&gt;lidar</th><td>no-detector</td><td class=\"number\">7</td>"));
}

TEST_F(RunReport, theReplayShowsLandmarksAsTheyCome) {
    const json data = json::parse(replayData(run()));
    EXPECT_EQ(data.at("times"), json({0.0, 1.0, 2.0, 3.0}));
    const json& landmarks = data.at("landmarks");
    EXPECT_EQ(landmarks.at("count"), 2);
    // Landmark 1 twice; landmark 2 once, and gone after it since the map at the end has it not.
    EXPECT_EQ(landmarks.at("index"), json({0, 1, 1, 0}));
    EXPECT_EQ(landmarks.at("frame"), json({0, 1, 2, 2}));
    EXPECT_TRUE(landmarks.at("x")[2].is_null());
    // 3 sqrt(9) along y is the longer half axis.
    EXPECT_NEAR(landmarks.at("a")[0].get<double>(), 9, 0.01);
    EXPECT_NEAR(landmarks.at("b")[0].get<double>(), 6, 0.01);
    EXPECT_NEAR(std::abs(landmarks.at("angle")[0].get<double>()), 1.57, 0.01);
    EXPECT_EQ(data.at("landmarkCount"), json({1, 2, 1, 1}));
    EXPECT_EQ(data.at("seen"), json::parse("[[0],[1],[0],[]]"));
    EXPECT_EQ(data.at("truth").at("y"), json({0.0, 0.0, 0.0, 0.0}));
}

TEST(VisibleChanges, keepsFirstLastAndWhatIsSeen) {
    std::vector<LandmarkSight> sights(5);
    for (std::size_t i = 0; i < sights.size(); ++i) {
        sights[i].id = {1};
        sights[i].mean.x() = i < 3 ? 0.01 * static_cast<double>(i) : 1;
    }
    const std::vector<LandmarkSight> kept = visibleChanges(sights, 0.1);
    ASSERT_EQ(kept.size(), 3u);
    EXPECT_EQ(kept[0].mean.x(), 0);
    EXPECT_EQ(kept[1].mean.x(), 1);
    EXPECT_EQ(kept[2].mean.x(), 1);
}

TEST(Courses, linesDoNotBridgeGaps) {
    ErrorCourse course;
    for (const double t : {0.0, 1.0, 2.0, 3.0, 20.0, 21.0}) {
        course.add(t, 1, 1);
    }
    breakAtGaps(course);
    ASSERT_EQ(course.seconds.size(), 7u);
    EXPECT_EQ(course.seconds[4], 11.5);
    EXPECT_TRUE(std::isnan(course.error[4]));
}

TEST(Courses, quantilesInterpolate) {
    EXPECT_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
    EXPECT_EQ(quantile({1, 2, 3}, 1), 3);
    EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

}  // namespace
}  // namespace slamot::report
