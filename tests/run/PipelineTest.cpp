// Putting odometry and detections in step.
#include <gmock/gmock.h>

#include <cmath>

#include "run/Spy.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/run/Pipeline.h"
#include "support/Expect.h"

namespace slamot::test {
namespace pipeline_test {

using run::RunStatus;
using run::SensorRole;
using testing::HasSubstr;

/// Poses are composed from sines and cosines of a handful of angles: rounding only.
constexpr double rounding = 1e-14;

TEST_F(PipelineTest, AnOdometryEntryIsSplitWhereADetectionLies) {
    // A quarter turn to the left on a circle of radius 1 about (0, 1), within one second: at constant body
    // velocity the robot is an eighth of a turn along after half of it, at (sin 45 deg, 1 - cos 45 deg),
    // heading 45 deg.
    process({odometry(0, {}), detections(0.5, "landmarks", {{3, 0, 7}}), odometry(1, {1, 1, pi / 2})});
    ASSERT_EQ(spy->poses.size(), 1u);
    const Pose2 expected{std::sqrt(0.5), 1 - std::sqrt(0.5), pi / 4};
    EXPECT_TRUE(near(spy->poses[0].vector(), expected.vector(), rounding));
    EXPECT_EQ(spy->sets[0].stamp, at(0.5));

    ASSERT_EQ(spy->predictions.size(), 2u);
    EXPECT_EQ(spy->predictions[0].t1, at(0.5));
    EXPECT_EQ(spy->predictions[1].t0, at(0.5));
    EXPECT_EQ(spy->predictions[1].t1, at(1));
    // One draw of control noise holds over the whole entry: the pieces must say how long it was.
    EXPECT_DOUBLE_EQ(spy->predictions[0].entry_seconds, 1);
    EXPECT_DOUBLE_EQ(spy->predictions[1].entry_seconds, 1);
    EXPECT_TRUE(near(spy->robot().mean.vector(), Vector3(1, 1, pi / 2), rounding));
}

TEST_F(PipelineTest, SeveralDetectionsWithinOneEntryEachGetTheirPose) {
    process({odometry(0, {}), detections(0.25, "landmarks", {{3, 0}}),
             detections(0.75, "landmarks", {{3, 0}}), odometry(1, {4, 0, 0})});
    ASSERT_EQ(spy->poses.size(), 2u);
    EXPECT_NEAR(spy->poses[0].x, 1, rounding);  // 4 m/s for 0.25 s
    EXPECT_NEAR(spy->poses[1].x, 3, rounding);
}

TEST_F(PipelineTest, ADetectionAtAnOdometryStampUsesThatReading) {
    process({odometry(0, {}), odometry(1, {4, 0, 0}), detections(1, "landmarks", {{3, 0}}),
             odometry(2, {9, 0, 0})});
    ASSERT_EQ(spy->poses.size(), 1u);
    EXPECT_NEAR(spy->poses[0].x, 4, rounding);
    EXPECT_EQ(spy->predictions.size(), 2u);
}

TEST_F(PipelineTest, DetectionsWaitForOdometry) {
    push({odometry(0, {}), detections(0.5, "landmarks", {{3, 0}})});
    EXPECT_TRUE(spy->sets.empty());
    push({odometry(1, {1, 0, 0})});
    EXPECT_EQ(spy->sets.size(), 1u);
}

TEST_F(PipelineTest, ObservationsOfOneStampBecomeOneSetWithItsSensors) {
    process({odometry(0, {}), detections(0.5, "landmarks", {{3, 0.1, 7}, {4, 0.2, 8}}),
             detections(0.5, "movers", {{5, 0.3, 9}}), detections(0.6, "landmarks", {}), odometry(1, {})});
    ASSERT_EQ(spy->sets.size(), 2u);
    const RangeBearingSet& set = spy->sets[0].rangeBearing();
    ASSERT_EQ(set.sensors.size(), 2u);
    EXPECT_EQ(set.sensors[0].label, "landmarks");
    EXPECT_EQ(set.sensors[1].label, "movers");
    EXPECT_EQ(set.sensors[0].kind, ObjectKind::landmark);
    EXPECT_EQ(set.sensors[1].kind, ObjectKind::mover);
    ASSERT_EQ(set.detections.size(), 3u);
    EXPECT_EQ(set.detections[0].sensor, 0);
    EXPECT_EQ(set.detections[2].sensor, 1);
    EXPECT_EQ(set.detections[0].kind, ObjectKind::landmark);
    EXPECT_EQ(set.detections[2].kind, ObjectKind::mover);
    // A sensor that looked and saw nothing says so.
    EXPECT_TRUE(detectionsOf(spy->sets[1]).empty());
    EXPECT_EQ(pipeline->counts().detection_sets, 2);
    EXPECT_EQ(pipeline->counts().detections, 3);
}

TEST_F(PipelineTest, DetectionsAfterTheLastOdometryAreExtrapolatedUpToTheGapAndThenDropped) {
    config.max_odometry_gap = 1.0;
    process({odometry(0, {}), odometry(1, {2, 0, 0}), detections(1.5, "landmarks", {{3, 0}}),
             detections(1.75, "landmarks", {{3, 0}}), detections(2.25, "landmarks", {{3, 0}}),
             detections(9, "movers", {{3, 0}})});
    ASSERT_EQ(spy->poses.size(), 2u);
    EXPECT_NEAR(spy->poses[0].x, 3, rounding);    // 2 m/s for half a second more
    EXPECT_NEAR(spy->poses[1].x, 3.5, rounding);  // and for 0.75 s
    EXPECT_EQ(pipeline->counts().extrapolated, 2);
    // 2.25 is 1.25 s after the last odometry, though only 0.5 s after the last extrapolated detection.
    EXPECT_EQ(dropped("landmarks", "after-odometry"), 1);
    EXPECT_EQ(dropped("movers", "after-odometry"), 1);
}

TEST_F(PipelineTest, WithoutAnyMovementThereIsNothingToExtrapolate) {
    process({odometry(0, {}), detections(0, "landmarks", {{3, 0}}), detections(0.5, "landmarks", {{3, 0}})});
    EXPECT_EQ(spy->sets.size(), 1u);
    EXPECT_EQ(dropped("landmarks", "after-odometry"), 1);
}

TEST_F(PipelineTest, DetectionsBeforeTheFirstOdometryAreDropped) {
    process({detections(0.5, "landmarks", {{3, 0}}), detections(0.6, "landmarks", {{3, 0}}), odometry(1, {}),
             detections(1, "landmarks", {{3, 0}})});
    EXPECT_EQ(spy->sets.size(), 1u);
    EXPECT_EQ(dropped("landmarks", "before-odometry"), 2);
    EXPECT_EQ(spy->begin.stamp, at(1));
}

TEST_F(PipelineTest, DetectionsThatComeFirstButAtTheStartAreUsed) {
    process({detections(0.5, "landmarks", {{3, 0}}), detections(1, "landmarks", {{3, 0}}),
             detections(1, "movers", {{4, 0}}), odometry(1, {}), odometry(2, {2, 0, 0})});
    EXPECT_EQ(dropped("landmarks", "before-odometry"), 1);
    ASSERT_EQ(spy->sets.size(), 1u);
    EXPECT_EQ(spy->sets[0].stamp, at(1));
    EXPECT_EQ(detectionsOf(spy->sets[0]).size(), 2u);
    EXPECT_TRUE(near(spy->poses[0].vector(), Vector3(0, 0, 0), 0));
}

TEST_F(PipelineTest, DetectionsWaitThirtySecondsForOdometryToComeBack) {
    push({odometry(0, {}), odometry(1, {1, 0, 0}), detections(31, "landmarks", {{3, 0}}),
          detections(31.5, "landmarks", {{3, 0}}), detections(1000, "movers", {{3, 0}})});
    // Dropped at once, not held to the end.
    EXPECT_EQ(dropped("landmarks", "after-odometry"), 1);
    EXPECT_EQ(dropped("movers", "after-odometry"), 1);
    push({odometry(61, {61, 0, 0})});
    ASSERT_EQ(spy->poses.size(), 1u);
    EXPECT_NEAR(spy->poses[0].x, 31, 31 * rounding);  // 60 m in 60 s: half of the way after 30 s

    pipeline.reset();
    spy = std::make_shared<Spy>();
    config.max_odometry_gap = 40;
    push({odometry(0, {}), odometry(1, {1, 0, 0}), detections(41, "landmarks", {{3, 0}}),
          detections(41.5, "landmarks", {{3, 0}})});
    EXPECT_EQ(dropped("landmarks", "after-odometry"), 1);
}

TEST_F(PipelineTest, LongOdometryIntervalsAreBridgedAndCounted) {
    config.max_odometry_gap = 1.0;
    process({odometry(0, {}), odometry(1, {1, 0, 0}), odometry(3, {3, 0, 0}), odometry(3.5, {4, 0, 0}),
             odometry(9, {5, 0, 0})});
    EXPECT_EQ(pipeline->counts().odometry_gaps, 2);  // 1 to 3 and 3.5 to 9; 0 to 1 is exactly the limit
    EXPECT_EQ(pipeline->counts().odometry, 5);
    EXPECT_NEAR(spy->robot().mean.x, 5, rounding);
}

TEST_F(PipelineTest, TwoOdometriesNeedAChoice) {
    const auto error = messageOf<ConfigError>([&] {
        process({odometry(0, {}, "wheels"), odometry(0.5, {}, "visual")});
    });
    EXPECT_THAT(error, HasSubstr("'wheels'"));
    EXPECT_THAT(error, HasSubstr("'visual'"));
    EXPECT_THAT(error, HasSubstr("[run] odometry"));
}

TEST_F(PipelineTest, TheChosenOdometryIsUsedAndTheOtherCounted) {
    config.odometry = "visual";
    process({odometry(0, {}, "wheels"), odometry(0.5, {}, "visual"), odometry(1, {9, 0, 0}, "wheels"),
             odometry(1.5, {2, 0, 0}, "visual")});
    EXPECT_EQ(spy->begin.stamp, at(0.5));
    EXPECT_NEAR(spy->robot().mean.x, 2, rounding);
    EXPECT_EQ(dropped("wheels", "other-odometry"), 2);
}

TEST_F(PipelineTest, ADoubledOdometryStampIsDroppedAndNotCountedAsUsed) {
    process({odometry(0, {}), odometry(1, {1, 0, 0}), odometry(1, {7, 0, 0}), odometry(2, {2, 0, 0})});
    EXPECT_EQ(dropped("odometry", "same-stamp"), 1);
    EXPECT_EQ(pipeline->counts().odometry, 3);
    EXPECT_NEAR(spy->robot().mean.x, 2, rounding);
}

TEST_F(PipelineTest, OdometryWithoutTheFieldTheModelNeedsIsAnError) {
    spy->missing = "velocities";
    EXPECT_THAT(messageOf<ConfigError>([&] {
                    process({odometry(0, {}), odometry(1, {})});
                }),
                HasSubstr("velocities"));
}

TEST_F(PipelineTest, RolesComeFromTheLabelsOrTheConfig) {
    config.sensors.by_label = {{"camera", SensorRole::mixed},
                               {"beacons", SensorRole::landmarks},
                               {"people", SensorRole::movers},
                               {"movers", SensorRole::ignore}};
    process({odometry(0, {}), detections(0.1, "", {{3, 0, 1}}), detections(0.2, "beacons", {{3, 0, 2}}),
             detections(0.3, "people", {{3, 0, 3}}), detections(0.4, "camera", {{3, 0, 4}}),
             detections(0.5, "movers", {{3, 0, 5}}), detections(0.6, "radar", {{3, 0, 6}}),
             detections(0.7, "mixed", {{3, 0, 7}}), odometry(1, {})});
    ASSERT_EQ(spy->sets.size(), 5u);
    const ObjectKind expected[] = {ObjectKind::landmark, ObjectKind::landmark, ObjectKind::mover,
                                   ObjectKind::unknown, ObjectKind::unknown};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(detectionsOf(spy->sets[i])[0].kind, expected[i]) << i;
        EXPECT_EQ(spy->sets[i].rangeBearing().sensors[0].kind, expected[i]) << i;
    }
    // An identity means nothing before it is known whether it is a landmark's or a mover's.
    const std::int64_t ids[] = {1, 2, 3, -1, -1};
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(detectionsOf(spy->sets[i])[0].source.value, ids[i]) << i;
    EXPECT_EQ(dropped("movers", "role-ignore"), 1);
    EXPECT_EQ(dropped("radar", "no-role-in-[sensors]"), 1);
}

TEST_F(PipelineTest, ScansWithoutADetectorAndForeignClassesAreCounted) {
    process({odometry(0, {}), scan(0.5, "laser"), odometry(1, {})});
    EXPECT_EQ(dropped("laser", "no-detector"), 1);
    EXPECT_EQ(pipeline->counts().scans, 1);
}

TEST_F(PipelineTest, AScanIsLidarUnlessTheConfigSaysOtherwise) {
    config.sensors.by_label = {{"front", SensorRole::movers}, {"rear", SensorRole::ignore}};
    process({odometry(0, {}), scan(0.5, ""), scan(0.5, "landmarks"), scan(0.5, "front"), scan(0.5, "rear"),
             odometry(1, {})});
    // Taken for lidar, and missing nothing but a detector.
    EXPECT_EQ(dropped("", "no-detector"), 1);
    EXPECT_EQ(dropped("landmarks", "no-detector"), 1);
    EXPECT_EQ(dropped("front", "role-is-not-lidar"), 1);
    EXPECT_EQ(dropped("rear", "role-ignore"), 1);
}

TEST_F(PipelineTest, HiddenIdentitiesNeverReachTheEstimator) {
    for (const bool landmarks_hidden : {false, true})
        for (const bool movers_hidden : {false, true}) {
            pipeline.reset();
            spy = std::make_shared<Spy>();
            config.landmark_identities = landmarks_hidden ? run::Identities::hidden : run::Identities::log;
            config.mover_identities = movers_hidden ? run::Identities::hidden : run::Identities::log;
            process({odometry(0, {}), detections(0.5, "landmarks", {{3, 0, 7}}),
                     detections(0.5, "movers", {{4, 0, 8}}), odometry(1, {})});
            const auto& seen = detectionsOf(spy->sets.at(0));
            EXPECT_EQ(seen[0].source.value, landmarks_hidden ? -1 : 7);
            EXPECT_EQ(seen[1].source.value, movers_hidden ? -1 : 8);
        }
}

TEST_F(PipelineTest, UnusableReadingsAreDroppedOneByOneAndCounted) {
    const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
    process({odometry(0, {}),
             detections(0.5, "landmarks",
                        {{nan, 0}, {3, nan}, {inf, 0}, {3, -inf}, {0, 0}, {-2, 0}, {3, 0.25, 7}}),
             odometry(1, {})});
    ASSERT_EQ(detectionsOf(spy->sets.at(0)).size(), 1u);
    EXPECT_EQ(detectionsOf(spy->sets[0])[0].source.value, 7);
    EXPECT_EQ(dropped("landmarks", "not-finite"), 4);
    EXPECT_EQ(dropped("landmarks", "range-not-positive"), 2);
    EXPECT_EQ(pipeline->counts().detections, 1);
}

TEST_F(PipelineTest, BearingsAreWrapped) {
    process({odometry(0, {}), detections(0.5, "landmarks", {{3, 1.5 * pi}}), odometry(1, {})});
    // 270 deg is -90 deg; the log holds floats, half a unit in the last place of 4.7 is 2.4e-7.
    EXPECT_NEAR(detectionsOf(spy->sets.at(0))[0].bearing, -0.5 * pi, 2.4e-7);
}

TEST_F(PipelineTest, ATiltedSensorAndOdometryThatIsNotFiniteAreUnusable) {
    auto tilted = std::dynamic_pointer_cast<mrpt::obs::CObservationBearingRange>(
        detections(0.5, "landmarks", {{3, 0}}));
    tilted->sensorLocationOnRobot.setFromValues(0, 0, 0, 0, 0.5, 0);
    process({odometry(0, {}), tilted, odometry(0.6, {std::nan(""), 0, 0}), odometry(1, {1, 0, 0})});
    EXPECT_EQ(dropped("landmarks", "unusable"), 1);
    EXPECT_EQ(dropped("odometry", "unusable"), 1);
    EXPECT_THAT(pipeline->firstUnusable(), HasSubstr("'landmarks'"));
    EXPECT_NEAR(spy->robot().mean.x, 1, rounding);
}

TEST_F(PipelineTest, AnErrorOfASinkIsNoFaultOfTheLog) {
    struct FullDisk : run::Sink {
        void step(const run::Step&) override { throw LogError("the disk is full"); }
    } full;
    spy->initialize(Config());
    pipeline =
        std::make_unique<run::Pipeline>(config, *spy, nullptr, nullptr, 1, std::vector<run::Sink*>{&full});
    EXPECT_EQ(messageOf<LogError>([&] {
                  push({odometry(0, {}), odometry(1, {1, 0, 0})});
              }),
              "the disk is full");
}

TEST_F(PipelineTest, StartPoses) {
    config.seed = 77;
    config.start.position_std = 0.5;
    config.start.heading_std = 0.25;
    process({odometry(0, {5, 5, 1})});
    EXPECT_TRUE(near(spy->begin.pose.mean.vector(), Vector3(0, 0, 0), 0));
    EXPECT_TRUE(near(spy->begin.pose.covariance.diagonal(), Vector3(0.25, 0.25, 0.0625), 0));
    EXPECT_EQ(spy->begin.seed, 77u);

    pipeline.reset();
    config.start.kind = run::StartPose::given;
    config.start.pose = {1, 2, 3};
    process({odometry(0, {5, 5, 1})});
    EXPECT_TRUE(near(spy->begin.pose.mean.vector(), Vector3(1, 2, 3), 0));
}

TEST_F(PipelineTest, TheTrueStartPoseIsThatOfTheFirstOdometry) {
    config.start.kind = run::StartPose::truth;
    Truth known;
    known.robot = {{at(0.95), {1, 0, 0.2}}, {at(1.05), {2, 4, 0.4}}};
    truth = &known;
    process({odometry(1, {})});
    // Half way between the neighbours; interpolation weighs ticks, so rounding only.
    EXPECT_TRUE(near(spy->begin.pose.mean.vector(), Vector3(1.5, 2, 0.3), 1e-12));

    pipeline.reset();
    EXPECT_THAT(messageOf<ConfigError>([&] { process({odometry(7, {})}); }),
                HasSubstr("the truth has no robot pose"));
    pipeline.reset();
    for (TruePose& sample : known.robot) sample.pose.theta = std::nan("");
    EXPECT_THAT(messageOf<ConfigError>([&] { process({odometry(1, {})}); }),
                HasSubstr("the truth has no heading of the robot"));
    pipeline.reset();
    truth = nullptr;
    EXPECT_THAT(messageOf<ConfigError>([&] { process({odometry(1, {})}); }), HasSubstr("no truth was given"));
}

OdometryIncrement increment(double t0, double t1, double x) {
    OdometryIncrement out;
    out.t0 = at(t0);
    out.t1 = at(t1);
    out.increment = {x, 0, 0};
    out.entry_seconds = t1 - t0;
    return out;
}

LogEntry entryOf(const OdometryIncrement& movement) {
    return {movement.t1, nullptr, movement, 0};
}

TEST_F(PipelineTest, ActionFrameIncrementsMoveTheRobot) {
    begin();
    pipeline->push(entryOf(increment(0, 1, 2)));
    pipeline->push(test::entryOf(detections(1, "", {{3, 0, 1}})));
    pipeline->push(entryOf(increment(1, 2, 3)));
    pipeline->push(test::entryOf(detections(2, "", {{3, 0, 1}})));
    pipeline->finish(RunStatus::complete);
    ASSERT_EQ(spy->poses.size(), 2u);
    EXPECT_NEAR(spy->poses[0].x, 2, rounding);
    EXPECT_NEAR(spy->poses[1].x, 5, rounding);
    EXPECT_EQ(spy->begin.stamp, at(0));
    EXPECT_EQ(pipeline->counts().odometry, 2);
}

TEST_F(PipelineTest, ASensoryFrameBeforeTheFirstActionLiesAtTheStart) {
    begin();
    pipeline->push(test::entryOf(detections(0, "", {{3, 0, 1}})));
    pipeline->push(entryOf(increment(0, 1, 2)));
    pipeline->push(test::entryOf(detections(1, "", {{3, 0, 1}})));
    pipeline->finish(RunStatus::complete);
    ASSERT_EQ(spy->poses.size(), 2u);
    EXPECT_NEAR(spy->poses[0].x, 0, rounding);
    EXPECT_NEAR(spy->poses[1].x, 2, rounding);
    EXPECT_EQ(pipeline->drops().total(), 0);
}

TEST_F(PipelineTest, AFrameWithoutAMovementIsAStandstillAndCounted) {
    begin();
    pipeline->push(entryOf(increment(0, 1, 2)));
    pipeline->push(test::entryOf(detections(2, "", {{3, 0, 1}})));  // the frame at 2 has no action
    pipeline->push(entryOf(increment(2, 3, 4)));
    pipeline->push(test::entryOf(detections(3, "", {{3, 0, 1}})));
    pipeline->finish(RunStatus::complete);
    ASSERT_EQ(spy->poses.size(), 2u);
    EXPECT_NEAR(spy->poses[0].x, 2, rounding);
    EXPECT_NEAR(spy->poses[1].x, 6, rounding);
    EXPECT_EQ(pipeline->counts().odometry_gaps, 1);
}

TEST_F(PipelineTest, AfterAFailureEverySinkIsEndedOnceWithTheLastGoodStep) {
    struct AsksTooMuch : run::Sink {
        void step(const run::Step&) override {}
        void end(const run::RunEnd&) override { throw EstimatorError("no joint covariance"); }
    } asking;
    spy->initialize(Config());
    CollectingSink before, after;
    pipeline = std::make_unique<run::Pipeline>(config, *spy, nullptr, nullptr, 1,
                                               std::vector<run::Sink*>{&before, &asking, &after});
    push({odometry(0, {}), odometry(1, {1, 0, 0})});
    EXPECT_THROW(pipeline->finish(RunStatus::complete), EstimatorError);
    pipeline->fail();
    EXPECT_EQ(before.ends.size(), 1u);
    ASSERT_EQ(after.ends.size(), 1u);
    EXPECT_EQ(after.ends[0].status, RunStatus::failed);
    EXPECT_EQ(after.ends[0].estimate.stamp, at(1));
    EXPECT_EQ(after.ends[0].estimator, nullptr);
}

TEST_F(PipelineTest, CpuTimeIsCountedByStageWhateverThreadUsedIt) {
    spy->burn = 0.02;
    threads = 2;
    process({odometry(0, {}), detections(0.5, "landmarks", {{3, 0}}), detections(0.6, "landmarks", {{3, 0}}),
             odometry(1, {1, 0, 0})});
    const run::StageTimes& times = pipeline->counts().times;
    // Two updates burn 0.02 s each. CPU clocks tick in ns, so the sum may be short by rounding only.
    EXPECT_GE(times.update_cpu, 0.0399);
    EXPECT_GT(times.predict_cpu, 0);
    EXPECT_LT(times.predict_cpu, times.update_cpu);
    EXPECT_EQ(times.detect_cpu, 0);
}

// Studies run many pipelines at the same time: what other threads of the process do is not this run's.
TEST_F(PipelineTest, CpuTimeOfAnEstimatorWithOneThreadIsThatThreads) {
    spy->burn = 0.02;
    process({odometry(0, {}), detections(0.5, "landmarks", {{3, 0}}), odometry(1, {1, 0, 0})});
    EXPECT_LT(pipeline->counts().times.update_cpu, 0.01);
}

TEST_F(PipelineTest, OneStepPerStampAndOneEnd) {
    process({odometry(0, {}), detections(0.5, "landmarks", {{3, 0}}), odometry(1, {1, 0, 0}),
             detections(1, "landmarks", {{3, 0}}), odometry(2, {2, 0, 0})});
    ASSERT_EQ(sink.steps.size(), 4u);
    const double stamps[] = {0, 0.5, 1, 2};
    const bool with_detections[] = {false, true, true, false};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(sink.steps[i].estimate.stamp, at(stamps[i])) << i;
        EXPECT_EQ(sink.steps[i].has_detections, with_detections[i]) << i;
        EXPECT_EQ(sink.steps[i].estimator, spy.get()) << i;
    }
    ASSERT_EQ(sink.ends.size(), 1u);
    EXPECT_EQ(sink.observations, 5);
}

}  // namespace pipeline_test
}  // namespace slamot::test
