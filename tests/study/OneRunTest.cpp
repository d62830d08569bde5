// Figures of one run: what is drawn is what the run gave.
#include "../../libs/study/src/OneRunFigure.h"
#include "slamot/study/Figures.h"
#include "slamot/study/OneRun.h"
#include "study/StudyFolder.h"
#include "support/Expect.h"

namespace slamot::study {
namespace one_run_test {

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
        return figureOf(plan(text(figureText(show, more))), {});
    }
    static report::Figure figureOf(const Plan& plan, const std::vector<Row>& rows) {
        const Analysis analysis = readAnalysis(plan.study);
        OneRuns runs(plan, registry());
        return makeFigure(analysis.plots.at(0), {plan.study, analysis, rows, &plan, &runs});
    }
    static OneRun runAgain(const Plan& plan, const OneRunChoice& choice) {
        const auto index = findRun(plan, choice);
        if (!index) throw std::out_of_range("no such run");
        return OneRuns(plan, registry()).again(*index);
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
        EXPECT_EQ(again.key, row.key);
        EXPECT_EQ(again.estimate_hash, row.estimate_hash);
        EXPECT_EQ(again.status, "complete");
    }
    EXPECT_EQ(rows.size(), 6u);
    EXPECT_FALSE(findRun(plan, {"chase", "classic", 3})) << "the study has two worlds";
}

TEST_F(OneRunTest, ErrorsAreEstimateMinusTruth) {
    const auto run = runAgain(plan(text("")), {"chase", "invariant", 1});
    const eval::RobotRow& last = run.record.trajectory.back();
    const Pose2 truth = *run.truth->robotAt(last.stamp);
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

    const TrackEstimate& track = run.record.tracks.rbegin()->second.at(0);
    const Vector2 target = run.truth->targetAt(track.source, run.record.tracks.rbegin()->first)->position;
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
        for (const LandmarkEstimate& landmark : run.record.landmarks)
            if (lines[i].label == "landmark " + std::to_string(landmark.source.value)) {
                found = true;
                EXPECT_DOUBLE_EQ(lines[i].points.back().y(),
                                 (landmark.mean - run.truth->landmarks.at(landmark.source)).norm());
                EXPECT_DOUBLE_EQ(dots[i].x(),
                                 secondsBetween(run.record.trajectory.front().stamp, landmark.first_seen));
            }
        EXPECT_TRUE(found) << lines[i].label;
    }
}

TEST_F(OneRunTest, CorrelationsWithTheFirstRowAtTheTop) {
    const auto run = runAgain(plan(text("")), {"chase", "invariant", 1});
    const Eigen::MatrixXd& P = run.joint.matrix;
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
    EXPECT_EQ(layersOf<report::Ellipses>(map).at(0).gaussians.size(), run.record.landmarks.size());
    EXPECT_EQ(layersOf<report::Line>(map).back().points.back(),
              run.record.trajectory.back().robot.mean.position());
}

TEST_F(OneRunTest, WhatIsNotThereIsSaid) {
    EXPECT_EQ(figure("map", "config = classic\nreplicate = 3\n").panels.at(0).note, "no such run");
    EXPECT_EQ(figure("correlation", "config = odometry\n").panels.at(0).note,
              "the estimator has no joint covariance");
    EXPECT_EQ(figure("target", "config = odometry\n").panels.at(0).note,
              "the target has no estimate where truth is known");
}

TEST_F(OneRunTest, TheLastRunIsKept) {
    const Plan plan = this->plan(text(""));
    const RunIndex first = *findRun(plan, {"chase", "invariant", 1}),
                   second = *findRun(plan, {"chase", "invariant", 2});
    OneRuns runs(plan, registry());
    // A run made again is there before the old one goes: it cannot stand at the same place.
    const void* place = runs.again(first).record.trajectory.data();
    EXPECT_EQ(runs.again(first).record.trajectory.data(), place);
    EXPECT_EQ(runs.again(second).key,
              plan.keyOf(plan.worlds[second.first], plan.runsOf(plan.worlds[second.first])[second.second]));
    const std::string key = runs.again(first).key;
    EXPECT_NE(key, runs.again(second).key);
}

TEST_F(OneRunTest, StopsWhereItIsToldTo) {
    const Plan plan = this->plan(text(""));
    const RunIndex index = *findRun(plan, {"chase", "invariant", 1});
    std::atomic<bool> stop{false};
    OneRuns runs(plan, registry(), &stop);
    runs.again(index);
    stop = true;
    EXPECT_THAT(test::messageOf<std::runtime_error>([&] { runs.again(index); }),
                HasSubstr("stopped while a run was made again"));
}

TEST_F(OneRunTest, AFailedRowIsANoteAndIsNotRunAgain) {
    const Plan plan = this->plan(text(figureText("map")));
    std::vector<Row> rows = run(plan);
    EXPECT_EQ(figureOf(plan, rows).subtitle, "");
    for (Row& row : rows)
        if (row.variant == "invariant" && row.replicate == 1)
            row.status = "failed", row.reason = "the filter's covariance is not finite";
    const report::Figure failed = figureOf(plan, rows);
    EXPECT_EQ(failed.title, "T");
    ASSERT_EQ(failed.panels.size(), 1u);
    EXPECT_EQ(failed.panels[0].note, "the run failed: the filter's covariance is not finite");
    EXPECT_TRUE(failed.panels[0].layers.empty());
}

TEST_F(OneRunTest, RowsThatAreOfAnotherRunAreSaid) {
    const Plan plan = this->plan(text(figureText("map")));
    std::vector<Row> rows = run(plan);
    for (Row& row : rows) row.estimate_hash = "another";
    EXPECT_EQ(figureOf(plan, rows).subtitle, "not as in the rows: another build");
    EXPECT_EQ(figureOf(plan, {}).subtitle, "not among the rows");
    rows.erase(
        std::remove_if(rows.begin(), rows.end(), [](const Row& r) { return r.variant == "invariant"; }),
        rows.end());
    EXPECT_EQ(figureOf(plan, rows).subtitle, "not among the rows");
}

TEST_F(OneRunTest, ARunThatFailsWhenMadeAgainIsANote) {
    // Nothing but landmarks is to be seen in this field, and they have no identities.
    const Plan plan = this->plan(
        "[study]\nseed = 4\nreplicates = 1\n[scenario.field]\nfile = field.ini\n"
        "[config.blind]\nfile = ekf.ini\nidentities.landmarks = hidden\n"
        "ekf_slamot.association.landmarks = known\n"
        "[figure.f]\nkind = one_run\nsource = field\nconfig = blind\nshow = map\n");
    const std::vector<Row> rows = run(plan);
    ASSERT_EQ(rows.size(), 1u);
    ASSERT_EQ(rows[0].status, "failed");
    EXPECT_EQ(figureOf(plan, {}).panels.at(0).note, "the run failed: " + rows[0].reason);
    EXPECT_EQ(figureOf(plan, rows).panels.at(0).note, "the run failed: " + rows[0].reason);
}

/// Robot, `tracks` targets and the landmarks 1 to `landmarks`; sees each landmark first `age(id)` before its
/// end.
OneRun withJoint(std::size_t tracks, int landmarks, const std::function<double(int)>& age) {
    OneRun run;
    run.status = "complete";
    run.record.trajectory.resize(1);
    run.record.trajectory[0].stamp = Stamp{100 * 10'000'000};
    for (std::size_t t = 0; t < tracks; ++t) run.joint.tracks.push_back(TrackId{static_cast<int>(t) + 1});
    for (int id = 1; id <= landmarks; ++id) run.joint.landmarks.push_back(LandmarkId{id});
    for (int id = 1; id <= 20; ++id) {
        LandmarkEstimate landmark;
        landmark.id = LandmarkId{id};
        landmark.first_seen = Stamp{static_cast<std::int64_t>((100 - age(id)) * 1e7)};
        run.record.landmarks.push_back(landmark);
    }
    const auto n = static_cast<Eigen::Index>(3 + 6 * tracks) + 2 * landmarks;
    run.joint.matrix = Eigen::MatrixXd::Identity(n, n);
    return run;
}

report::Panel correlationOf(const OneRun& run) {
    PlotSpec spec;
    spec.kind = PlotKind::one_run;
    spec.show = OneRunShow::correlation;
    return oneRunFigure(spec, run).panels.at(0);
}

TEST(Correlation, NamesATargetOnlyWhereThereIsOne) {
    const auto old = [](int) { return 50.0; };
    const report::Panel without = correlationOf(withJoint(0, 4, old)),
                        with = correlationOf(withJoint(1, 4, old));
    EXPECT_THAT(without.x.categories, testing::Contains("robot"));
    EXPECT_THAT(without.y.categories, testing::Not(testing::Contains("target")));
    EXPECT_THAT(with.x.categories, testing::Contains("robot, target"));
    EXPECT_THAT(with.y.categories, testing::Contains("target"));
}

TEST(Correlation, CountsTheYoungAmongItsOwnLandmarks) {
    // All 20 landmarks of the map are young, two are in the joint state: 40 rows from the end would be before
    // it.
    EXPECT_THAT(correlationOf(withJoint(0, 2, [](int) { return 1.0; })).note,
                HasSubstr("7 components; 2 landmarks, 2 of them"));
    EXPECT_THAT(correlationOf(withJoint(0, 3, [](int id) { return id < 3 ? 50.0 : 1.0; })).note,
                HasSubstr("9 components; 3 landmarks, 1 of them"));
}

TEST(LandmarkErrors, CountsTheLinesDrawn) {
    OneRun run = withJoint(0, 0, [](int) { return 50.0; });
    run.record.landmarks.resize(3);
    run.truth.emplace();
    for (const int id : {1, 2, 3}) {
        run.record.landmarks[static_cast<std::size_t>(id - 1)].source = SourceId{id};
        if (id < 3) run.truth->landmarks[SourceId{id}] = Vector2(0, 0);
    }
    PlotSpec spec;
    spec.kind = PlotKind::one_run;
    spec.show = OneRunShow::landmark_errors;
    const report::Panel panel = oneRunFigure(spec, run).panels.at(0);
    EXPECT_EQ(layersOf<report::Line>(panel).size(), 2u);
    EXPECT_THAT(panel.note, HasSubstr("2 of 3 landmarks"));
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

}  // namespace one_run_test
}  // namespace slamot::study
