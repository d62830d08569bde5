// What a page shows of particles, and of landmarks whose existence is in doubt.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "report/RunFiles.h"
#include "sections/ReplayData.h"
#include "sections/ReplayScene.h"
#include "sections/Sections.h"
#include "slamot/report/ReportSection.h"

namespace slamot::report {
namespace particles_test {

using nlohmann::json;
using ::testing::HasSubstr;

class Particles : public ::testing::Test {
  protected:
    Particles() { test::writeRun(folder_); }
    RunFolder run() const { return readRunFolder(folder_.path(), "none"); }
    /// The data of a layer of the replay; null where there is none.
    json layer(const std::string& id) const {
        const json data = json::parse(replayOf(run()).data);
        for (const json& layer : data.at("layers")) {
            if (layer.at("id") == id) {
                return layer.at("data");
            }
        }
        return nullptr;
    }
    PageFigure figure() const { return std::get<PageFigure>(particle_section.blocks(run()).at(0)); }
    void writeParticles(const std::string& rows) const {
        folder_.write("particles.csv", "t,particle,weight,x,y,theta\n" + rows);
    }
    void writeTentative(const std::string& rows) const {
        folder_.write("tentative.csv", "t,id,x,y,c_xx,c_xy,c_yy,existence,moving,source_id\n" + rows);
    }

    test::TemporaryFolder folder_;
};

/// Around x, on both sides of +-pi; then with other weights; then two of them and a copy of each.
const char* four_particles =
    "1000.0000000,0,0.25,0,1,3.0415926535897931\n"
    "1000.0000000,1,0.25,0,-1,-3.0415926535897931\n"
    "1000.0000000,2,0.25,0,1,-3.0415926535897931\n"
    "1000.0000000,3,0.25,0,-1,3.0415926535897931\n"
    "1001.0000000,0,0.5,1,0,0\n"
    "1001.0000000,1,0.25,1,1,0\n"
    "1001.0000000,2,0.125,1,2,0\n"
    "1001.0000000,3,0.125,1,3,0\n"
    "1002.0000000,0,0.25,2,0,0\n"
    "1002.0000000,1,0.25,2,0,0\n"
    "1002.0000000,2,0.25,2,1,0\n"
    "1002.0000000,3,0.25,2,1,0\n";

TEST_F(Particles, copiesCountAsOneInTheEffectiveNumber) {
    writeParticles(four_particles);
    const PageFigure shown = figure();
    ASSERT_EQ(shown.figure.panels.size(), 3u);
    // 4, 1 / (1/4 + 1/16 + 2/64) and 2 fall into one window.
    const auto& layers = shown.figure.panels[0].layers;
    EXPECT_NEAR(std::get<Line>(layers.at(1)).points.at(0).y(), 64.0 / 22, 1e-12);
    EXPECT_NEAR(std::get<Line>(layers.at(2)).points.at(0).y(), 2, 1e-12);
    EXPECT_EQ(shown.caption, "Of 4 particles the median effective number is 2.9, the lowest 2.0.");
}

TEST_F(Particles, theirSpreadIsThatOfTheirPoses) {
    writeParticles(four_particles);
    const Figure shown = figure().figure;
    const auto& position = std::get<Line>(shown.panels.at(1).layers.at(0)).points;
    const auto& heading = std::get<Line>(shown.panels.at(2).layers.at(0)).points;
    EXPECT_NEAR(position.at(0).y(), 1, 1e-12);
    EXPECT_NEAR(heading.at(0).y(), 0.1 * 180 / pi, 1e-9);
    // 0, 1, 2, 3 with mean 7/8: 1/4 + 4/8 + 9/8 - 49/64.
    EXPECT_NEAR(position.at(1).y(), std::sqrt(120.0 / 64 - 49.0 / 64), 1e-12);
    EXPECT_NEAR(heading.at(1).y(), 0, 1e-12);
}

TEST_F(Particles, thePageSaysThatTheFileHasFewer) {
    writeParticles("1000.0000000,3,0.5,0,0,0\n1000.0000000,8,0.5,0,1,0\n1001.0000000,9,1,0,0,0\n");
    EXPECT_THAT(figure().caption, HasSubstr("Of 10 particles"));
    EXPECT_THAT(figure().caption, HasSubstr("2 of them at a stamp"));
}

TEST_F(Particles, withoutThemThereIsNoSectionAndNoLayer) {
    EXPECT_THAT(particle_section.why_absent(run()), HasSubstr("particles.csv"));
    EXPECT_TRUE(layer("particles").is_null());
    writeParticles("");  // of an estimator without particles
    EXPECT_THAT(particle_section.why_absent(run()), HasSubstr("particles.csv"));
    EXPECT_TRUE(layer("particles").is_null());
}

TEST_F(Particles, theReplayHasThemAroundTheRobotOfTheFrame) {
    // The robot is at (1, 0.1) at the second frame; nothing is known of the third.
    writeParticles(
        "1000.0000000,0,1,0.25,0,1\n"
        "1001.0000000,0,0.75,1.5,0.1,-0.5\n"
        "1001.0000000,1,0.25,1,-0.4,0.25\n"
        "1003.0000000,0,1,3,0.3,0\n");
    const json particles = layer("particles");
    EXPECT_EQ(particles.at("first"), json({0, 1, 3, 3, 4}));
    const double unit = particles.at("unit");
    EXPECT_NEAR(particles.at("x")[1].get<double>() * unit, 0.5, unit);
    EXPECT_NEAR(particles.at("y")[2].get<double>() * unit, -0.5, unit);
    EXPECT_EQ(particles.at("theta"), json({100, -50, 25, 0}));
    EXPECT_EQ(particles.at("weight"), json({9, 9, 3, 9}));
}

TEST_F(Particles, ofVeryManySomeAreDrawnAndItIsSaid) {
    std::string rows;
    for (int i = 0; i < 30000; ++i) {
        rows += fmt::format("1000.0000000,{},{},{},0,0\n", i, 1.0 / 30000, i);
    }
    writeParticles(rows);
    EXPECT_EQ(layer("particles").at("first"),
              json({0, 25000, 25000, 25000, 25000}));  // 100,000 over four frames
    EXPECT_THAT(replayOf(run()).note, HasSubstr("Of 30000 particles 25000 are drawn, chosen by weight."));
}

TEST_F(Particles, whatMayBeALandmarkStaysWhileItLooksTheSame) {
    writeTentative(
        "1000.0000000,4,2,3,1,0,1,0.25,0,-1\n"
        "1000.0000000,-1,7,3,1,0,1,0.25,0,-1\n"
        "1001.0000000,4,2,3,1,0,1,0.27,0,-1\n"
        "1001.0000000,-1,7,3,1,0,1,0.25,0,-1\n"
        "1002.0000000,4,2,4,1,0,1,0.27,0,-1\n"
        "1003.0000000,4,2,4,1,0,1,0.75,0,-1\n");
    const json tentative = layer("tentative");
    // Those without an id are told anew at each frame.
    EXPECT_EQ(tentative.at("from"), json({0, 0, 1, 2, 3}));
    EXPECT_EQ(tentative.at("to"), json({2, 1, 2, 3, 4}));
    EXPECT_EQ(tentative.at("x"), json({2.0, 7.0, 7.0, 2.0, 2.0}));
    EXPECT_EQ(tentative.at("y"), json({3.0, 3.0, 3.0, 4.0, 4.0}));
    EXPECT_EQ(tentative.at("existence"), json({25, 25, 25, 27, 75}));
    std::filesystem::remove(folder_.path() + "/tentative.csv");
    EXPECT_TRUE(layer("tentative").is_null());
}

TEST_F(Particles, landmarksHaveTheirExistenceWhereOneIsInDoubt) {
    EXPECT_FALSE(layer("landmarks").contains("existence"));
    folder_.write("landmarks_history.csv",
                  "t,id,x,y,c_xx,c_xy,c_yy,existence,moving,source_id\n"
                  "1000.0000000,1,5,5.5,0.04,0,0.09,0.625,0,10\n"
                  "1001.0000000,1,5,5.5,0.04,0,0.09,0.65,0,10\n"
                  "1002.0000000,1,5,5.5,0.04,0,0.09,0.75,0,10\n"
                  "1003.0000000,1,5,5.5,0.04,0,0.09,0.75,0,10\n");
    const json landmarks = layer("landmarks");
    EXPECT_EQ(landmarks.at("frame"), json({0, 2, 3}));  // first, seen to change, last
    EXPECT_EQ(landmarks.at("existence"), json({63, 75, 75}));
    folder_.write("landmarks_history.csv",
                  "t,id,x,y,c_xx,c_xy,c_yy,source_id\n1000.0000000,1,5,5.5,0.04,0,0.09,10\n");
    EXPECT_FALSE(layer("landmarks").contains("existence"));  // of an earlier version: all certain
}

}  // namespace particles_test
}  // namespace slamot::report
