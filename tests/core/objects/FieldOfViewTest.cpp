#include <gtest/gtest.h>

#include "slamot/core/objects/FieldOfView.h"

namespace slamot {
namespace field_of_view_test {

/// Expected at [range bearing] with standard deviations 0.5 m and 0.1 rad.
ExpectedDetection at(double range, double bearing) {
    return {{range, bearing}, Vector2(0.25, 0.01).asDiagonal()};
}

RangeBearingSensor sensorOf(double min_range, double max_range, double field_of_view) {
    RangeBearingSensor sensor;
    sensor.min_range = min_range;
    sensor.max_range = max_range;
    sensor.field_of_view = field_of_view;
    return sensor;
}

TEST(FieldOfViewTest, SurelyInViewByTwoStandardDeviations) {
    const RangeBearingSensor sensor = sensorOf(2, 20, 2);
    EXPECT_TRUE(surelyInView(sensor, at(10, 0)));
    EXPECT_TRUE(surelyInView(sensor, at(18.99, 0)));
    EXPECT_FALSE(surelyInView(sensor, at(19.01, 0)));
    EXPECT_TRUE(surelyInView(sensor, at(3.01, 0)));
    EXPECT_FALSE(surelyInView(sensor, at(2.99, 0)));
    for (const double side : {-1.0, 1.0}) {
        EXPECT_TRUE(surelyInView(sensor, at(10, side * 0.79)));
        EXPECT_FALSE(surelyInView(sensor, at(10, side * 0.81)));
        EXPECT_FALSE(surelyInView(sensor, at(10, side * 3.1)));
    }
}

TEST(FieldOfViewTest, AFullCircleHasNoSidesAndNoLowerLimitIsNone) {
    const RangeBearingSensor sensor = sensorOf(0, 20, 2 * pi);
    EXPECT_TRUE(surelyInView(sensor, at(10, 3.14)));
    EXPECT_TRUE(surelyInView(sensor, at(0.1, 0)));
    EXPECT_DOUBLE_EQ(probabilityInView(sensor, at(10, 3.14)), 1);
    EXPECT_DOUBLE_EQ(probabilityInView(sensor, at(0.1, 0)), 1);
}

TEST(FieldOfViewTest, NothingIsSaidOfAnUnknownRange) {
    const RangeBearingSensor sensor = sensorOf(0, 0, 2 * pi);
    for (const double range : {0.0, 1.0, 100.0}) {
        EXPECT_FALSE(surelyInView(sensor, at(range, 0)));
        EXPECT_EQ(probabilityInView(sensor, at(range, 0)), 0);
    }
}

TEST(FieldOfViewTest, ProbabilityInViewByTheTableOfTheNormalDistribution) {
    const RangeBearingSensor sensor = sensorOf(2, 20, 2);
    // Phi(0) = 0.5, Phi(1) = 0.8413447, Phi(2) = 0.9772499.
    EXPECT_NEAR(probabilityInView(sensor, at(20, 0)), 0.5, 1e-7);
    EXPECT_NEAR(probabilityInView(sensor, at(19.5, 0)), 0.8413447, 1e-7);
    EXPECT_NEAR(probabilityInView(sensor, at(21, 0)), 1 - 0.9772499, 1e-7);
    EXPECT_NEAR(probabilityInView(sensor, at(1.5, 0)), 1 - 0.8413447, 1e-7);
    EXPECT_NEAR(probabilityInView(sensor, at(10, -0.9)), 0.8413447, 1e-7);
    EXPECT_NEAR(probabilityInView(sensor, at(19.5, 1)), 0.5 * 0.8413447, 1e-7);
    EXPECT_NEAR(probabilityInView(sensor, at(10, 3.1)), 0, 1e-12);
}

TEST(FieldOfViewTest, ABearingBehindWrapsIntoViewOnBothSides) {
    // A blind sector of 0.2 rad straight behind: 0.1 rad to either side, one standard deviation.
    const RangeBearingSensor sensor = sensorOf(0, 20, 2 * pi - 0.2);
    for (const double bearing : {pi, -pi})
        EXPECT_NEAR(probabilityInView(sensor, at(10, bearing)), 2 * 0.1586553, 1e-7);
    EXPECT_FALSE(surelyInView(sensor, at(10, pi)));
}

TEST(FieldOfViewTest, SomethingExactlyKnownIsInOrOut) {
    const RangeBearingSensor sensor = sensorOf(0, 20, 2);
    const Matrix2 exact = Matrix2::Zero();
    EXPECT_DOUBLE_EQ(probabilityInView(sensor, {{19.9, 0.9}, exact}), 1);
    EXPECT_DOUBLE_EQ(probabilityInView(sensor, {{20.1, 0.9}, exact}), 0);
    EXPECT_TRUE(surelyInView(sensor, {{20, 1}, exact}));
}

TEST(FieldOfViewTest, ASensorOfUnknownKindReportsAll) {
    RangeBearingSensor sensor;
    const ObjectKind kinds[] = {ObjectKind::landmark, ObjectKind::mover, ObjectKind::unknown};
    for (const ObjectKind of_sensor : kinds)
        for (const ObjectKind kind : kinds) {
            sensor.kind = of_sensor;
            EXPECT_EQ(reports(sensor, kind), of_sensor == ObjectKind::unknown || of_sensor == kind);
        }
}

}  // namespace field_of_view_test
}  // namespace slamot
