// Series of a run of three steps, by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "slamot/core/config/Config.h"
#include "slamot/core/data/Angle.h"
#include "slamot/study/Series.h"
#include "support/Expect.h"

namespace slamot::study {
namespace series_test {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;

Stamp at(double seconds) {
    return Stamp::fromSeconds(100 + seconds);
}

TrackEstimate track(std::int64_t source, const Vector2& position, double variance, double existence,
                    const std::vector<double>& modes = {}) {
    TrackEstimate one;
    one.source = SourceId{source};
    one.mean.head<2>() = position;
    one.covariance.topLeftCorner<2, 2>() = variance * Matrix2::Identity();
    one.existence = existence;
    one.mode_probabilities = modes;
    return one;
}

class SeriesTest : public testing::Test {
  protected:
    eval::RunRecord record;
    Truth truth;
    LandmarkHistory landmarks{{"landmark_error_by_age"}};

    SeriesTest() {
        for (int k = 0; k < 3; ++k) {
            PoseGaussian robot;
            robot.mean = {k + 0.3, 0.4, 3.0};
            robot.covariance = Vector3(0.09, 0.16, 0.25).asDiagonal();
            record.trajectory.push_back({at(k), robot});
            truth.robot.push_back({at(k), {static_cast<double>(k), 0, -3.0}});
            TrueTarget target;
            target.stamp = at(k);
            target.position = {10, 0};
            truth.targets[SourceId{4}].push_back(target);
            truth.targets[SourceId{9}].push_back(target);
        }
        record.mode_names = {"cv", "ca"};
        truth.landmarks[SourceId{7}] = {5, 5};
        truth.landmarks[SourceId{8}] = {-5, 5};
        // Landmark 7 is seen three times with errors 3, 2, 1 m, 8 twice with 4 and 0 m, 6 has no truth.
        see(0, 0, {sight(7, 0, {8, 5}), sight(6, 0, {0, 0})});
        see(1, 2, {sight(7, 0, {5, 7}), sight(8, 1, {-5, 1})});
        see(2, 5, {sight(7, 0, {4, 5}), sight(8, 1, {-5, 5})});
    }
    static LandmarkEstimate sight(std::int64_t source, double first_seen, const Vector2& mean) {
        LandmarkEstimate landmark;
        landmark.source = SourceId{source};
        landmark.first_seen = at(first_seen);
        landmark.mean = mean;
        return landmark;
    }
    static run::Step step(double seconds, int count, const std::vector<LandmarkEstimate>& touched) {
        run::Step step;
        step.estimate.stamp = at(seconds);
        step.estimate.landmark_count = count;
        step.touched = touched;
        return step;
    }
    void see(double seconds, int count, const std::vector<LandmarkEstimate>& touched) {
        landmarks.step(step(seconds, count, touched));
    }
    std::map<std::string, Series> series(const std::vector<std::string>& names) const {
        return seriesOf(names, record, landmarks, &truth);
    }
};

TEST_F(SeriesTest, OfTheRobot) {
    const auto all = series({"robot_error", "heading_error", "robot_nees", "landmark_count"});
    EXPECT_EQ(all.at("robot_error").seconds, (std::vector<double>{0, 1, 2}));
    for (const double value : all.at("robot_error").value) EXPECT_NEAR(value, 0.5, 1e-12);
    // 3 - (-3) = 6, wrapped: 6 - 2 pi.
    for (const double value : all.at("heading_error").value) EXPECT_NEAR(value, 6 - 2 * pi, 1e-12);
    // 0.3^2/0.09 + 0.4^2/0.16 + (6 - 2 pi)^2/0.25
    for (const double value : all.at("robot_nees").value)
        EXPECT_NEAR(value, 2 + 4 * (6 - 2 * pi) * (6 - 2 * pi), 1e-9);
    EXPECT_EQ(all.at("robot_nees").dimension, (std::vector<double>{3, 3, 3}));
    EXPECT_EQ(all.at("landmark_count").value, (std::vector<double>{0, 2, 5}));
    EXPECT_TRUE(all.at("landmark_count").dimension.empty());
}

TEST_F(SeriesTest, OfTheLandmarksByAge) {
    const Series one = series({"landmark_error_by_age"}).at("landmark_error_by_age");
    EXPECT_EQ(one.seconds, (std::vector<double>{0, 1, 2}));
    EXPECT_THAT(one.value, ElementsAre(DoubleEq(std::sqrt((9.0 + 16) / 2)),
                                       DoubleEq(std::sqrt((4.0 + 0) / 2)), DoubleEq(1)));
}

TEST_F(SeriesTest, SightsAreKeptOnlyWhereASeriesWantsThem) {
    LandmarkHistory other({"robot_error"});
    other.step(step(0, 3, {sight(7, 0, {8, 5})}));
    EXPECT_TRUE(other.sights().empty());
    EXPECT_EQ(other.counts().at(at(0)), 3);
}

TEST_F(SeriesTest, TheTargetIsTheOneOfLowestId) {
    record.tracks[at(1)] = {track(9, {0, 0}, 1, 1.0), track(4, {10, 3}, 4, 0.5), track(4, {10, 1}, 4, 0.9)};
    record.tracks[at(2)] = {track(9, {0, 0}, 1, 1.0)};
    const auto all = series({"target_error", "target_nees"});
    EXPECT_THAT(all.at("target_error").seconds, ElementsAre(1));
    EXPECT_THAT(all.at("target_error").value, ElementsAre(DoubleEq(1)));
    EXPECT_THAT(all.at("target_nees").value, ElementsAre(DoubleEq(0.25)));
    EXPECT_THAT(all.at("target_nees").dimension, ElementsAre(2));
}

TEST_F(SeriesTest, WithoutSourcesTheLikeliestTrackIsTheTargets) {
    record.tracks[at(0)] = {track(-1, {10, 2}, 1, 0.4, {0.9, 0.1}), track(-1, {10, 1}, 1, 0.8, {0.3, 0.7})};
    const auto all = series({"target_error", "p_ca", "p_ct"});
    EXPECT_THAT(all.at("target_error").value, ElementsAre(DoubleEq(1)));
    EXPECT_THAT(all.at("p_ca").value, ElementsAre(0.7));
    EXPECT_EQ(all.count("p_ct"), 0u);  // an estimator without that mode has no such series
}

TEST_F(SeriesTest, WithoutTruthOnlyWhatNeedsNone) {
    const auto all = seriesOf({"robot_error", "target_error", "landmark_count", "landmark_error_by_age"},
                              record, landmarks, nullptr);
    EXPECT_EQ(all.size(), 1u);
    EXPECT_EQ(all.count("landmark_count"), 1u);
}

TEST_F(SeriesTest, OnlyNeesHasDimensions) {
    record.tracks[at(1)] = {track(4, {10, 1}, 4, 0.9, {0.5, 0.5})};
    const auto all = series({"robot_nees", "robot_error", "heading_error", "target_error", "target_nees",
                             "landmark_count", "landmark_error_by_age", "p_cv"});
    EXPECT_EQ(all.size(), 8u);
    for (const auto& [name, one] : all) {
        EXPECT_FALSE(one.value.empty()) << name;
        EXPECT_EQ(one.dimension.size(), isNeesSeries(name) ? one.value.size() : 0u) << name;
    }
    EXPECT_TRUE(isNeesSeries("target_nees"));
    EXPECT_FALSE(isNeesSeries("p_nees"));
}

TEST_F(SeriesTest, UnknownNamesAreMistakes) {
    EXPECT_NO_THROW(requireKnownSeries({"robot_nees", "p_cv"}, "a.ini:3"));
    const std::string told =
        test::messageOf<ConfigError>([] { requireKnownSeries({"target_eror"}, "a.ini:3"); });
    EXPECT_THAT(told, HasSubstr("a.ini:3: no series 'target_eror' (did you mean 'target_error'?)"));
    EXPECT_THAT(told, HasSubstr("landmark_count"));
    EXPECT_THROW(requireKnownSeries({"p_"}, "a.ini:3"), ConfigError);
}

}  // namespace series_test
}  // namespace slamot::study
