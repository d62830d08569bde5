#include <gmock/gmock.h>

#include <cmath>

#include "OverviewView.h"
#include "slamot/core/data/Angle.h"
#include "slamot/report/Overview.h"

namespace slamot::report {
namespace overview_test {

using ::testing::HasSubstr;

SourceId source(std::int64_t value) {
    SourceId id;
    id.value = value;
    return id;
}

/// Three steps along x, 0.3 m and 0.4 m off in y at the second and third; a track that is absent at the
/// second.
eval::RunRecord shortRun() {
    eval::RunRecord run;
    const double error[] = {0, 0.3, 0.4};
    for (int k = 0; k < 3; ++k) {
        eval::RobotRow row;
        row.stamp = Stamp::fromSeconds(1000 + k * 0.05);
        row.robot.mean = {1.0 * k, error[k], 0};
        row.robot.covariance.diagonal() << 0.01, 0.04, 0.001;
        run.trajectory.push_back(row);
        if (k != 1) {
            TrackEstimate track;
            track.id.value = 7;
            track.source = source(3);
            track.mean.head<2>() << k, 5;
            run.tracks[row.stamp].push_back(track);
        }
    }
    return run;
}

Truth truthOf(const eval::RunRecord& run) {
    Truth truth;
    for (std::size_t k = 0; k < run.trajectory.size(); ++k) {
        truth.robot.push_back({run.trajectory[k].stamp, {1.0 * static_cast<double>(k), 0, 0}});
        TrueTarget target;
        target.stamp = run.trajectory[k].stamp;
        target.position << k, 5.1;
        truth.targets[source(3)].push_back(target);
    }
    truth.landmarks[source(0)] = {1, 2};
    return truth;
}

template <class LayerType>
const LayerType* layerNamed(const Panel& panel, const std::string& label) {
    for (const Layer& layer : panel.layers) {
        const LayerType* l = std::get_if<LayerType>(&layer);
        if (l && l->label == label) {
            return l;
        }
    }
    return nullptr;
}

TEST(Overview, showsRobotTrackAndTruth) {
    const eval::RunRecord run = shortRun();
    const Truth truth = truthOf(run);
    const Figure figure = overviewFigure(run, &truth);
    // sqrt((0 + 0.09 + 0.16) / 3) = 0.2887
    EXPECT_THAT(figure.subtitle, HasSubstr("RMSE 0.289 m"));
    ASSERT_EQ(figure.panels.size(), 2u);
    const Panel& map = figure.panels[0];
    EXPECT_TRUE(map.equal_aspect);
    ASSERT_TRUE(layerNamed<Line>(map, "Robot, estimated"));
    EXPECT_EQ(layerNamed<Line>(map, "Robot, estimated")->points.size(), 3u);
    ASSERT_TRUE(layerNamed<Line>(map, "Robot, true"));
    EXPECT_EQ(layerNamed<Points>(map, "Start")->points, (Points2{{0, 0}}));
    const Line* track = layerNamed<Line>(map, "Track 7 (object 3)");
    ASSERT_TRUE(track);
    ASSERT_EQ(track->points.size(), 3u);
    EXPECT_TRUE(std::isnan(track->points[1].x()));  // absent: a gap
}

/// The robot turns to the left by a quarter between its first two steps. Truth is measured 2 m ahead of its
/// origin and knows no heading.
TEST(Overview, truthMeasuredAtAPointIsDrawnAtTheOrigin) {
    eval::RunRecord run = shortRun();
    run.trajectory[1].robot.mean.theta = run.trajectory[2].robot.mean.theta = pi / 2;
    Truth truth;
    truth.point = {2, 0};
    truth.max_interpolation_gap = 1;
    // Ahead of (0, 0), of (1, 0) and of (2, 0); one more in the middle of the turn, where it looks to 45
    // degrees.
    const double half = std::sqrt(0.5);
    const Vector2 measured[] = {{2, 0}, {0.5 + 2 * half, 2 * half}, {1, 2}, {2, 2}};
    const double t[] = {1000, 1000.025, 1000.05, 1000.1};
    for (int k = 0; k < 4; ++k) {
        truth.robot.push_back({Stamp::fromSeconds(t[k]), {measured[k].x(), measured[k].y(), std::nan("")}});
    }
    const Figure figure = overviewFigure(run, &truth);
    const Line* way = layerNamed<Line>(figure.panels[0], "Robot, true");
    ASSERT_TRUE(way);
    ASSERT_EQ(way->points.size(), 4u);
    const Vector2 expected[] = {{0, 0}, {0.5, 0}, {1, 0}, {2, 0}};
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_NEAR((way->points[k] - expected[k]).norm(), 0, 1e-12) << k;  // rounding
    }
    // What is seen is what counts: the distance between both lines is the error.
    const Line& error = std::get<Line>(figure.panels.at(1).layers.at(1));
    EXPECT_NEAR(error.points[1].y(), 0.3, 1e-12);
    EXPECT_NEAR(error.points[2].y(), 0.4, 1e-12);
}

TEST(Overview, theBoundIsThreeSigmaOfTheWidestAxis) {
    const eval::RunRecord run = shortRun();
    const Truth truth = truthOf(run);
    const Panel panel = overviewFigure(run, &truth).panels.at(1);
    const Band& band = std::get<Band>(panel.layers.at(0));
    EXPECT_NEAR(band.rows[0].high, 0.6, 1e-12);  // 3 sqrt(0.04)
    const Line& error = std::get<Line>(panel.layers.at(1));
    EXPECT_NEAR(error.points[2].y(), 0.4, 1e-12);
    EXPECT_NEAR(error.points[2].x(), 0.1, 1e-12);
}

TEST(Overview, withoutTruthOnlyTheMap) {
    const Figure figure = overviewFigure(shortRun(), nullptr, {"My run", "my words"});
    EXPECT_EQ(figure.panels.size(), 1u);
    EXPECT_EQ(figure.title, "My run");
    EXPECT_EQ(figure.subtitle, "my words");
    EXPECT_FALSE(layerNamed<Line>(figure.panels[0], "Robot, true"));
}

TEST(Overview, unknownCovarianceHasNoBound) {
    eval::RunRecord run = shortRun();
    for (eval::RobotRow& row : run.trajectory) {
        row.robot.covariance.setZero();
    }
    const Truth truth = truthOf(run);
    EXPECT_EQ(overviewFigure(run, &truth).panels.at(1).layers.size(), 1u);
}

TEST(Overview, anEmptyRunIsAnEmptyMap) {
    const Figure figure = overviewFigure({}, nullptr);
    EXPECT_LT(*figure.panels.at(0).x.min, *figure.panels.at(0).x.max);
}

TEST(OverviewView, farLandmarksDoNotShrinkTheView) {
    std::vector<MapObject> landmarks;
    for (int i = 0; i < 98; ++i) {
        landmarks.push_back({{0.1 * i, 5}});  // 0 to 9.7 m
    }
    landmarks.push_back({{11, 0}});  // of the furthest 2 % too, but near enough to stay
    landmarks.push_back({{0, -1e6}});
    const MapView view = mapView({{0, 0}, {10, 10}}, landmarks);
    EXPECT_EQ(view.outside, 1u);
    EXPECT_EQ(view.low, Eigen::Vector2d(0, 0));
    EXPECT_EQ(view.high, Eigen::Vector2d(11, 10));
}

TEST(OverviewView, ordinaryLandmarksAllStayInView) {
    std::vector<MapObject> landmarks;
    for (int i = 0; i < 100; ++i) {
        landmarks.push_back({{0.1 * i, 12 - 0.1 * i}});
    }
    const MapView view = mapView({{0, 0}, {10, 10}}, landmarks);
    EXPECT_EQ(view.outside, 0u);
    EXPECT_NEAR(view.high.y(), 12, 1e-12);
}

TEST(OverviewView, whatDefinesTheViewLiesWithinIt) {
    // 0.1 and 0.7 have no exact middle: a view made from the middle and half the size could miss its own
    // corners.
    for (int i = 1; i < 50; ++i) {
        EXPECT_EQ(mapView({}, {{{0.1 * i, -0.3 * i}}, {{70.7 * i, 90.1 * i}}}).outside, 0u) << i;
    }
}

TEST(OverviewView, ellipsesAreWholeUnlessTheyAreHuge) {
    const Eigen::Matrix2d small = Eigen::Vector2d(0.01, 0.04).asDiagonal();  // 3 sigma: 0.3 and 0.6 m
    const Eigen::Matrix2d huge = 100 * Eigen::Matrix2d::Identity();
    const Points2 way = {{0, 0}, {10, 10}};
    const MapView with_small = mapView(way, {mapObject({0, 10}, small)});
    EXPECT_NEAR(with_small.low.x(), -0.3, 1e-12);
    EXPECT_NEAR(with_small.high.y(), 10.6, 1e-12);
    EXPECT_EQ(with_small.low.y(), 0);
    const MapView with_huge = mapView(way, {mapObject({0, 10}, huge)});
    EXPECT_NEAR(with_huge.low.x(), -1, 1e-12);  // a tenth of the 10 m
    EXPECT_NEAR(with_huge.high.y(), 11, 1e-12);
}

TEST(OverviewView, aStandingRobotHasRoomAroundIt) {
    const MapView view = mapView({{2, 3}, {2, 3}}, {});
    EXPECT_EQ(view.low, Eigen::Vector2d(1.5, 2.5));
    EXPECT_EQ(view.high, Eigen::Vector2d(2.5, 3.5));
}

}  // namespace overview_test
}  // namespace slamot::report
