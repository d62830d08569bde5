#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "BatchScene.h"
#include "slamot/core/association/BatchAssociation.h"
#include "slamot/core/association/GatedPairs.h"
#include "support/Expect.h"

namespace slamot {
namespace batch_association_test {

using test::allMethods;
using test::BatchScene;
using test::nameOf;
using test::near;
using test::objectsOf;
constexpr ObjectKind landmark = ObjectKind::landmark, mover = ObjectKind::mover,
                     unknown = ObjectKind::unknown;

TEST(BatchAssociationTest, KindsAreRespected) {
    for (const AssociationParameters& method : allMethods()) {
        SCOPED_TRACE(nameOf(method));
        // Each detection stands where an object of the other kind is.
        BatchScene crossed;
        crossed.landmark({5, 0}, 0.3);
        crossed.mover({5, 0.2}, 0.3);
        crossed.detection(landmark, {5, 0.2});
        crossed.detection(mover, {5, 0});
        EXPECT_EQ(objectsOf(crossed.associate(method)), (std::vector<int>{0, 1}));
        // Nothing but an object of the other kind.
        BatchScene alone;
        alone.landmark({5, 0});
        alone.mover({0, 7});
        alone.detection(mover, {5, 0});
        alone.detection(landmark, {0, 7});
        const BatchAssociation batch = alone.associate(method);
        EXPECT_EQ(objectsOf(batch), (std::vector<int>{-1, -1}));
        EXPECT_EQ(batch.may_be_new, (std::vector<bool>{true, true}));
    }
}

TEST(BatchAssociationTest, UnknownOnesGoToEither) {
    for (const AssociationParameters& method : allMethods()) {
        SCOPED_TRACE(nameOf(method));
        BatchScene scene;
        scene.landmark({5, 0}, 0.3);
        scene.mover({5, 1}, 0.3);
        scene.landmark({-6, 2});
        scene.mover({-6, -3});
        for (const Vector2& at : {Vector2(-6, -3), Vector2(5, 0.9), Vector2(5, 0.1), Vector2(-6, 2)})
            scene.detection(unknown, at);
        EXPECT_EQ(objectsOf(scene.associate(method)), (std::vector<int>{3, 1, 0, 2}));
    }
}

TEST(BatchAssociationTest, AMoverThatIsSeenForSureLeavesOthersToTheLandmark) {
    // The unknown one lies nearer to the mover, which has a detection of its own.
    for (const AssociationParameters& method : allMethods()) {
        SCOPED_TRACE(nameOf(method));
        BatchScene scene;
        scene.landmark({5, 0}, 0.3);
        scene.mover({5, 0.6}, 0.3);
        scene.detection(unknown, {5, 0.35});
        scene.detection(mover, {5, 0.62});
        EXPECT_EQ(objectsOf(scene.associate(method)), (std::vector<int>{0, 1}));
    }
}

TEST(BatchAssociationTest, MoversAreJudgedInTheLightOfTheLandmarks) {
    // The robot is turned by 0.1 rad from where it believes to be, one standard deviation. Of two movers 1 m
    // apart in 10 m only the left one is seen, by a sensor of its own, exactly where the right one is
    // expected.
    for (const AssociationParameters& method : allMethods()) {
        SCOPED_TRACE(nameOf(method));
        BatchScene scene({0, 0, 0.1});
        scene.mover(10 * Vector2(1, 0));
        scene.mover(10 * Vector2(std::cos(0.1), std::sin(0.1)));
        const int seen = scene.detection(mover, {10, 0}, {0, 0}, 1);
        EXPECT_EQ(objectsOf(scene.associate(method)), (std::vector<int>{0})) << "alone, the wrong one";

        std::vector<int> expected{1};
        for (const Vector2& at : {Vector2(6, 6), Vector2(-8, 0), Vector2(3, -7)}) {
            expected.push_back(scene.landmark(at, 0.05));
            scene.detection(landmark, at, {0, -0.1}, 0);
        }
        const BatchAssociation batch = scene.associate(method);
        EXPECT_EQ(objectsOf(batch), expected);
        // Its innovation is all but explained: 0 +- 0.02 for the heading, 0.02 for itself.
        EXPECT_LT(batch.of_detection[static_cast<std::size_t>(seen)].nis, 0.5);
    }
}

TEST(BatchAssociationTest, WhatMayBeNew) {
    // Robot known, landmark and range noise 0.1 m each: S = 0.02 m^2 in range. Gates at NIS 13.8 and 27.6.
    const Vector2 near_it{std::sqrt(0.02 * 20), 0}, far{std::sqrt(0.02 * 40), 0};
    for (const ObjectKind kind : {landmark, mover})
        for (const AssociationParameters& method : allMethods()) {
            SCOPED_TRACE(nameOf(method) + toText(kind));
            const auto scene = [&] {
                BatchScene out;
                kind == landmark ? out.landmark({5, 0}) : out.mover({5, 0});
                return out;
            };
            const auto answer = [&](const BatchScene& s) { return s.associate(method); };
            for (const ObjectKind seen_as : {kind, unknown}) {
                BatchScene lonely = scene();
                lonely.detection(seen_as, {5, 0}, near_it);
                lonely.detection(seen_as, {5, 0}, far);
                EXPECT_EQ(objectsOf(answer(lonely)), (std::vector<int>{-1, -1}));
                EXPECT_EQ(answer(lonely).may_be_new, (std::vector<bool>{false, true}));

                BatchScene taken = scene();
                taken.detection(seen_as, {5, 0}, near_it);
                taken.detection(seen_as, {5, 0}, far);
                taken.detection(seen_as, {5, 0});
                EXPECT_EQ(objectsOf(answer(taken)), (std::vector<int>{-1, -1, 0}));
                EXPECT_EQ(answer(taken).may_be_new, (std::vector<bool>{true, true, false}));

                // Another sensor's detection does not say that this one's is of something else.
                BatchScene other = scene();
                other.detection(seen_as, {5, 0}, near_it, 0);
                other.detection(seen_as, {5, 0}, {0, 0}, 1);
                EXPECT_EQ(objectsOf(answer(other)), (std::vector<int>{-1, 0}));
                EXPECT_EQ(answer(other).may_be_new, (std::vector<bool>{false, false}));
            }
        }
}

TEST(BatchAssociationTest, OnlyWhatIsAskedForIsAssociated) {
    BatchScene scene;
    scene.landmark({5, 0});
    scene.detection(landmark, {5, 0});
    scene.detection(landmark, {5, 0}, {0.1, 0});
    scene.detection(landmark, {-9, 9});
    scene.detection(landmark, {-9, 5});
    const BatchAssociation batch = scene.associate({}, {1, 3});
    EXPECT_EQ(objectsOf(batch), (std::vector<int>{-1, 0, -1, -1}));
    EXPECT_EQ(batch.may_be_new, (std::vector<bool>{false, false, false, true}));
}

TEST(BatchAssociationTest, EachSensorDetectsAnObjectOnce) {
    for (const AssociationParameters& method : allMethods()) {
        SCOPED_TRACE(nameOf(method));
        BatchScene scene;
        scene.seen.sensors[1].pose = {0.3, -0.2, 3.0};
        const int l = scene.landmark({5, 0}), m = scene.mover({-4, 4});
        scene.detection(landmark, {5, 0}, {0.2, 0});
        scene.detection(landmark, {5, 0}, {0.05, 0});
        scene.detection(landmark, {5, 0}, {-0.1, 0}, 1);
        scene.detection(mover, {-4, 4}, {0.02, 0});
        scene.detection(mover, {-4, 4}, {0.3, 0});
        scene.detection(mover, {-4, 4}, {0.1, 0}, 1);
        EXPECT_EQ(objectsOf(scene.associate(method)), (std::vector<int>{-1, l, l, m, -1, m}));
    }
}

TEST(BatchAssociationTest, KnownLeavesAllAlone) {
    const auto batchWith = [](LandmarkAssociation landmarks, MoverAssociation movers) {
        BatchScene scene;
        scene.landmark({5, 0});
        scene.mover({-4, 4});
        for (const ObjectKind kind : {landmark, mover, unknown})
            for (const Vector2& at : {Vector2(5, 0), Vector2(-4, 4), Vector2(20, 20)})
                scene.detection(kind, at);
        AssociationParameters parameters;
        parameters.landmarks = landmarks;
        parameters.movers = movers;
        return scene.associate(parameters);
    };
    const std::vector<bool> none(9, false);
    const BatchAssociation both = batchWith(LandmarkAssociation::known, MoverAssociation::known);
    EXPECT_EQ(objectsOf(both), std::vector<int>(9, -1));
    EXPECT_EQ(both.may_be_new, none);
    // Landmarks of the log, movers without identities: unknown ones may be movers, but start nothing, as they
    // might be landmarks. Of two for the mover the first is as good as the other.
    const BatchAssociation movers = batchWith(LandmarkAssociation::known, MoverAssociation::nearest);
    EXPECT_EQ(objectsOf(movers), (std::vector<int>{-1, -1, -1, -1, 1, -1, -1, -1, -1}));
    EXPECT_EQ(movers.may_be_new, (std::vector<bool>{0, 0, 0, 1, 0, 1, 0, 0, 0}));
    const BatchAssociation landmarks = batchWith(LandmarkAssociation::nearest, MoverAssociation::known);
    EXPECT_EQ(objectsOf(landmarks), (std::vector<int>{0, -1, -1, -1, -1, -1, -1, -1, -1}));
    EXPECT_EQ(landmarks.may_be_new, (std::vector<bool>{0, 1, 1, 0, 0, 0, 0, 0, 0}));
}

TEST(BatchAssociationTest, PairsSayHowLikelyTheyAre) {
    // Robot known: S = diag(0.1^2 + 0.1^2, (0.1 / 5)^2 + 0.02^2), P_D 0.9, c 0.05.
    BatchScene scene;
    scene.landmark({5, 0});
    scene.mover({0, -5});
    scene.detection(landmark, {5, 0}, {0.2, -0.01});
    scene.detection(mover, {0, -5}, {-0.1, 0.02});
    const auto pairs = scene.associate({}).of_detection;
    const double nis[] = {0.04 / 0.02 + 1e-4 / 8e-4, 0.01 / 0.02 + 4e-4 / 8e-4};
    for (const int d : {0, 1}) {
        EXPECT_NEAR(pairs[d].nis, nis[d], 1e-10);
        const double density = std::exp(-0.5 * nis[d]) / (2 * pi * std::sqrt(0.02 * 8e-4));
        EXPECT_NEAR(pairs[d].likelihood_ratio, 0.9 * density / 0.05, 1e-8);
    }
}

AssociationParameters jpda() {
    AssociationParameters out;
    out.movers = MoverAssociation::jpda;
    return out;
}

TEST(BatchAssociationTest, OnePairInAWideGateIsLeftUndecidedTwoThatFitTogetherAreNot) {
    for (const AssociationParameters& method : allMethods()) {
        SCOPED_TRACE(nameOf(method));
        // A robot that comes back in doubt by 3 m sees something 6 m before the one landmark of its map:
        // inside the gate (NIS about 4), and as well something new. It is not taken and may be new, nor is
        // the landmark missed.
        BatchScene alone({3, 3, 0.05});
        alone.clutter = 0.005;
        alone.landmark({15, 0});
        alone.detection(landmark, {9, 0});
        const BatchAssociation open = alone.associate(method);
        EXPECT_EQ(objectsOf(open), (std::vector<int>{-1}));
        EXPECT_EQ(open.may_be_new, (std::vector<bool>{true}));
        EXPECT_EQ(open.in_doubt, (std::vector<bool>{true}));

        // Two landmarks shifted alike can hardly be two others.
        BatchScene two({3, 3, 0.05});
        two.clutter = 0.005;
        two.landmark({15, 0});
        two.landmark({12, 7});
        two.detection(landmark, {13, 1});
        two.detection(landmark, {10, 8});
        const BatchAssociation both = two.associate(method);
        EXPECT_EQ(objectsOf(both), (std::vector<int>{0, 1}));
        EXPECT_EQ(both.in_doubt, (std::vector<bool>{false, false}));

        // A robot that knows where it is needs one alone.
        BatchScene sure;
        sure.landmark({15, 0});
        sure.detection(landmark, {15, 0}, {0.3, 0});  // NIS about 4 too
        const BatchAssociation taken = sure.associate(method);
        EXPECT_EQ(objectsOf(taken), (std::vector<int>{0}));
        EXPECT_EQ(taken.in_doubt, (std::vector<bool>{false}));
    }
}

TEST(BatchAssociationTest, JpdaWeighsTwoMoversAndTwoDetections) {
    // Robot known, movers 1 m apart in 10 m, uncertain by 0.5 m, both detections between them.
    BatchScene scene;
    const Vector2 places[] = {{10, 0.5}, {10, -0.5}};
    for (const Vector2& at : places) scene.mover(at, 0.5);
    const double off[] = {0.02, -0.03};
    for (const double bearing : off) scene.detection(mover, {10, 0}, {0.1, bearing});

    // What a mover 0.5 m across is to range and bearing: isotropic, 1 and 1 / d^2.
    const double d2 = 100.25, d = std::sqrt(d2);
    const Matrix2 P_y = Vector2(0.25, 0.25 / d2).asDiagonal(), R = Vector2(0.01, 0.0004).asDiagonal();
    const Matrix2 S = P_y + R;
    Vector2 nu[2][2];  // [detection][mover]
    double l[2][2];
    for (const int z : {0, 1})
        for (const int o : {0, 1}) {
            nu[z][o] = Vector2(10.1 - d, off[z] - std::atan2(places[o].y(), 10));
            const double N =
                std::exp(-0.5 * nu[z][o].dot(S.inverse() * nu[z][o])) / (2 * pi * std::sqrt(S.determinant()));
            l[z][o] = 0.9 * N / (0.05 * (1 - 0.9 * 0.999));
        }
    // Seven ways: none, one pair, both pairs straight or crossed.
    const double all = 1 + l[0][0] + l[0][1] + l[1][0] + l[1][1] + l[0][0] * l[1][1] + l[0][1] * l[1][0];
    double beta[2][2];
    for (const int z : {0, 1})
        for (const int o : {0, 1}) beta[z][o] = l[z][o] * (1 + l[1 - z][1 - o]) / all;
    ASSERT_GT(beta[0][1], 0.1) << "or nothing is shared";

    const BatchAssociation batch = scene.associate(jpda());
    ASSERT_TRUE(batch.soft);
    ASSERT_EQ(objectsOf(batch), (std::vector<int>{0, 1}));
    for (const int o : {0, 1}) {
        // Moments of the mixture of the updates, y about its prediction.
        const Matrix2 K = P_y * S.inverse();
        Vector2 mean = Vector2::Zero();
        Matrix2 C = (1 - beta[0][o] - beta[1][o]) * P_y;
        for (const int z : {0, 1}) {
            const Vector2 m = K * nu[z][o];
            mean += beta[z][o] * m;
            C += beta[z][o] * (P_y - K * P_y + m * m.transpose());
        }
        C -= mean * mean.transpose();
        ASSERT_GT((P_y - C).selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0)
            << "or no measurement could reach it";
        const RangeBearingDetection& merged = batch.merged[static_cast<std::size_t>(o)];
        const Matrix2 K_merged = P_y * (P_y + merged.covariance).inverse();
        const Vector2 residual(merged.range - d, merged.bearing - std::atan2(places[o].y(), 10));
        // Weights below a thousandth are left out: none here.
        EXPECT_TRUE(near(K_merged * residual, mean, 1e-10));
        EXPECT_TRUE(near(P_y - K_merged * P_y, C, 1e-10));
    }
}

TEST(BatchAssociationTest, JpdaGivesACertainDetectionBack) {
    // With hardly any clutter the detection is the mover's: what it is updated with is the detection, whose
    // second-order noise is the update's own business.
    for (const Consistency consistency : {Consistency::classic, Consistency::invariant}) {
        BatchScene scene({0.3, 0.2, 0.05}, 0, consistency);
        scene.clutter = 1e-9;
        scene.landmark({6, 6});
        scene.mover({5, -2}, 1);
        scene.detection(landmark, {6, 6}, {0.2, 0.03});
        const int d = scene.detection(mover, {5, -2}, {0.6, -0.1});
        const BatchAssociation batch = scene.associate(jpda());
        ASSERT_EQ(objectsOf(batch), (std::vector<int>{0, 1}));
        const RangeBearingDetection &merged = batch.merged[d], &seen = scene.seen.detections[d];
        // 1 - beta is about 1e-10; what it does to the noise is multiplied by P_y / R = 100.
        EXPECT_NEAR(merged.range, seen.range, 1e-6);
        EXPECT_NEAR(merged.bearing, seen.bearing, 1e-6);
        EXPECT_TRUE(near(merged.covariance / 0.0004, seen.covariance / 0.0004, 1e-6));
    }
}

TEST(BatchAssociationTest, JpdaDoesNotTurnOverWhereDetectionsSayLittle) {
    // A mover 1 m away, uncertain by 0.4 rad, and a detection at 3 deviations which is as likely clutter.
    // Half of the correction is meant, by a measurement that hardly narrows the bearing: with twenty times
    // its variance it would have to lie 12 rad off.
    BatchScene scene;
    scene.mover({1, 0}, 0.4);
    scene.detection(mover, {1, 0}, {0, 1.2});
    const double S_b = 0.16 + 0.0004, S_r = 0.16 + 0.01;
    const double N = std::exp(-0.5 * 1.44 / S_b) / (2 * pi * std::sqrt(S_b * S_r));
    scene.clutter = 0.9 * N / (1 - 0.9 * 0.999);  // l = 1
    const BatchAssociation batch = scene.associate(jpda());
    ASSERT_EQ(objectsOf(batch), (std::vector<int>{0}));
    const RangeBearingDetection& merged = batch.merged[0];
    EXPECT_GT(merged.bearing, 0);
    EXPECT_LE(merged.bearing, pi / 2);
    const Vector2 correction = Matrix2(Vector2(0.16, 0.16).asDiagonal()) *
                               (Matrix2(Vector2(0.16, 0.16).asDiagonal()) + merged.covariance).inverse() *
                               Vector2(merged.range - 1, merged.bearing);
    EXPECT_TRUE(near(correction, Vector2(0, 0.5 * 0.16 / S_b * 1.2), 1e-10));
}

class TurnedBatches : public testing::TestWithParam<Consistency> {};
INSTANTIATE_TEST_SUITE_P(Cores, TurnedBatches, testing::Values(Consistency::classic, Consistency::invariant));

TEST_P(TurnedBatches, GiveTheSameAnswers) {
    // Pairs of objects close to one another all around, several straight behind; a robot off by a deviation;
    // two sensors, detections of all kinds, clutter.
    const auto answer = [&](double turn, const AssociationParameters& method) {
        BatchScene scene({0.1, 0.1, 0.04}, turn, GetParam());
        scene.seen.sensors[1].pose = {0.2, 0.1, 2.5};
        const std::vector<Vector2> landmarks{{-8, 0.1}, {-8, -0.4}, {-6, 3}, {5, 5}, {5.4, 4.8}, {0, -7}},
            movers{{-10, 0.2}, {-10, -0.6}, {7, -1}, {7, -1.8}, {-3, -9}};
        for (const Vector2& at : landmarks) scene.landmark(at, 0.05);
        for (const Vector2& at : movers) scene.mover(at, 0.3);
        const Vector2 moved(0.1, -0.05);
        for (const std::size_t i : {0, 1, 3, 4, 5})
            scene.detection(landmark, landmarks[i] - moved, {0.03, -0.05});
        scene.detection(unknown, landmarks[2] - moved, {0, -0.05}, 1);
        for (const std::size_t i : {0, 1, 2})
            scene.detection(mover, movers[i] - moved, {-0.1, -0.05}, static_cast<int>(i % 2));
        scene.detection(unknown, movers[4] - moved, {0.05, -0.02}, 1);
        scene.detection(unknown, movers[0], {0.2, 0.03}, 1);
        scene.detection(mover, movers[0], {0.1, 0.05}, 0);
        scene.detection(landmark, {3, 11});
        return scene.associate(method);
    };
    int paired = 0;
    for (const AssociationParameters& method : allMethods()) {
        SCOPED_TRACE(nameOf(method));
        const BatchAssociation straight = answer(0, method);
        for (const int object : objectsOf(straight)) paired += object >= 0;
        for (int k = 1; k <= 24; ++k) {
            SCOPED_TRACE(k);
            const BatchAssociation turned = answer(wrapAngle(radians(15.0 * k)), method);
            ASSERT_EQ(objectsOf(turned), objectsOf(straight));
            ASSERT_EQ(turned.may_be_new, straight.may_be_new);
            for (std::size_t d = 0; d < turned.merged.size(); ++d) {
                const auto &a = turned.of_detection[d], &b = straight.of_detection[d];
                // Positions of 20 m round to 4e-15; gates of 0.05 m and 0.02 rad make 1e-12 of it, and the
                // merged noise, up to twenty times P_y, and sums do the rest.
                ASSERT_NEAR(a.nis, b.nis, 1e-9);
                ASSERT_NEAR(a.likelihood_ratio, b.likelihood_ratio, 1e-9 * (1 + b.likelihood_ratio));
                const RangeBearingDetection &m = turned.merged[d], &n = straight.merged[d];
                ASSERT_NEAR(m.range, n.range, 1e-8);
                ASSERT_NEAR(angleDifference(m.bearing, n.bearing), 0, 1e-8);
                ASSERT_TRUE(near(m.covariance, n.covariance, 1e-8));
            }
        }
    }
    EXPECT_GE(paired, 12 * 9) << "or little was compared";
}

}  // namespace batch_association_test
}  // namespace slamot
