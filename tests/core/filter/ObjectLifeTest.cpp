#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "../estimation/ImmScenes.h"
#include "StandingRobot.h"
#include "slamot/core/filter/ObjectLife.h"
#include "support/Expect.h"

namespace slamot {
namespace object_life_test {

using test::near;
using test::StandingRobot;

constexpr auto landmark = ObjectKind::landmark;
constexpr auto mover = ObjectKind::mover;
constexpr double never = std::numeric_limits<double>::infinity();

double odds(double p) {
    return p / (1 - p);
}

TEST(ObjectLifeTest, WhatCameThriceAndIsSeenNoMoreIsLetGo) {
    JointFilterParameters parameters;
    parameters.life.landmarks.hidden_every = never;
    StandingRobot robot(parameters);
    for (int k = 0; k < 3; ++k) robot.look({{{5, 2}, landmark}});
    ASSERT_EQ(robot.filter.landmarkCount(), 1);
    // At first sight 0.1 / 1.1; let go at a hundredth of that. A miss is 0.1 times as likely of what is
    // there.
    const double least = 0.01 * 0.1 / 1.1;
    double before = robot.filter.landmarks()[0].existence;
    int misses = 0;
    while (true) {
        robot.look({});
        ++misses;
        const double expected = 0.1 * odds(before) / (1 + 0.1 * odds(before));
        if (expected < least) break;
        ASSERT_EQ(robot.filter.landmarkCount(), 1) << misses;
        before = robot.filter.landmarks()[0].existence;
        // Near 1 the odds are all rounding.
        ASSERT_NEAR(before, expected, 1e-6) << misses;
    }
    EXPECT_EQ(robot.filter.landmarkCount(), 0);
    EXPECT_GE(misses, 4);
    EXPECT_LE(misses, 13);
    EXPECT_LE(robot.filter.state().dimension(), 3 + 6 * 3) << "robot and remembered poses";
}

// What may be a landmark stands where the robot's pose puts it, and is as uncertain as both together.
TEST(ObjectLifeTest, TentativeLandmarksAreToldInTheWorld) {
    JointFilterParameters p;
    p.consistency = Consistency::classic;
    JointFilter filter(p, {});
    const Pose2 robot{1, 2, pi / 2};
    filter.start({}, {robot, Vector3(0.1, 0.2, 0.02).cwiseAbs2().asDiagonal()});
    DetectionSet set = test::detectionsAt(0, {test::seen(robot, {1, 6}, ObjectKind::landmark, -1),
                                              test::seen(robot, {4, 2}, ObjectKind::mover, -1),
                                              test::seen(robot, {-2, 4}, ObjectKind::unknown, -1)});
    std::get<RangeBearingSet>(set.measurements).sensors[0].max_range = 20;
    filter.update(set);
    const std::vector<LandmarkEstimate> candidates = filter.tentative();
    ASSERT_EQ(candidates.size(), 2u);
    EXPECT_TRUE(test::near(candidates[0].mean, Vector2(1, 6), 1e-12));
    EXPECT_TRUE(test::near(candidates[1].mean, Vector2(-2, 4), 1e-12));
    // 4 m ahead: range along y, bearing and heading along x.
    const Matrix2 P = Vector2(0.01 + 16 * (0.0004 + 0.0004), 0.04 + 0.01).asDiagonal();
    EXPECT_TRUE(test::near(candidates[0].covariance, P, 1e-12));
    EXPECT_NEAR(candidates[0].existence, 0.1 / 1.1, 1e-12);
    EXPECT_EQ(candidates[0].moving, 0);
    EXPECT_NEAR(candidates[1].moving, p.life.change.moving_probability, 1e-12);
    EXPECT_EQ(filter.landmarkCount(), 0);
}

TEST(ObjectLifeTest, ALandmarkOutlivesAnOcclusion) {
    const auto run = [](double hidden_every) {
        JointFilterParameters parameters;
        parameters.life.landmarks.hidden_every = hidden_every;
        StandingRobot robot(parameters, 0.1);
        for (int k = 0; k < 20; ++k) robot.look({{{5, 2}, landmark}});
        for (int k = 0; k < 20; ++k) robot.look({});  // the 2 s that an occlusion lasts on average
        robot.look({{{5, 2}, landmark}});
        return robot.filter.landmarks();
    };
    const auto survived = run(20);
    ASSERT_EQ(survived.size(), 1u);
    EXPECT_EQ(survived[0].id.value, 0);
    EXPECT_EQ(survived[0].seen, 21);
    EXPECT_GT(survived[0].existence, 0.9);
    EXPECT_TRUE(run(never).empty()) << "where nothing hides landmarks, twenty misses are the end";
}

TEST(ObjectLifeTest, OutOfViewNothingIsDoubted) {
    StandingRobot robot;
    robot.sensor.field_of_view = radians(90);
    const StandingRobot::Scan ahead{{{5, 1}, landmark}};
    for (int k = 0; k < 3; ++k) robot.look(ahead);
    ASSERT_EQ(robot.filter.landmarkCount(), 1);
    const LandmarkEstimate before = robot.filter.landmarks()[0];
    robot.sensor.pose.theta = pi;
    for (int k = 0; k < 100; ++k) robot.look({});
    robot.sensor.pose.theta = 0;
    robot.sensor.max_range = 4;
    for (int k = 0; k < 100; ++k) robot.look({});
    robot.sensor.max_range = 20;
    robot.sensor.min_range = 7;
    for (int k = 0; k < 100; ++k) robot.look({});
    ASSERT_EQ(robot.filter.landmarkCount(), 1);
    EXPECT_NEAR(robot.filter.landmarks()[0].existence, before.existence, 1e-12);
    EXPECT_EQ(robot.filter.landmarks()[0].mean, before.mean);
}

TEST(ObjectLifeTest, TwoLandmarksOneMetreApartAreTwo) {
    // Deviations at 6 m: 0.1 m along, 0.12 m across. P_D 0.9, two in each of three pairs, 10 worlds.
    const std::vector<Vector2> places{{6, 0}, {6, 1}, {-4, 4}, {-4.7, 4.7}, {-6, 0.3}, {-5, 0.3}};
    for (int seed = 0; seed < 10; ++seed) {
        SCOPED_TRACE(seed);
        StandingRobot robot;
        robot.random = RandomStream(static_cast<std::uint64_t>(seed), RandomPurpose::test);
        for (int k = 0; k < 100; ++k) {
            StandingRobot::Scan scan;
            for (const Vector2& place : places)
                if (robot.random.uniform() < 0.9) scan.emplace_back(place, landmark);
            robot.look(scan, 1);
        }
        const auto found = robot.filter.landmarks();
        ASSERT_EQ(found.size(), places.size());
        for (const Vector2& place : places)
            EXPECT_EQ(std::count_if(found.begin(), found.end(),
                                    [&](const LandmarkEstimate& l) { return (l.mean - place).norm() < 0.2; }),
                      1);
    }
}

/// ObjectLife around landmarks and movers that a test puts into the state itself.
class Life {
  public:
    explicit Life(const JointFilterParameters& p = {})
        : parameters(p),
          belief(settingsFrom(p, {}), p.imm.form, p.imm.max_exact_targets),
          life(p.life, p.consistency, 3, 2, p.association.gate_probability),
          association_(p.association, p.life.landmarks, p.life.movers, p.consistency) {
        belief.start(makeJointBank(p.engine, {}, p.consistency, 1));
    }

    LandmarkId add(const Vector2& at, double deviation, SourceId named = {}) {
        const BlockId block = belief->addLandmark({at, Matrix2(deviation * deviation * Matrix2::Identity())});
        LandmarkRecord& record = objects.addLandmark(block, named, now);
        if (!named.valid()) {
            ObjectLifeRecord existing{landmark, Existence(parameters.life.landmarks), 0, now};
            existing.existence.detected(1e6);
            objects.giveLife(record, existing);
        }
        objects.place(block, at);
        return record.id;
    }
    void look(const std::vector<Vector2>& places) {
        now = later(now, 0.2);
        std::vector<RangeBearingDetection> detections;
        for (const Vector2& at : places) detections.push_back(test::seen({}, at, landmark, -1));
        DetectionSet set = test::detectionsAt(now.seconds(), detections);
        auto& seen = std::get<RangeBearingSet>(set.measurements);
        seen.sensors[0].max_range = 20;
        std::vector<Innovation> innovations(seen.detections.size());
        for (std::size_t i = 0; i < innovations.size(); ++i) innovations[i].detection = static_cast<int>(i);
        const AssociatedBatch batch = association_.associate(*belief, objects, seen, innovations);
        belief->update(batch.used, batch.known, innovations);
        for (const auto& sight : batch.known.landmarks)
            objects.markSeen(objects.landmarkOf(sight.block)->id, now);
        life.follow(belief, objects, batch, now, innovations);
    }

    JointFilterParameters parameters;
    ModalBelief belief;
    ObjectCatalogue objects;
    ObjectLife life;
    Stamp now;

  private:
    ObjectAssociation association_;
};

TEST(ObjectLifeTest, OneThatWasStartedTwiceIsMergedIntoTheOlder) {
    for (const auto engine : {JointEngine::Kind::dense, JointEngine::Kind::compressed}) {
        JointFilterParameters parameters;
        parameters.engine.kind = engine;
        Life run(parameters);
        run.add({-3, 0}, 0.1);
        const LandmarkId older = run.add({5, 0}, 0.1), younger = run.add({5.15, 0.1}, 0.1);
        run.objects.landmark(older)->seen = 7;
        run.objects.landmark(younger)->seen = 5;
        // A look that shows one of two says -log(2 * 0.1) = 1.6 for their being one; 0.99 needs log 99 = 4.6.
        for (int k = 1; k <= 3; ++k) {
            ASSERT_EQ(run.objects.landmarks().size(), 3u) << k;
            run.look({{5.1, 0.05}, {-3, 0}});
        }
        ASSERT_EQ(run.objects.landmarks().size(), 2u);
        ASSERT_TRUE(run.objects.landmark(older));
        EXPECT_EQ(run.objects.landmark(older)->seen, 7 + 5 + 3);
        EXPECT_TRUE(near(run.belief->mean(run.objects.landmark(older)->block), Vector2(5.1, 0.05), 0.01));
        EXPECT_EQ(run.belief->bank().dimension(), 3 + 4);
        run.look({{5.1, 0.05}, {-3, 0}});
        EXPECT_EQ(run.objects.landmark(older)->seen, 7 + 5 + 4);
    }
}

TEST(ObjectLifeTest, OfThoseMergedTheOneTheLogNamesStays) {
    for (const bool older_named : {true, false}) {
        Life run;
        const LandmarkId older = run.add({5, 0}, 0.1, SourceId{older_named ? 4 : -1});
        const LandmarkId younger = run.add({5.15, 0.1}, 0.1, SourceId{older_named ? -1 : 4});
        for (int k = 1; k <= 3; ++k) run.look({{5.1, 0.05}});
        ASSERT_EQ(run.objects.landmarks().size(), 1u);
        EXPECT_EQ(run.objects.landmarks()[0].id, older_named ? older : younger);
        EXPECT_EQ(run.objects.landmarkBySource({4}), &run.objects.landmarks()[0]);
        EXPECT_EQ(run.objects.landmarks()[0].seen, 2 + 3);
        EXPECT_FALSE(run.objects.living());
        run.look({{5.1, 0.05}});
        EXPECT_EQ(run.objects.landmarks()[0].seen, 2 + 4);
    }
}

TEST(ObjectLifeTest, ThreeThatAreOneBecomeOne) {
    Life run;
    const LandmarkId oldest = run.add({5, 0}, 0.1);
    run.add({5.1, 0.1}, 0.1);
    run.add({5.1, -0.1}, 0.1);
    for (int k = 1; k <= 12; ++k) run.look({{5.06, 0}});
    ASSERT_EQ(run.objects.landmarks().size(), 1u);
    EXPECT_EQ(run.objects.landmarks()[0].id, oldest);
    EXPECT_EQ(run.objects.landmarks()[0].seen, 3 + 12);
}

// --- movers
// -----------------------------------------------------------------------------------------------------

/// 1 m/s along x, seen from 0.2 s to 3 s, hidden for `hidden` seconds, then seen for 1.4 s; `others` lie
/// beside it, and do not come back.
std::vector<TrackEstimate> hideAndSeek(double hidden, const std::vector<double>& others,
                                       double sidestep = 0) {
    JointFilterParameters parameters;
    parameters.target_max_unseen = 1;
    StandingRobot robot(parameters);
    const auto at = [&](double beside) { return Vector2(-4 + robot.time() + 0.2, 3 + beside); };
    while (robot.time() < 2.9) {
        StandingRobot::Scan scan{{at(0), mover}};
        for (const double beside : others) scan.emplace_back(at(beside), mover);
        robot.look(scan);
    }
    EXPECT_EQ(robot.filter.tracks().size(), 1 + others.size());
    EXPECT_EQ(robot.filter.tracks()[0].id.value, 0);
    while (robot.time() < 2.9 + hidden) robot.look({});
    EXPECT_EQ(robot.filter.tracks().size(), 0u) << "ended after 1 s";
    while (robot.time() < 2.9 + hidden + 1.4) robot.look({{at(sidestep), mover}});
    return robot.filter.tracks();
}

TEST(ObjectLifeTest, AMoverThatComesBackAsExpectedIsKnownAgain) {
    const auto again = hideAndSeek(3, {});
    ASSERT_EQ(again.size(), 1u);
    EXPECT_EQ(again[0].id.value, 0);
    EXPECT_NEAR(again[0].mean(2), 1, 0.1);
}

TEST(ObjectLifeTest, AMoverThatComesBackElsewhereIsNew) {
    const auto elsewhere = hideAndSeek(3, {}, -12);
    ASSERT_EQ(elsewhere.size(), 1u);
    EXPECT_EQ(elsewhere[0].id.value, 1);
}

TEST(ObjectLifeTest, AMoverThatCouldBeEitherOfTwoIsNew) {
    const auto either = hideAndSeek(3, {0.8});
    ASSERT_EQ(either.size(), 1u);
    EXPECT_EQ(either[0].id.value, 2);
}

TEST(ObjectLifeTest, AMoverThatStaysAwayIsForgotten) {
    // Lost 1.2 s after it was seen, remembered for 10 s, confirmed again 0.4 s and more after it is back.
    const auto late = hideAndSeek(12, {});
    ASSERT_EQ(late.size(), 1u);
    EXPECT_EQ(late[0].id.value, 1);
}

TEST(ObjectLifeTest, BirthWithOrWithoutAVelocity) {
    for (const TrackBirth birth : {TrackBirth::one_point, TrackBirth::two_point}) {
        JointFilterParameters parameters;
        parameters.life.birth = birth;
        StandingRobot robot(parameters);
        while (robot.filter.tracks().empty() && robot.time() < 5)
            robot.look({{Vector2(-4 + 1.5 * (robot.time() + 0.2), 3), mover}});
        ASSERT_EQ(robot.filter.tracks().size(), 1u);
        const TrackEstimate born = robot.filter.tracks()[0];
        EXPECT_NEAR(born.mean(0), -4 + 1.5 * robot.time(), 0.1);
        if (birth == TrackBirth::one_point) {
            EXPECT_EQ(born.mean(2), 0);
            EXPECT_NEAR(born.covariance(2, 2), 9, 1e-12);
            EXPECT_NEAR(born.covariance(4, 4), 4, 1e-12);
            EXPECT_EQ(born.covariance(0, 2), 0);
        } else {
            // Two looks 0.2 s apart tell a velocity to 0.5 to 0.7 m/s.
            EXPECT_NEAR(born.mean(2), 1.5, 0.3);
            EXPECT_LT(born.covariance(2, 2), 1);
        }
    }
}

TEST(ObjectLifeTest, NoMoverIsSurerThanItsFloor) {
    for (const ImmForm form : {ImmForm::exact, ImmForm::scalable, ImmForm::decoupled})
        for (const std::string modes : {"", "cv:cv:0.01, ca:ca:0.01"})
            for (const double floor : {0.0, 0.05}) {
                SCOPED_TRACE(testing::Message() << static_cast<int>(form) << " " << modes);
                JointFilterParameters parameters;
                parameters.imm.form = form;
                if (!modes.empty()) parameters.imm.modes = test::immModes(modes).modes;
                parameters.target.noise_std = 0.01;
                parameters.target_position_floor = floor;
                StandingRobot robot(parameters);
                for (int k = 0; k < 60; ++k) robot.look({{{2, 1}, mover}});
                ASSERT_EQ(robot.filter.tracks().size(), 1u);
                const Matrix2 P = robot.filter.tracks()[0].covariance.topLeftCorner<2, 2>();
                const double least = std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix2>(P).eigenvalues()(0));
                if (floor > 0)
                    EXPECT_GE(least, floor * (1 - 1e-12));
                else
                    EXPECT_LT(least, 0.04) << "the floor is of no use here";
            }
}

// --- all that is expected of a scan
// ------------------------------------------------------------------------------

TEST(ObjectLifeTest, WhereNothingFalseAndNothingNewIsExpectedEverythingIsAnObject) {
    for (const auto movers : {MoverAssociation::nearest, MoverAssociation::gnn, MoverAssociation::jpda})
        for (const auto landmarks : {LandmarkAssociation::jcbb, LandmarkAssociation::gnn}) {
            JointFilterParameters parameters;
            parameters.association.movers = movers;
            parameters.association.landmarks = landmarks;
            for (LifeParameters* life : {&parameters.life.landmarks, &parameters.life.movers})
                life->clutter_per_scan = life->new_per_scan = 0;
            StandingRobot robot(parameters);
            for (int k = 0; k < 4; ++k) robot.look({{{5, 2}, landmark}, {{-3, 1}, mover}});
            ASSERT_EQ(robot.filter.landmarkCount(), 1);
            ASSERT_EQ(robot.filter.tracks().size(), 1u);
            EXPECT_EQ(robot.filter.landmarks()[0].seen, 4);
            EXPECT_DOUBLE_EQ(robot.filter.landmarks()[0].existence, 1);
            EXPECT_DOUBLE_EQ(robot.filter.tracks()[0].existence, 1);
        }
}

TEST(ObjectLifeTest, TheOrderOfModesIsNoMatterToMoversThatHaveNoneYet) {
    const auto run = [](const std::string& modes) {
        JointFilterParameters parameters;
        parameters.imm.modes = test::immModes(modes).modes;
        StandingRobot robot(parameters);
        for (int k = 0; k < 8; ++k)
            robot.look({{Vector2(-4 + 1.5 * robot.time(), 3 + 0.1 * robot.time() * robot.time()), mover}}, 1);
        return robot.filter.tracks().at(0);
    };
    const TrackEstimate one = run("cv:cv:0.3, ca:ca:2"), other = run("ca:ca:2, cv:cv:0.3");
    EXPECT_TRUE(near(one.mean, other.mean, 1e-10));
    EXPECT_TRUE(near(one.covariance, other.covariance, 1e-10));
    EXPECT_NEAR(one.existence, other.existence, 1e-10);
}

}  // namespace object_life_test
}  // namespace slamot
