#include <gtest/gtest.h>

#include "Builders.h"
#include "slamot/eval/SetDistance.h"

namespace slamot::eval {
namespace set_distance_test {

TEST(SetDistance, ByHand) {
    // Estimates (0,1), (10,0), (50,0); truths (0,0), (13,0). Order 2, cutoff 5.
    // Pairs: 1 m and 3 m. OSPA over 3: localisation (1 + 9) / 3, cardinality 25 / 3.
    // GOSPA: 1 + 9, none missed, one false 25 / 2.
    const SetDistance d = setDistance({{0, 1}, {10, 0}, {50, 0}}, {{0, 0}, {13, 0}}, 2, 5);
    EXPECT_DOUBLE_EQ(d.ospa.total, std::sqrt(35.0 / 3));
    EXPECT_DOUBLE_EQ(d.ospa.localisation, std::sqrt(10.0 / 3));
    EXPECT_DOUBLE_EQ(d.ospa.cardinality, std::sqrt(25.0 / 3));
    EXPECT_DOUBLE_EQ(d.gospa.total, std::sqrt(22.5));
    EXPECT_DOUBLE_EQ(d.gospa.localisation_part, 10);
    EXPECT_DOUBLE_EQ(d.gospa.missed_part, 0);
    EXPECT_DOUBLE_EQ(d.gospa.false_part, 12.5);
    EXPECT_EQ(d.gospa.matched_count, 2);
    EXPECT_EQ(d.gospa.false_count, 1);
}

TEST(SetDistance, FarPairsAreOneMissedAndOneFalse) {
    // One estimate 40 m from the one truth, order 1, cutoff 8: OSPA 8, all localisation; GOSPA 4 missed + 4
    // false.
    const SetDistance d = setDistance({{0, 0}}, {{40, 0}}, 1, 8);
    EXPECT_DOUBLE_EQ(d.ospa.total, 8);
    EXPECT_DOUBLE_EQ(d.ospa.cardinality, 0);
    EXPECT_DOUBLE_EQ(d.gospa.total, 8);
    EXPECT_DOUBLE_EQ(d.gospa.missed_part, 4);
    EXPECT_DOUBLE_EQ(d.gospa.false_part, 4);
    EXPECT_EQ(d.gospa.matched_count, 0);
}

TEST(SetDistance, AssignsTheWholeSetNotTheNearest) {
    // Estimates 1 and 2, truths 2 and 5: greedy takes 2-2 (0) and 1-5 (16); the optimum is 1-2 and 2-5: 1
    // + 9.
    const double expected = std::sqrt(10.0 / 2);
    EXPECT_DOUBLE_EQ(setDistance({{1, 0}, {2, 0}}, {{2, 0}, {5, 0}}, 2, 10).ospa.total, expected);
    EXPECT_DOUBLE_EQ(setDistance({{1, 0}, {2, 0}}, {{5, 0}, {2, 0}}, 2, 10).ospa.total, expected);
}

TEST(SetDistance, EmptySets) {
    EXPECT_DOUBLE_EQ(setDistance({}, {}, 2, 5).ospa.total, 0);
    EXPECT_DOUBLE_EQ(setDistance({}, {}, 2, 5).gospa.total, 0);
    const SetDistance d = setDistance({}, {{0, 0}, {1, 0}}, 2, 6);
    EXPECT_DOUBLE_EQ(d.ospa.total, 6);
    EXPECT_DOUBLE_EQ(d.ospa.cardinality, 6);
    // Two missed: 2 x 36 / 2.
    EXPECT_DOUBLE_EQ(d.gospa.total, 6);
    EXPECT_EQ(d.gospa.missed_count, 2);
}

TEST(TrackSetDistance, MeansOverStampsWithoutGaps) {
    RunRecord run;
    for (const double t : {0.0, 0.1, 0.5, 1.0}) run.trajectory.push_back(row(t, 0, 0, 0));
    run.tracks[at(0.0)] = {track(0, -1, 1, 0)};
    TrackEstimate unlikely = track(1, -1, 99, 0);
    unlikely.existence = 0.4;
    run.tracks[at(0.1)] = {track(0, -1, 3, 0), unlikely};
    Truth truth;
    truth.targets[SourceId{7}] = {trueTarget(0, 0, 0), trueTarget(0.1, 0, 0), trueTarget(1, 0, 0)};
    EvaluationOptions options;
    options.set_order = 1;
    options.set_cutoff = 6;
    // 0.5 s lies in truth's gap. OSPA 1, 3 and, with no track at 1 s, 6: mean 10 / 3.
    // GOSPA 1, 3, 3: mean 7 / 3, missed part 3 at the last: mean 1.
    const auto d = trackSetDistance(run, truth, options);
    ASSERT_TRUE(d);
    EXPECT_EQ(d->stamps, 3);
    EXPECT_EQ(d->stamps_in_gaps, 1);
    EXPECT_NEAR(d->mean.ospa.total, 10.0 / 3, 1e-14);
    EXPECT_NEAR(d->mean.gospa.total, 7.0 / 3, 1e-14);
    EXPECT_NEAR(d->mean.gospa.missed_part, 1, 1e-14);
    EXPECT_NEAR(d->mean.gospa.matched_count, 2.0 / 3, 1e-14);
}

TEST(TrackSetDistance, SaysWhatIsMissing) {
    RunRecord run;
    EXPECT_EQ(trackSetDistance(run, {}, {}).whyAbsent(), "truth has no targets");
    Truth truth;
    truth.targets[SourceId{7}] = {trueTarget(0, 0, 0), trueTarget(9, 0, 0)};
    EXPECT_EQ(trackSetDistance(run, truth, {}).whyAbsent(), "the run has no trajectory");
    run.trajectory = {row(4, 0, 0, 0)};
    EXPECT_EQ(trackSetDistance(run, truth, {}).whyAbsent(),
              "truth of the targets has a gap at every stamp of the run");
}

TEST(TrackSetDistance, ARunWithoutTracksHasMissedAll) {
    RunRecord run;
    run.trajectory = {row(0, 0, 0, 0), row(1, 0, 0, 0)};
    Truth truth;
    truth.targets[SourceId{7}] = {trueTarget(0, 0, 0), trueTarget(1, 0, 0)};
    truth.targets[SourceId{8}] = {trueTarget(0, 9, 0), trueTarget(1, 9, 0)};
    // Order 2, cutoff 5. OSPA: sqrt((0 + 2 x 25) / 2); GOSPA: sqrt(2 x 25 / 2).
    const auto d = trackSetDistance(run, truth, {});
    ASSERT_TRUE(d);
    EXPECT_EQ(d->stamps, 2);
    EXPECT_DOUBLE_EQ(d->mean.ospa.total, 5);
    EXPECT_DOUBLE_EQ(d->mean.ospa.cardinality, 5);
    EXPECT_DOUBLE_EQ(d->mean.gospa.total, 5);
    EXPECT_EQ(d->mean.gospa.missed_count, 2);
}

TEST(LandmarkSetDistance, OfTheFinalMap) {
    RunRecord run;
    run.landmarks = {landmark(0, -1, 0, 3)};
    Truth truth;
    truth.landmarks[SourceId{5}] = {0, 0};
    truth.landmarks[SourceId{6}] = {100, 0};
    // Order 2, cutoff 5: 9 + 25 / 2.
    const auto d = landmarkSetDistance(run, truth, {});
    ASSERT_TRUE(d);
    EXPECT_DOUBLE_EQ(d->gospa.total, std::sqrt(21.5));
    EXPECT_DOUBLE_EQ(d->ospa.total, std::sqrt((9.0 + 25.0) / 2));
}

}  // namespace set_distance_test
}  // namespace slamot::eval
