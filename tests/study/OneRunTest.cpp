// Figures of one run: what is drawn is what the run gave.
#include "../../libs/study/src/OneRun.h"
#include "slamot/report/Figure.h"
#include "slamot/study/Figures.h"
#include "study/StudyFolder.h"
#include "support/Expect.h"

namespace slamot::study {
namespace {

using testing::HasSubstr;

class OneRunTest : public StudyFolder {
  protected:
    OneRunTest() {
        folder.write(
            "chase.ini",
            "[scenario]\ndt = 0.2\nsteps = 60\n"
            "[world]\nlandmarks = 12\nbox = -10,30,-20,20\n"
            "[robot]\ncontroller = constant\nspeed = 2\nmotion = steered\nwheelbase = 2\nspeed_std = 0.2\n"
            "[mover.0]\nmodel = cv\nposition = 5,3\nvelocity = 3,0\n"
            "[sensor.landmarks]\nmax_range = 25\nrange_std = 0.1\nbearing_std_deg = 1\n"
            "[sensor.movers]\nmax_range = 60\nrange_std = 0.1\nbearing_std_deg = 1\n");
    }
    static std::string text(const std::string& figure) {
        return "[study]\nseed = 4\nreplicates = 2\n"
               "[scenario.chase]\nfile = chase.ini\n"
               "[config.classic]\nfile = ekf.ini\nekf_slamot.consistency = classic\n"
               "[config.invariant]\nfile = ekf.ini\n"
               "[config.odometry]\nfile = ekf.ini\nrun.estimator = dead_reckoning\n" +
               figure;
    }
    static std::string figureText(const std::string& show, const std::string& more = "config = invariant\n") {
        return "[figure.f]\nkind = one_run\nsource = chase\ntitle = T\nshow = " + show + "\n" + more;
    }
    report::Figure figure(const std::string& show, const std::string& more = "config = invariant\n") const {
        const Plan plan = this->plan(text(figureText(show, more)));
        const Analysis analysis = readAnalysis(plan.study);
        return makeFigure(analysis.plots.at(0), {plan.study, analysis, {}, &plan});
    }
};

template <class LayerKind>
std::vector<LayerKind> layersOf(const report::Panel& panel) {
    std::vector<LayerKind> found;
    for (const report::Layer& layer : panel.layers)
        if (const auto* one = std::get_if<LayerKind>(&layer)) found.push_back(*one);
    return found;
}

TEST_F(OneRunTest, IsTheRunOfTheRows) {
    const Plan plan = this->plan(text(""));
    const std::vector<Row> rows = run(plan);
    for (const Row& row : rows) {
        const auto again = runAgain(plan, {row.source, row.variant, row.replicate});
        ASSERT_TRUE(again);
        EXPECT_EQ(again->key, row.key);
        EXPECT_EQ(again->estimate_hash, row.estimate_hash);
    }
    EXPECT_EQ(rows.size(), 6u);
    EXPECT_FALSE(runAgain(plan, {"chase", "classic", 3})) << "the study has two worlds";
}

TEST_F(OneRunTest, ErrorsAreEstimateMinusTruth) {
    const auto run = runAgain(plan(text("")), {"chase", "invariant", 1});
    const eval::RobotRow& last = run->record.trajectory.back();
    const Pose2 truth = *run->truth->robotAt(last.stamp);
    const report::Figure robot = figure("robot");
    EXPECT_EQ(robot.title, "T");
    ASSERT_EQ(robot.panels.size(), 4u);
    EXPECT_EQ(layersOf<report::Line>(robot.panels[0]).back().points.back(), last.robot.mean.position());
    const double errors[] = {last.robot.mean.x - truth.x, last.robot.mean.y - truth.y};
    for (std::size_t k = 0; k < 2; ++k) {
        const report::Line error = layersOf<report::Line>(robot.panels[k + 1]).at(0);
        EXPECT_DOUBLE_EQ(error.points.back().y(), errors[k]);
        EXPECT_DOUBLE_EQ(error.points.back().x(), 12);
        EXPECT_DOUBLE_EQ(layersOf<report::Band>(robot.panels[k + 1]).at(0).rows.back().high,
                         3 * std::sqrt(last.robot.covariance(static_cast<int>(k), static_cast<int>(k))));
    }

    const TrackEstimate& track = run->record.tracks.rbegin()->second.at(0);
    const Vector2 target = run->truth->targetAt(track.source, run->record.tracks.rbegin()->first)->position;
    const report::Figure chased = figure("target");
    ASSERT_EQ(chased.panels.size(), 3u);
    EXPECT_DOUBLE_EQ(layersOf<report::Line>(chased.panels[2]).at(0).points.back().y(),
                     track.mean.y() - target.y());
}

TEST_F(OneRunTest, LandmarksFromTheirFirstSightToTheEnd) {
    const auto run = runAgain(plan(text("")), {"chase", "invariant", 1});
    const report::Panel panel = figure("landmark_errors").panels.at(0);
    const auto lines = layersOf<report::Line>(panel);
    ASSERT_EQ(lines.size(), 7u);
    const auto dots = layersOf<report::Points>(panel).at(0).points;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        EXPECT_EQ(lines[i].points.front(), dots.at(i));
        EXPECT_DOUBLE_EQ(lines[i].points.back().x(), 12);
        bool found = false;
        for (const LandmarkEstimate& landmark : run->record.landmarks)
            if (lines[i].label == "landmark " + std::to_string(landmark.source.value)) {
                found = true;
                EXPECT_DOUBLE_EQ(lines[i].points.back().y(),
                                 (landmark.mean - run->truth->landmarks.at(landmark.source)).norm());
                EXPECT_DOUBLE_EQ(dots[i].x(),
                                 secondsBetween(run->record.trajectory.front().stamp, landmark.first_seen));
            }
        EXPECT_TRUE(found) << lines[i].label;
    }
}

TEST_F(OneRunTest, CorrelationsWithTheFirstRowAtTheTop) {
    const auto run = runAgain(plan(text("")), {"chase", "invariant", 1});
    const Eigen::MatrixXd& P = run->joint.matrix;
    const Eigen::Index n = P.rows();
    ASSERT_GT(n, 3 + 6 + 4);
    const auto r = [&](int i, int j) { return P(i, j) / std::sqrt(P(i, i) * P(j, j)); };
    const report::Panel all = figure("correlation").panels.at(0);
    const report::HeatMap map = layersOf<report::HeatMap>(all).at(0);
    ASSERT_EQ(map.values.rows(), n);
    EXPECT_DOUBLE_EQ(map.values(n - 1 - 4, 9), std::abs(r(4, 9)));
    EXPECT_DOUBLE_EQ(map.values(n - 1, 0), 1);
    const report::Panel head = figure("correlation_head").panels.at(0);
    const report::HeatMap part = layersOf<report::HeatMap>(head).at(0);
    ASSERT_EQ(part.values.rows(), 9);
    ASSERT_EQ(part.values.cols(), std::min<Eigen::Index>(n, 29));
    EXPECT_DOUBLE_EQ(part.values(8 - 2, 3), r(2, 3));
    EXPECT_EQ(head.y.categories.back(), "x");
    EXPECT_EQ(head.x.categories[9], "x1");
    EXPECT_EQ(head.x.categories.size(), static_cast<std::size_t>(part.values.cols()));
}

TEST_F(OneRunTest, TheMapHasTheWaysAndTheLandmarks) {
    const auto run = runAgain(plan(text("")), {"chase", "classic", 2});
    const report::Panel map = figure("map", "config = classic\nreplicate = 2\n").panels.at(0);
    EXPECT_EQ(layersOf<report::Ellipses>(map).at(0).gaussians.size(), run->record.landmarks.size());
    EXPECT_EQ(layersOf<report::Line>(map).back().points.back(),
              run->record.trajectory.back().robot.mean.position());
}

TEST_F(OneRunTest, WhatIsNotThereIsSaid) {
    EXPECT_EQ(figure("map", "config = classic\nreplicate = 3\n").panels.at(0).note, "no such run");
    EXPECT_EQ(figure("correlation", "config = odometry\n").panels.at(0).note,
              "the estimator has no joint covariance");
    EXPECT_EQ(figure("target", "config = odometry\n").panels.at(0).note,
              "the target has no estimate where truth is known");
}

TEST_F(OneRunTest, MistakesAreSentences) {
    const auto message = [&](const std::string& figure) {
        return test::messageOf<ConfigError>([&] { readAnalysis(load(text(figure))); });
    };
    EXPECT_THAT(message("[figure.f]\nkind = one_run\nconfig = classic\n"), HasSubstr("source"));
    EXPECT_THAT(message(figureText("map", "config = clasic\n")), HasSubstr("did you mean 'classic'"));
    EXPECT_THAT(message(figureText("maps")), HasSubstr("correlation_head"));
    EXPECT_THAT(message(figureText("map", "config = classic\nseries = robot_nees\n")), HasSubstr("series"));
}

}  // namespace
}  // namespace slamot::study
