#include <gtest/gtest.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <cmath>
#include <limits>

#include "slamot/rawlog/Conventions.h"
#include "slamot/rawlog/LogError.h"

namespace slamot {
namespace conventions_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Conventions, StampsAreExactBothWays) {
    // The year 1601 is MRPT's zero: 11'644'473'600 s before 1970.
    EXPECT_EQ(toMrpt(Stamp{1}).time_since_epoch().count(), 11'644'473'600LL * 10'000'000 + 1);
    EXPECT_EQ(toStamp(mrpt::Clock::fromDouble(1.5)).ticks, 15'000'000);
    const Stamp odd{12'484'441'871'560'001};
    EXPECT_EQ(toStamp(toMrpt(odd)), odd);
}

TEST(Conventions, OdometryRoundTrip) {
    const OdometryReading reading{Stamp{5}, {0.1, -0.2, 3.0}, BodyVelocity{1, 2, 3}};
    const auto observation = toMrpt(reading, "wheels");
    EXPECT_EQ(observation->sensorLabel, "wheels");
    const OdometryReading back = fromMrpt(*observation);
    EXPECT_EQ(back.stamp, reading.stamp);
    EXPECT_EQ(back.pose.vector(), reading.pose.vector());
    ASSERT_TRUE(back.velocity);
    EXPECT_EQ(back.velocity->omega, 3);
    EXPECT_FALSE(fromMrpt(*toMrpt(OdometryReading{Stamp{5}, {}, std::nullopt}, "")).velocity);
}

TEST(Conventions, OdometryThatIsNotFiniteIsRefused) {
    EXPECT_THROW(fromMrpt(*toMrpt(OdometryReading{Stamp{5}, {nan, 0, 0}, std::nullopt}, "")), LogError);
    EXPECT_THROW(fromMrpt(*toMrpt(OdometryReading{Stamp{5}, {}, BodyVelocity{0, 0, nan}}, "")), LogError);
}

RangeBearingReading oneDetection() {
    RangeBearingReading reading;
    reading.stamp = Stamp{77};
    reading.sensor = {"landmarks", {1, 0.5, 0.25}, 0.5, 8, 1.5};
    reading.items.resize(2);
    reading.items[0].range = 2.5;
    reading.items[0].bearing = -0.75;
    reading.items[0].id = SourceId{1'000'003};
    reading.items[1].range = nan;
    return reading;
}

TEST(Conventions, DetectionsRoundTripWithTheSensorsClaim) {
    const auto observation = toMrpt(oneDetection(), 0.5, 0.125);
    EXPECT_FALSE(observation->validCovariances);
    EXPECT_EQ(observation->sensor_std_range, 0.5f);
    EXPECT_EQ(observation->sensor_std_yaw, 0.125f);
    EXPECT_EQ(observation->sensedData[1].landmarkID, -1);
    const RangeBearingReading back = fromMrpt(*observation);
    EXPECT_EQ(back.stamp, Stamp{77});
    EXPECT_EQ(back.sensor.label, "landmarks");
    EXPECT_EQ(back.sensor.pose.vector(), Vector3(1, 0.5, 0.25));
    EXPECT_EQ(back.sensor.min_range, 0.5);
    EXPECT_EQ(back.sensor.max_range, 8);
    EXPECT_EQ(back.sensor.field_of_view, 1.5);
    ASSERT_EQ(back.items.size(), 2u);
    EXPECT_EQ(back.items[0].range, 2.5);
    EXPECT_EQ(back.items[0].bearing, -0.75);
    EXPECT_EQ(back.items[0].id, SourceId{1'000'003});
    EXPECT_FALSE(back.items[1].id.valid());
    EXPECT_TRUE(std::isnan(back.items[1].range));  // passed on: the pipeline counts it
    // 0.5^2 and 0.125^2 are exact in float and double.
    EXPECT_EQ(back.items[0].covariance, Matrix2(Vector2(0.25, 0.015625).asDiagonal()));
}

TEST(Conventions, CovariancesOfTheirOwnTravelWithTheReading) {
    auto reading = oneDetection();
    reading.items[0].covariance << 0.04, 0.001, 0.001, 0.0004;
    const auto observation = toMrpt(reading, 0.5, 0.125);
    EXPECT_TRUE(observation->validCovariances);
    const auto back = fromMrpt(*observation);
    EXPECT_EQ(back.items[0].covariance, reading.items[0].covariance);
    EXPECT_EQ(back.items[1].covariance, Matrix2(Vector2(0.25, 0.015625).asDiagonal()));  // the claim
}

TEST(Conventions, ASensorWithoutNoiseClaimsNothing) {
    const auto back = fromMrpt(*toMrpt(oneDetection(), 0, 0));
    EXPECT_TRUE(back.items[0].covariance.isZero(0));
}

TEST(Conventions, TiltedSensorsAreRefused) {
    auto observation = toMrpt(oneDetection(), 0.5, 0.125);
    observation->sensorLocationOnRobot = mrpt::poses::CPose3D(0, 0, 0, 0, radians(0.9), 0);
    EXPECT_NO_THROW(fromMrpt(*observation));
    observation->sensorLocationOnRobot = mrpt::poses::CPose3D(0, 0, 0, 0, radians(1.1), 0);
    EXPECT_THROW(fromMrpt(*observation), LogError);
    observation->sensorLocationOnRobot = mrpt::poses::CPose3D(0, 0, 0, 0, 0, radians(-2));
    EXPECT_THROW(fromMrpt(*observation), LogError);
    observation->sensorLocationOnRobot = {};
    observation->sensedData[0].pitch = 0.1f;
    EXPECT_THROW(fromMrpt(*observation), LogError);
}

TEST(Conventions, IdsBeyondMrptsAreRefused) {
    auto reading = oneDetection();
    reading.items[0].id = SourceId{std::int64_t{1} << 31};
    EXPECT_THROW(toMrpt(reading, 1, 1), LogError);
}

TEST(Conventions, ActionsGiveIncrementAndCovariance) {
    mrpt::obs::CActionRobotMovement2D action;
    mrpt::obs::CActionRobotMovement2D::TMotionModelOptions model;
    model.modelSelection = mrpt::obs::CActionRobotMovement2D::mmGaussian;
    model.gaussianModel = {0, 0, 0, 0, 0.5, 0.25};  // only the least standard deviations
    action.computeFromOdometry(mrpt::poses::CPose2D(1, 0, 0), model);
    const OdometryIncrement increment = fromMrpt(action);
    EXPECT_EQ(increment.increment.vector(), Vector3(1, 0, 0));
    ASSERT_TRUE(increment.covariance);
    EXPECT_DOUBLE_EQ((*increment.covariance)(0, 0), 0.25);
    EXPECT_FALSE(increment.velocity);

    model.modelSelection = mrpt::obs::CActionRobotMovement2D::mmThrun;
    action.computeFromOdometry(mrpt::poses::CPose2D(1, 0, 0), model);
    const OdometryIncrement sampled = fromMrpt(action);
    EXPECT_EQ(sampled.increment.vector(), Vector3(1, 0, 0));  // the reading, not the mean of samples
    EXPECT_FALSE(sampled.covariance);
}

}  // namespace conventions_test
}  // namespace slamot
