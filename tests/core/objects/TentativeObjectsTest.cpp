#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "slamot/core/objects/TentativeObjects.h"
#include "support/Expect.h"

namespace slamot {
namespace tentative_objects_test {

constexpr double inf = std::numeric_limits<double>::infinity();
const TargetModel model{TargetModelKind::cv, 0.5, 0.1};

RangeBearingSensor sensorOf(ObjectKind kind, double field_of_view = 2 * pi) {
    RangeBearingSensor sensor;
    sensor.max_range = 20;
    sensor.field_of_view = field_of_view;
    sensor.kind = kind;
    return sensor;
}

RangeBearingDetection detectionOf(double range, double bearing, ObjectKind kind, int sensor = 0) {
    RangeBearingDetection detection;
    detection.range = range;
    detection.bearing = bearing;
    detection.covariance = Vector2(0.01, 1e-4).asDiagonal();
    detection.kind = kind;
    detection.sensor = sensor;
    return detection;
}

TentativeParameters noOcclusions() {
    TentativeParameters p;
    p.landmarks.hidden_every = p.movers.hidden_every = inf;
    return p;
}

/// Nor anything ever confirmed: clutter leaves a doubt.
TentativeParameters neverConfirmed() {
    TentativeParameters p = noOcclusions();
    p.landmarks.confirm_probability = p.movers.confirm_probability = 1;
    return p;
}

/// Hands in every detection as unexplained, as a robot at rest, 0.1 s later at each call.
struct AtRest {
    explicit AtRest(const TentativeParameters& parameters) : objects(parameters) {}

    std::vector<ConfirmedObject> see(const std::vector<RangeBearingSensor>& sensors,
                                     const std::vector<RangeBearingDetection>& detections,
                                     bool may_start = true) {
        now = later(now, 0.1);
        objects.predict({{{}, Matrix3::Zero()}, 0.1}, model);
        std::vector<int> all;
        for (int d = 0; d < static_cast<int>(detections.size()); ++d) all.push_back(d);
        return objects.update({sensors, detections}, now, all, std::vector<bool>(all.size(), may_start),
                              Consistency::classic);
    }

    TentativeObjects objects;
    Stamp now;
};

const ObjectKind landmark = ObjectKind::landmark, mover = ObjectKind::mover, unknown = ObjectKind::unknown;

TEST(TentativeObjectsTest, ADetectionStartsAnObjectWhereItMay) {
    AtRest robot(noOcclusions());
    robot.see({sensorOf(landmark)}, {detectionOf(5, 0.5, landmark)}, false);
    EXPECT_EQ(robot.objects.size(), 0);
    EXPECT_TRUE(robot.see({sensorOf(landmark)}, {detectionOf(5, 0.5, landmark)}).empty());
    ASSERT_EQ(robot.objects.size(), 1);
    const TentativeObject& object = robot.objects.objects()[0];
    EXPECT_EQ(object.kind, landmark);
    EXPECT_EQ(object.seen, 1);
    EXPECT_EQ(object.first_seen, robot.now);
    EXPECT_DOUBLE_EQ(object.existence.probability(), 1.0 / 11);
    EXPECT_TRUE(
        test::near(object.track.asLandmark().position(), 5 * Vector2(std::cos(0.5), std::sin(0.5)), 1e-14));
    robot.objects.clear();
    EXPECT_EQ(robot.objects.size(), 0);
}

TEST(TentativeObjectsTest, OnlyWhatIsUnexplainedCounts) {
    TentativeObjects objects(noOcclusions());
    const RangeBearingSet seen{{sensorOf(landmark)},
                               {detectionOf(5, 0, landmark), detectionOf(9, 1, landmark)}};
    objects.update(seen, {}, {1}, {true, true}, Consistency::classic);
    ASSERT_EQ(objects.size(), 1);
    EXPECT_NEAR(objects.objects()[0].track.asLandmark().position().norm(), 9, 1e-12);
}

TEST(TentativeObjectsTest, ASecondDetectionByHand) {
    // Prior odds 0.1 : 1. The same detection again: nu = 0, S = 2 R, N = 1 / (2 pi 2 * 0.1 * 0.01). Clutter
    // and new objects: 1.1 a scan over 20 m and 2 pi.
    AtRest robot(neverConfirmed());
    for (int i = 0; i < 2; ++i)
        EXPECT_TRUE(robot.see({sensorOf(landmark)}, {detectionOf(10, 0, landmark)}).empty());
    const double ratio = 0.9 / (2 * pi * 2 * 0.1 * 0.01) / (1.1 / (20 * 2 * pi));
    const double odds = 0.1 * ratio;
    ASSERT_EQ(robot.objects.size(), 1);
    EXPECT_NEAR(robot.objects.objects()[0].existence.probability(), odds / (1 + odds), 1e-12);
    EXPECT_EQ(robot.objects.objects()[0].seen, 2);
}

TEST(TentativeObjectsTest, WithoutClutterALandmarkLeavesAtOnce) {
    TentativeParameters p = noOcclusions();
    p.landmarks.clutter_per_scan = p.movers.clutter_per_scan = 0;
    AtRest robot(p);
    const auto confirmed = robot.see(
        {sensorOf(landmark), sensorOf(mover), sensorOf(unknown)},
        {detectionOf(5, 1, mover, 1), detectionOf(5, 2, unknown, 2), detectionOf(5, 3, landmark, 0)});
    ASSERT_EQ(confirmed.size(), 2u);
    EXPECT_EQ(confirmed[0].detection, 0);
    EXPECT_TRUE(confirmed[0].moving);
    EXPECT_DOUBLE_EQ(confirmed[0].object.track.asMover().covariance(2, 2), 9);
    EXPECT_DOUBLE_EQ(confirmed[0].object.track.asMover().covariance(4, 4), 4);
    EXPECT_EQ(confirmed[1].detection, 2);
    EXPECT_FALSE(confirmed[1].moving);
    // Of the third it is not known whether it moves.
    ASSERT_EQ(robot.objects.size(), 1);
    EXPECT_EQ(robot.objects.objects()[0].kind, unknown);
    EXPECT_EQ(robot.objects.objects()[0].existence.probability(), 1);
    // Where neither clutter nor new objects are expected, the same.
    p.landmarks.new_per_scan = 0;
    EXPECT_EQ(AtRest(p).see({sensorOf(landmark)}, {detectionOf(5, 0, landmark)}).size(), 1u);
}

TEST(TentativeObjectsTest, NothingStartsWhereNothingNewIsExpected) {
    TentativeParameters p = noOcclusions();
    p.landmarks.new_per_scan = 0;
    AtRest robot(p);
    robot.see({sensorOf(landmark)}, {detectionOf(5, 0, landmark)});
    EXPECT_EQ(robot.objects.size(), 0);
}

TEST(TentativeObjectsTest, OfUnknownKindTheMotionDecides) {
    for (const double speed : {0.0, 1.5}) {
        AtRest robot(noOcclusions());
        std::vector<ConfirmedObject> confirmed;
        int scan = 0;
        for (; scan < 30 && confirmed.empty(); ++scan)
            confirmed = robot.see({sensorOf(unknown)}, {detectionOf(5 + 0.1 * speed * scan, 0, unknown)});
        ASSERT_EQ(confirmed.size(), 1u) << speed;
        EXPECT_EQ(confirmed[0].moving, speed > 0);
        EXPECT_EQ(robot.objects.size(), 0);
        const double p = confirmed[0].object.track.movingProbability();
        EXPECT_TRUE(speed > 0 ? p >= 0.9 : p <= 0.1) << p;
        if (speed > 0) {
            EXPECT_NEAR(confirmed[0].object.track.asMover().mean(2), speed, 0.5);
        }
    }
}

TEST(TentativeObjectsTest, MissesEndIt) {
    // Odds 1 : 10, tenfold less at each miss. After the second 1/1001, still above 0.01 / 11; not after the
    // third.
    AtRest robot(noOcclusions());
    robot.see({sensorOf(landmark)}, {detectionOf(5, 0, landmark)});
    for (const int left : {1, 1, 0}) {
        robot.see({sensorOf(landmark)}, {});
        EXPECT_EQ(robot.objects.size(), left);
    }
}

TEST(TentativeObjectsTest, WhatIsOutOfViewIsNotMissedButForgottenInTime) {
    TentativeParameters p = noOcclusions();
    p.max_unseen = 2;
    AtRest robot(p);
    robot.see({sensorOf(landmark)}, {detectionOf(5, 2, landmark)});
    for (int scan = 1; scan <= 21; ++scan) {
        robot.see({sensorOf(landmark, 2)}, {});  // sees 1 rad to either side
        ASSERT_EQ(robot.objects.size(), scan <= 20) << scan;
        if (scan <= 20) {
            ASSERT_NEAR(robot.objects.objects()[0].existence.probability(), 1.0 / 11, 1e-12);
        }
    }
}

TEST(TentativeObjectsTest, SensorsOfAnotherKindSayNothingOfIt) {
    AtRest robot(neverConfirmed());
    robot.see({sensorOf(landmark)}, {detectionOf(5, 0, landmark)});
    // A mover at the same place is another object, and the mover's sensor does not miss the landmark.
    robot.see({sensorOf(mover)}, {detectionOf(5, 0, mover)});
    ASSERT_EQ(robot.objects.size(), 2);
    EXPECT_NEAR(robot.objects.objects()[0].existence.probability(), 1.0 / 11, 1e-12);
    EXPECT_EQ(robot.objects.objects()[0].seen, 1);
    // A sensor of mixed kind reports both: it may be the landmark.
    robot.see({sensorOf(unknown)}, {detectionOf(5, 0, unknown)}, false);
    EXPECT_EQ(robot.objects.objects()[0].seen + robot.objects.objects()[1].seen, 3);
}

TEST(TentativeObjectsTest, TwoSensorsSeeOneObjectOnceEach) {
    AtRest robot(neverConfirmed());
    RangeBearingSensor turned = sensorOf(landmark);
    turned.pose = {0, 0, pi};
    robot.see({sensorOf(landmark), turned}, {detectionOf(5, 0, landmark, 0), detectionOf(5, pi, landmark, 1),
                                             detectionOf(5, 0.0, landmark, 1)});
    // The first of the second sensor is of the first's object; its other one is elsewhere.
    ASSERT_EQ(robot.objects.size(), 2);
    EXPECT_EQ(robot.objects.objects()[0].seen, 2);
    EXPECT_EQ(robot.objects.objects()[1].seen, 1);
    EXPECT_NEAR(robot.objects.objects()[1].track.asLandmark().position().x(), -5, 1e-12);
}

TEST(TentativeObjectsTest, ATurnedSensorTellsTheSame) {
    // What moves across the robot's back, 0.3 rad to either side, beside what stands there.
    const auto run = [](double turn) {
        AtRest robot(neverConfirmed());
        RangeBearingSensor sensor = sensorOf(unknown);
        sensor.pose.theta = turn;
        for (int scan = 0; scan < 13; ++scan)
            robot.see({sensor}, {detectionOf(6, wrapAngle(pi - 0.3 + 0.05 * scan - turn), unknown),
                                 detectionOf(8, wrapAngle(pi + 0.01 * (scan % 2) - turn), unknown)});
        return robot.objects.objects();
    };
    const auto straight = run(0);
    ASSERT_EQ(straight.size(), 2u);
    EXPECT_GT(straight[0].track.movingProbability(), 0.9);
    EXPECT_LT(straight[1].track.movingProbability(), 0.1);
    for (int k = 1; k < 24; ++k) {
        const auto turned = run(radians(15.0 * k));
        ASSERT_EQ(turned.size(), 2u) << k;
        for (std::size_t o = 0; o < 2; ++o) {
            // Rounding of thirteen updates.
            EXPECT_EQ(turned[o].seen, 13);
            EXPECT_NEAR(turned[o].track.movingProbability(), straight[o].track.movingProbability(), 1e-9)
                << k;
            EXPECT_TRUE(test::near(turned[o].track.asMover().mean, straight[o].track.asMover().mean, 1e-9))
                << k;
        }
    }
}

TEST(TentativeObjectsTest, OneDetectionForOneObject) {
    // Two objects 0.4 m apart and two detections, both nearer to the first: each gets one.
    AtRest robot(neverConfirmed());
    robot.see({sensorOf(landmark)}, {detectionOf(5, 0, landmark), detectionOf(5.4, 0, landmark)});
    ASSERT_EQ(robot.objects.size(), 2);
    robot.see({sensorOf(landmark)}, {detectionOf(4.95, 0, landmark), detectionOf(5.15, 0, landmark)});
    ASSERT_EQ(robot.objects.size(), 2);
    EXPECT_NEAR(robot.objects.objects()[0].track.asLandmark().position().x(), 4.975, 1e-9);
    EXPECT_NEAR(robot.objects.objects()[1].track.asLandmark().position().x(), 5.275, 1e-9);
}

}  // namespace tentative_objects_test
}  // namespace slamot
