// Which noise a detection gets: config override, then its own covariance, then what the sensor claims.
#include <gmock/gmock.h>

#include <cmath>

#include "run/Spy.h"
#include "support/Expect.h"

namespace slamot::test {
namespace noise_test {

using testing::HasSubstr;

class NoiseTest : public PipelineTest {
  protected:
    Matrix2 noiseOf(const mrpt::obs::CObservation::Ptr& observation) {
        pipeline.reset();
        spy = std::make_shared<Spy>();
        process({odometry(0, {}), observation, odometry(1, {})});
        return detectionsOf(spy->sets.at(0)).at(0).covariance;
    }
    static Matrix2 own() { return (Matrix2() << 0.09375, 0.015625, 0.015625, 0.0078125).finished(); }
};

/// Sums and squares of a few numbers.
constexpr double rounding = 1e-15;

TEST_F(NoiseTest, TheSensorsClaim) {
    EXPECT_TRUE(near(noiseOf(detections(0.5, "landmarks", {{4, 0}})),
                     Matrix2(Vector2(0.25, 0.015625).asDiagonal()), 0));  // 0.5^2, 0.125^2
}

TEST_F(NoiseTest, TheMeasurementsOwnCovarianceComesBeforeTheClaim) {
    EXPECT_TRUE(near(noiseOf(detections(0.5, "landmarks", {{4, 0, 1, own()}})), own(), 0));
}

TEST_F(NoiseTest, TheConfigComesBeforeAll) {
    config.noise.range_std = 0.75;
    // The other entry stays; a correlation of two numbers of which one has been replaced means nothing.
    EXPECT_TRUE(near(noiseOf(detections(0.5, "landmarks", {{4, 0, 1, own()}})),
                     Matrix2(Vector2(0.5625, 0.0078125).asDiagonal()), rounding));
    config.noise.bearing_std = 0.0625;
    EXPECT_TRUE(near(noiseOf(detections(0.5, "landmarks", {{4, 0}})),
                     Matrix2(Vector2(0.5625, 0.00390625).asDiagonal()), rounding));
}

TEST_F(NoiseTest, OneSensorsSectionComesBeforeThatOfAll) {
    config.noise.range_std = 0.75;
    config.noise.bearing_std = 0.0625;
    config.noise_by_label["movers"].range_std = 2;
    EXPECT_TRUE(near(noiseOf(detections(0.5, "movers", {{4, 0}})),
                     Matrix2(Vector2(4, 0.00390625).asDiagonal()), rounding));
    EXPECT_TRUE(near(noiseOf(detections(0.5, "landmarks", {{4, 0}})),
                     Matrix2(Vector2(0.5625, 0.00390625).asDiagonal()), rounding));
}

TEST_F(NoiseTest, NoisePerMetreIsAddedToTheRangesDeviation) {
    config.noise.range_std = 0.25;
    config.noise.range_std_per_m = 0.125;
    // 0.25 m + 0.125 * 4 m = 0.75 m
    EXPECT_NEAR(noiseOf(detections(0.5, "landmarks", {{4, 0}}))(0, 0), 0.5625, rounding);
    // range_std = auto: to what the log claims, 0.5 m + 0.125 * 4 m = 1 m
    config.noise.range_std.reset();
    EXPECT_NEAR(noiseOf(detections(0.5, "landmarks", {{4, 0}}))(0, 0), 1, rounding);
}

TEST_F(NoiseTest, NoNoiseAtAllIsAnErrorThatNamesTheKeyToSet) {
    const auto error = messageOf<ConfigError>([&] { noiseOf(detections(0.5, "landmarks", {{4, 0}}, 0, 0)); });
    EXPECT_THAT(error, HasSubstr("'landmarks'"));
    EXPECT_THAT(error, HasSubstr("[noise.landmarks]"));
    EXPECT_THAT(error, HasSubstr("range_std"));
    EXPECT_THAT(error, HasSubstr("bearing_std_deg"));
    // A sensor without a name has no section of its own.
    EXPECT_THAT(messageOf<ConfigError>([&] {
                    noiseOf(detections(0.5, "", {{4, 0}}, 0, 0));
                }),
                HasSubstr("[noise] of the config"));

    config.noise.range_std = 0.5;
    config.noise.bearing_std = 0.125;
    EXPECT_NEAR(noiseOf(detections(0.5, "landmarks", {{4, 0}}, 0, 0))(0, 0), 0.25, rounding);
}

TEST_F(NoiseTest, ACovarianceThatIsNoneIsAnError) {
    for (const Matrix2& broken :
         {Matrix2((Matrix2() << 1, 2, 2, 1).finished()), Matrix2((Matrix2() << -1, 0, 0, 1).finished()),
          Matrix2((Matrix2() << std::nan(""), 0, 0, 1).finished())})
        EXPECT_THAT(messageOf<ConfigError>([&] {
                        noiseOf(detections(0.5, "landmarks", {{4, 0, 1, broken}}));
                    }),
                    HasSubstr("[noise.landmarks]"));
}

}  // namespace noise_test
}  // namespace slamot::test
