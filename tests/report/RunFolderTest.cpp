#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include "report/RunFiles.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/report/RunFolder.h"

namespace slamot::report {
namespace run_folder_test {

using test::TemporaryFolder;
using ::testing::HasSubstr;

std::string errorOf(const std::string& folder) {
    try {
        readRunFolder(folder);
    } catch (const LogError& error) {
        return error.what();
    }
    return "no error";
}

TEST(RunFolder, readsWhatARunLeft) {
    const TemporaryFolder folder, truth;
    test::writeRun(folder);
    test::writeTruth(truth);
    const RunFolder run = readRunFolder(folder.path(), truth.path());
    EXPECT_EQ(run.duration(), 3);
    ASSERT_EQ(run.sights.size(), 3u);
    EXPECT_EQ(run.sights[0].covariance(1, 1), 9);
    EXPECT_EQ(run.sights[2].mean.y(), 5.5);
    ASSERT_EQ(run.steps.size(), 4u);
    EXPECT_EQ(run.steps[1].landmarks, 2);
    EXPECT_EQ(run.steps[2].update_ms, 3);
    EXPECT_EQ(run.pairs.size(), 4u);
    EXPECT_EQ(run.number("time/step_ms/mean"), 0.25);
    EXPECT_FALSE(run.number("metrics/no/such"));
    EXPECT_FALSE(run.correlation);
}

TEST(RunFolder, switchedOffFilesLeaveTheirPartEmpty) {
    const TemporaryFolder folder;
    folder.write("trajectory.csv", test::trajectory_csv);
    folder.write("summary.json", test::summaryJson());
    const RunFolder run = readRunFolder(folder.path());
    EXPECT_TRUE(run.sights.empty() && run.steps.empty() && run.run.landmarks.empty());
    EXPECT_EQ(run.why_no_truth, "the run had none");
}

TEST(RunFolder, saysWhereTruthThatIsGoneWas) {
    const TemporaryFolder folder;
    std::string summary = test::summaryJson();
    summary.replace(summary.find(R"("truth": null)"), 13, R"("truth": "no/such.truth")");
    test::writeRun(folder, summary);
    EXPECT_THAT(readRunFolder(folder.path()).why_no_truth, HasSubstr("no/such.truth"));
    EXPECT_THROW(readRunFolder(folder.path(), "no/such.truth"), LogError);  // asked for: an error
}

std::string withTruth(const std::string& truth, const std::string& directory = {}) {
    std::string summary = test::summaryJson();
    const std::string none = R"("truth": null)";
    const std::string started = directory.empty() ? "" : R"("directory": ")" + directory + R"(", )";
    return summary.replace(summary.find(none), none.size(), started + R"("truth": ")" + truth + '"');
}

TEST(RunFolder, relativePathsStartWhereTheRunWasStarted) {
    const TemporaryFolder folder, started;
    std::filesystem::create_directory(started.path("t"));
    started.write("t/robot.csv", "t,x,y,theta\n1000.0000000,7,0,0\n");
    started.write("t/truth.json", "{}");
    started.write("my.rawlog", "");
    test::writeRun(folder, withTruth("t", started.path()));
    const RunFolder run = readRunFolder(folder.path());
    ASSERT_TRUE(run.truth) << run.why_no_truth;
    EXPECT_EQ(run.truth->robot.at(0).pose.x, 7);
    EXPECT_EQ(run.truth_folder, "t");
    EXPECT_EQ(run.log_file, started.path("my.rawlog"));
}

TEST(RunFolder, truthThatWasMovedAlongIsFoundAboveTheRun) {
    const TemporaryFolder all;
    for (const char* name : {"t", "out", "out/run"}) {
        std::filesystem::create_directory(all.path(name));
    }
    all.write("t/robot.csv", "t,x,y,theta\n1000.0000000,7,0,0\n");
    all.write("t/truth.json", "{}");
    all.write("out/run/trajectory.csv", test::trajectory_csv);
    all.write("out/run/summary.json", withTruth("t", "/no/such/folder"));
    const RunFolder run = readRunFolder(all.path("out/run"));
    EXPECT_TRUE(run.truth) << run.why_no_truth;
    EXPECT_FALSE(run.lost_truth);
    EXPECT_EQ(run.log_file, "my.rawlog");  // not moved along
}

TEST(RunFolder, saysThatARunWasKilled) {
    const TemporaryFolder folder;
    folder.write("trajectory.csv", test::trajectory_csv);
    EXPECT_THAT(errorOf(folder.path()), HasSubstr("was killed"));
}

TEST(RunFolder, aBrokenTruthOfTheRunIsASentenceAndOneAskedForAnError) {
    const TemporaryFolder folder, truth;
    std::string summary = test::summaryJson();
    summary.replace(summary.find(R"("truth": null)"), 13, R"("truth": ")" + truth.path() + '"');
    test::writeRun(folder, summary);
    test::writeTruth(truth);
    EXPECT_EQ(readRunFolder(folder.path()).truth_folder, truth.path());
    truth.write("robot.csv", "t,x,y\n");
    const RunFolder run = readRunFolder(folder.path());
    EXPECT_FALSE(run.truth);
    EXPECT_THAT(run.why_no_truth, HasSubstr("robot.csv"));
    EXPECT_THROW(readRunFolder(folder.path(), truth.path()), LogError);
}

TEST(RunFolder, metricsAreThoseOfTheTruthThatWasAskedFor) {
    const TemporaryFolder folder, truth;
    test::writeRun(folder, test::summaryJson("my.rawlog", R"({"robot": {"position": {"rmse": 77}}})"));
    test::writeTruth(truth);
    const char* rmse = "metrics/robot/position/rmse";
    EXPECT_EQ(readRunFolder(folder.path()).number(rmse), 77);
    EXPECT_FALSE(readRunFolder(folder.path(), "none").number(rmse));
    // Errors of 0, 0.1, 0.2 and 0.3 m.
    EXPECT_NEAR(*readRunFolder(folder.path(), truth.path()).number(rmse), std::sqrt(0.14 / 4), 1e-12);
}

TEST(RunFolder, metricsAreEvaluatedAsTheRunWas) {
    const TemporaryFolder folder, truth;
    test::writeTruth(truth);
    test::writeRun(folder, test::summaryJson("my.rawlog", R"({"options": {"landmark_cutoff": "0.25"}})"));
    EXPECT_EQ(readRunFolder(folder.path()).evaluation.landmark_cutoff, 0.25);
    std::string summary = test::summaryJson();  // no metrics: as its settings say
    summary.replace(summary.find("[run]"), 5, "[eval]\\nprobability = 0.5\\n[run]");
    test::writeRun(folder, summary);
    EXPECT_EQ(readRunFolder(folder.path()).evaluation.probability, 0.5);
    const RunFolder run = readRunFolder(folder.path(), truth.path());
    EXPECT_EQ(run.summary.at("metrics").at("options").at("probability"), "0.5");
}

TEST(RunFolder, refusesWhatNoRunLeft) {
    const TemporaryFolder folder;
    EXPECT_THAT(errorOf(folder.path()), HasSubstr("no summary.json"));
    folder.write("summary.json", R"({"program": "another"})");
    EXPECT_THAT(errorOf(folder.path()), HasSubstr("is not what slamot writes"));
    folder.write("summary.json", "{");
    EXPECT_THAT(errorOf(folder.path()), HasSubstr("is not what slamot writes"));
}

TEST(RunFolder, namesTheSummaryThatIsOfAnotherKind) {
    const auto errorWith = [](const std::string& from, const std::string& to) {
        const TemporaryFolder folder;
        std::string summary = test::summaryJson("my.rawlog", R"({"options": {"probability": "0.9"}})");
        const std::size_t at = summary.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        test::writeRun(folder, summary.replace(at, from.size(), to));
        return errorOf(folder.path());
    };
    EXPECT_EQ(errorWith("0.9", "0.9"), "no error");
    for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
             {R"("probability": "0.9")", R"("probability": "much")"},
             {R"("probability": "0.9")", R"("probability": {})"},
             {R"("program": "slamot")", R"("program": 1)"},
             {R"("sensors": [])", R"("sensors": [7])"},
             {R"("sensors": [])", R"("sensors": [{"x": "far"}])"},
             {R"("warnings": [])", R"("warnings": "one")"},
             {R"("log": "my.rawlog")", R"("log": [])"},
             {R"("count": 7)", R"("count": "many")"}}) {
        const std::string error = errorWith(from, to);
        EXPECT_THAT(error, HasSubstr("summary.json")) << to;
        EXPECT_THAT(error, HasSubstr("expected")) << to;
        EXPECT_THAT(error, ::testing::Not(HasSubstr("json.exception"))) << to;
    }
}

TEST(RunFolder, refusesPlacesThatAreNoNumbers) {
    const TemporaryFolder folder;
    test::writeRun(folder);
    folder.write("landmarks_history.csv",
                 "t,id,x,y,c_xx,c_xy,c_yy,existence,moving,source_id\n"
                 "1000.0000000,1,5,nan,4,0,9,1,0,10\n1001.0000000,1,5,7,4,0,9,1,0,10\n");
    EXPECT_THAT(errorOf(folder.path()), HasSubstr("landmarks_history.csv:2"));
}

TEST(RunFolder, readsTheCorrelationMatrixAndRefusesABrokenOne) {
    const TemporaryFolder folder;
    test::writeRun(folder);
    const std::uint32_t header[] = {1, 9, 2};
    const float cells[] = {1, 0.5F, -0.5F, 1};
    std::string bytes = "SLAMCORR";
    bytes.append(reinterpret_cast<const char*>(header), sizeof header);
    bytes.append(reinterpret_cast<const char*>(cells), sizeof cells);
    folder.write("correlation.bin", bytes);
    const RunFolder run = readRunFolder(folder.path());
    ASSERT_TRUE(run.correlation);
    EXPECT_EQ(run.correlation->dimension, 9);
    EXPECT_EQ(run.correlation->cells(0, 1), 0.5F);
    EXPECT_EQ(run.correlation->cells(1, 0), -0.5F);
    folder.write("correlation.bin", bytes.substr(0, bytes.size() - 1));
    EXPECT_THAT(errorOf(folder.path()), HasSubstr("correlation.bin"));
    std::string fewer = bytes;
    fewer[12] = 1;  // components, fewer than rows
    folder.write("correlation.bin", fewer);
    EXPECT_THAT(errorOf(folder.path()), HasSubstr("correlation.bin"));
    bytes[16] = 3;  // rows that the file does not have
    folder.write("correlation.bin", bytes);
    EXPECT_THAT(errorOf(folder.path()), HasSubstr("correlation.bin"));
}

TEST(RunFolder, namesFileAndLineOfABrokenRow) {
    const TemporaryFolder folder;
    test::writeRun(folder);
    folder.write(
        "steps.csv",
        "t,landmarks,tracks,ms_predict,ms_detect,ms_update\n1000.0,many,0,1,1,1\n1001.0,1,0,1,1,1\n");
    EXPECT_THAT(errorOf(folder.path()), HasSubstr("steps.csv:2"));
}

}  // namespace run_folder_test
}  // namespace slamot::report
