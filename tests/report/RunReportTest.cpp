#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "report/RunFiles.h"
#include "sections/Courses.h"
#include "sections/ReplayData.h"
#include "sections/ReplayLayers.h"
#include "slamot/report/ReportSection.h"
#include "slamot/report/RunReport.h"

namespace slamot::report {
namespace run_report_test {

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
    /// The data of a replay's layer; null where it has none.
    static json layerOf(const json& data, const std::string& id) {
        for (const json& layer : data.at("layers")) {
            if (layer.at("id") == id) {
                return layer.at("data");
            }
        }
        return nullptr;
    }
    static json replayData(const RunFolder& run) { return json::parse(replayOf(run).data); }
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
    EXPECT_NEAR(std::get<Rule>(figure.panels[0].layers.at(1)).value, -2 * std::log(0.975),
                1e-9);  // 2 degrees
    EXPECT_NEAR(std::get<Rule>(figure.panels[0].layers.at(2)).value, -2 * std::log(0.025), 1e-9);
    EXPECT_EQ(std::get<Points>(figure.panels[0].layers.at(3)).points, (Points2{{2, 20}}));
    EXPECT_EQ(figure.panels[0].title,
              "sensor 'eye', landmarks: 50.0 % of 2 within 0.051 to 7.4, expected 95 %");
}

TEST_F(RunReport, landmarkErrorsAreThoseKnownAtTheTime) {
    const Figure figure = figureOf(runPage(run()), "landmark-errors");
    const Line& median = std::get<Line>(figure.panels.at(0).layers.at(2));
    EXPECT_NEAR(median.points.front().y(), 2,
                1e-12);  // (5, 7) against (5, 5); landmark 2 has no truth near it
    EXPECT_NEAR(median.points.back().y(), 0.5, 1e-12);  // seen again
}

const char* history_head = "t,id,x,y,c_xx,c_xy,c_yy,existence,moving,source_id\n";

TEST_F(RunReport, aLandmarkThatLeftTheMapDoesNotCountAfterItsLastSight) {
    // Landmark 2 was taken for the true landmark 10 too, 4 m off, and is not in the map at the end.
    folder_.write("landmarks_history.csv", std::string(history_head) +
                                               "1000.0000000,2,5,9,1,0,1,1,0,10\n"
                                               "1001.0000000,2,5,9,1,0,1,1,0,10\n"
                                               "1002.0000000,1,5,5.5,0.04,0,0.09,1,0,10\n");
    const Page page = runPage(run());
    const auto& figure = std::get<PageFigure>(sectionOf(page, "landmark-errors")->blocks.at(0));
    const auto& points = std::get<Line>(figure.figure.panels.at(0).layers.at(2)).points;
    EXPECT_NEAR(points.front().y(), 4, 1e-12);
    EXPECT_NEAR(points.at(95).y(), 4, 1e-12);     // 0.96 s
    EXPECT_TRUE(std::isnan(points.at(150).y()));  // 1.51 s: gone, and the other not yet seen
    EXPECT_NEAR(points.back().y(), 0.5, 1e-12);
    EXPECT_THAT(figure.caption, HasSubstr("1 true landmarks are in the map at the end"));
}

TEST_F(RunReport, aTrueLandmarkCountsOnceHoweverManyEstimatesItHas) {
    // Three true landmarks; 10 has two estimates, of which the one seen twice counts.
    truth_.write("landmarks.csv", "id,x,y\n10,5,5\n11,0,5\n12,0,9\n");
    folder_.write("landmarks.csv",
                  "id,x,y,c_xx,c_xy,c_yy,seen,first_t,last_t,existence,moving,source_id\n"
                  "1,5,7,1,0,1,1,1000.0000000,1000.0000000,1,0,10\n"
                  "2,5,6,1,0,1,2,1000.0000000,1001.0000000,1,0,10\n"
                  "3,0,5.5,1,0,1,1,1000.0000000,1000.0000000,1,0,11\n"
                  "4,0,9.25,1,0,1,1,1000.0000000,1000.0000000,1,0,12\n");
    folder_.write("landmarks_history.csv", std::string(history_head) +
                                               "1000.0000000,1,5,7,1,0,1,1,0,10\n"
                                               "1000.0000000,2,5,6,1,0,1,1,0,10\n"
                                               "1000.0000000,3,0,5.5,1,0,1,1,0,11\n"
                                               "1000.0000000,4,0,9.25,1,0,1,1,0,12\n"
                                               "1001.0000000,2,5,6,1,0,1,1,0,10\n");
    const Figure figure = figureOf(runPage(run()), "landmark-errors");
    const Line& median = std::get<Line>(figure.panels.at(0).layers.at(2));
    EXPECT_NEAR(median.points.front().y(), 0.5, 1e-12);  // of 2, 0.5 and 0.25
    EXPECT_NEAR(std::get<Band>(figure.panels[0].layers.at(0)).rows.back().high, 0.9, 1e-12);
    // The 90 % quantile of 0.25, 0.5 and 1 lies at 1.8 of 0, 1, 2: 0.5 + 0.8 * 0.5.
}

TEST_F(RunReport, theCutoffOfTheMetricsDecidesWhichTrueLandmarkIsNear) {
    // 0.5 m from the true one at the end, without a source id.
    folder_.write("landmarks_history.csv", std::string(history_head) + "1000.0000000,1,5,5.5,1,0,1,1,0,-1\n");
    const auto pageWith = [&](const std::string& cutoff) {
        folder_.write("summary.json", test::summaryJson("my.rawlog", R"({"options": {"landmark_cutoff": ")" +
                                                                         cutoff + R"("}})"));
        RunFolder read = readRunFolder(folder_.path());
        read.truth = readTruth(truth_.path());
        return runPage(read);
    };
    EXPECT_NE(sectionOf(pageWith("0.6"), "landmark-errors"), nullptr);
    const Page none = pageWith("0.4");
    EXPECT_EQ(sectionOf(none, "landmark-errors"), nullptr);
    EXPECT_THAT(toHtml(none), HasSubstr("within 0.4 m of its last place"));
    EXPECT_THAT(toHtml(none), ::testing::Not(HasSubstr("nan m")));
}

TEST_F(RunReport, withoutTheMapAtTheEndNoLandmarkIsTakenForGone) {
    std::filesystem::remove(folder_.path("landmarks.csv"));
    const json landmarks = layerOf(replayData(run()), "landmarks");
    EXPECT_EQ(landmarks.at("index"), json({0, 1, 0}));  // none of them with an end
}

TEST_F(RunReport, detectionsAtATimeCountScansThatSawNothing) {
    // Three detections in six scans.
    std::string steps = "t,landmarks,tracks,ms_predict,ms_detect,ms_update\n";
    for (int k = 0; k < 6; ++k) {
        steps += "100" + std::to_string(k / 2) + (k % 2 == 0 ? ".0000000" : ".5000000") + ",1,0,0.5,0,1\n";
    }
    folder_.write("steps.csv", steps);
    const auto mean = [&] {
        const Page page = runPage(run());
        const Figure& figure = figureOf(page, "outcomes");
        double top = 0;
        for (const Layer& layer : figure.panels.at(0).layers) {
            top = std::max(top, std::get<Band>(layer).rows.at(0).high);
        }
        return top;
    };
    EXPECT_NEAR(mean(), 0.5, 1e-12);
    folder_.write("steps.csv", "t,landmarks,tracks,ms_predict,ms_detect,ms_update\n");
    EXPECT_NEAR(mean(), 1, 1e-12);  // not known
}

TEST_F(RunReport, figuresSayWhatTheyLeaveOut) {
    std::string innovations = folder_.read("innovations.csv");
    const std::string row = ",landmark,2,-1,updated,0.1,0,1,0,1,2.5,0,0,1\n";
    for (int k = 0; k < 5; ++k) {
        innovations += "1003.0000000,sensor" + std::to_string(k) + row;
    }
    folder_.write("innovations.csv", innovations);
    const Page page = runPage(run());
    const auto& nis = std::get<PageFigure>(sectionOf(page, "nis")->blocks.at(0));
    EXPECT_EQ(nis.figure.panels.size(), 4u);
    EXPECT_THAT(nis.caption, HasSubstr("of 6 groups"));
    EXPECT_THAT(nis.figure.panels.at(0).title, HasSubstr("eye"));  // the one with two
}

TEST_F(RunReport, neesSaysWhereTruthStatesNoAccuracy) {
    const auto caption = [&] {
        const Page page = runPage(run());
        return std::get<PageFigure>(sectionOf(page, "nees")->blocks.at(0)).caption;
    };
    EXPECT_THAT(caption(), ::testing::Not(HasSubstr("accuracy")));  // simulated: exact
    truth_.write("truth.json", R"({"position_std": 0.02})");
    EXPECT_THAT(caption(), HasSubstr("standard deviation of 0.02 m"));
    truth_.write("truth.json", R"({"point_on_robot": [1, 0]})");
    EXPECT_THAT(caption(), HasSubstr("states no accuracy"));
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

TEST_F(RunReport, labelsThatAreNoUtf8AndSensorsWithoutLimitsHaveAPage) {
    std::string innovations = folder_.read("innovations.csv");
    while (innovations.find("eye") != std::string::npos) {
        innovations.replace(innovations.find("eye"), 3, "\xFF\xC3 x");
    }
    folder_.write("innovations.csv", innovations);
    std::string summary = test::summaryJson();
    const std::string sensors = R"("sensors": [])";
    summary.replace(summary.find(sensors), sensors.size(),
                    R"("sensors": [{"x": 1, "y": 0, "theta": 0, "max_range": null, "field_of_view": 6.28}])");
    folder_.write("summary.json", summary);
    const RunFolder read = run();
    EXPECT_THAT(toHtml(runPage(read)), HasSubstr("\xEF\xBF\xBD x"));
    const json sensor = layerOf(replayData(read), "sight").at("sensors").at(0);
    EXPECT_EQ(sensor.at("x"), 1);
    EXPECT_EQ(sensor.at("range"), 0);  // none is drawn
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

TEST_F(RunReport, theSeedKeepsEveryDigitAndStandsInTheSettings) {
    // 2^53 + 1 is the first whole number that no double holds.
    folder_.write("summary.json", test::summaryJson("my.rawlog", "null", "9007199254740993"));
    const std::string html = toHtml(runPage(run()));
    EXPECT_THAT(html, HasSubstr("<th scope=\"row\">seed</th><td>9007199254740993</td>"));
    EXPECT_THAT(html, HasSubstr("--truth none</pre>"));  // the settings hold it
    std::string summary = test::summaryJson("my.rawlog", "null", "9007199254740993");
    summary.replace(summary.find("[run]"), 5, "[other]");
    folder_.write("summary.json", summary);
    EXPECT_THAT(toHtml(runPage(run())), HasSubstr("--truth none --seed 9007199254740993</pre>"));
}

TEST_F(RunReport, theReplayShowsLandmarksAsTheyCome) {
    const json data = replayData(run());
    EXPECT_EQ(data.at("times"), json({0.0, 1.0, 2.0, 3.0}));
    const json landmarks = layerOf(data, "landmarks");
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
    EXPECT_EQ(layerOf(data, "sight").at("seen"), json::parse("[[0],[1],[0],[]]"));
    EXPECT_EQ(layerOf(data, "truth").at("robot").at("y"), json({0.0, 0.0, 0.0, 0.0}));
}

TEST_F(RunReport, truthMeasuredAtAPointIsShownAtTheOrigin) {
    // 2 m to the left of an origin on y = 0; the estimate looks along x and is 0.1 k m off in y.
    truth_.write("robot.csv",
                 "t,x,y,theta\n1000.0000000,0,2,\n1001.0000000,1,2,\n1002.0000000,2,2,\n1003.0000000,3,2,\n");
    truth_.write("truth.json", R"({"point_on_robot": [0, 2]})");
    const RunFolder read = run();
    const json data = replayData(read);
    EXPECT_EQ(layerOf(data, "truth").at("robot").at("x"), json({0.0, 1.0, 2.0, 3.0}));
    EXPECT_EQ(layerOf(data, "truth").at("robot").at("y"), json({0.0, 0.0, 0.0, 0.0}));
    EXPECT_NEAR(eval::robotErrors(read.pairs).position.final, 0.3, 1e-12);  // as far as the lines are apart
    const Page page = runPage(read);
    const auto& map = std::get<PageFigure>(sectionOf(page, "map")->blocks.at(0));
    EXPECT_THAT(map.caption, HasSubstr("measured at the point (0, 2) m"));
}

TEST_F(RunReport, theReplayOffersTheLayersThatTheRunHas) {
    const auto boxes = [](const ReplayView& replay) {
        std::string ids;
        for (const ReplayChoice& choice : replay.choices) {
            ids += choice.id + (choice.on ? "+ " : "- ");
        }
        return ids;
    };
    EXPECT_EQ(boxes(replayOf(run())), "truth+ sight+ ellipses+ follow- ");
    EXPECT_EQ(boxes(replayOf(run(false))), "sight+ ellipses+ follow- ");
    EXPECT_TRUE(layerOf(replayData(run(false)), "truth").is_null());
    EXPECT_THAT(toHtml(runPage(run(false))), ::testing::Not(HasSubstr("value=\"truth\"")));
}

TEST_F(RunReport, everyLayerOfTheReplayHasADrawing) {
    const std::string html = toHtml(runPage(run()));
    const std::string drawings = html.substr(html.find("const replayLayers = {"));
    for (const ReplayLayer& layer : replayLayers()) {
        if (layer.data) {
            EXPECT_THAT(drawings, HasSubstr("\n  " + std::string(layer.id) + "(replay, ")) << layer.id;
        }
    }
}

TEST(Replay, sightsAreThinnedEvenly) {
    // 3 of every 7, over all of them.
    std::size_t kept = 0, last = 0, longest = 0;
    for (std::size_t i = 0; i < 700; ++i) {
        if (isKept(i, 700, 300)) {
            longest = std::max(longest, i - last);
            last = i;
            ++kept;
        }
    }
    EXPECT_EQ(kept, 300u);
    EXPECT_LE(longest, 3u);
    EXPECT_EQ(last, 699u);
    EXPECT_TRUE(isKept(5, 10, 10));
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

TEST(FollowedObject, isTheTrackThatMetricsCount) {
    std::vector<TrackEstimate> tracks(3);
    for (std::size_t k = 0; k < tracks.size(); ++k) {
        tracks[k].id = {static_cast<std::int64_t>(9 - k)};
        tracks[k].source = {4};
        tracks[k].existence = k == 0 ? 0.5 : 0.9;
    }
    FollowedObject object;
    object.source = {4};
    EXPECT_EQ(object.among(tracks)->id.value, 7);  // of 8 and 7, which are as likely to exist
}

TEST(Courses, quantilesInterpolate) {
    EXPECT_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
    EXPECT_EQ(quantile({1, 2, 3}, 1), 3);
    EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

}  // namespace run_report_test
}  // namespace slamot::report
