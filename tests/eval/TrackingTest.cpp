#include <gtest/gtest.h>

#include <cmath>

#include "Builders.h"
#include "slamot/eval/Tracking.h"

namespace slamot::eval {
namespace tracking_test {

constexpr double gate = 1;

/// Targets and tracks on a line; an absent one is left out of the braces.
SceneFrame frame(double t, std::vector<std::pair<int, double>> targets,
                 std::vector<std::pair<int, double>> tracks) {
    SceneFrame f{at(t), {}, {}};
    for (const auto& [index, x] : targets) f.targets.push_back({index, {x, 0}});
    for (const auto& [index, x] : tracks) f.tracks.push_back({index, {x, 0}});
    return f;
}

TrackingScene scene(int targets, int tracks, std::vector<SceneFrame> frames) {
    TrackingScene s;
    s.frames = std::move(frames);
    s.targets = targets;
    s.tracks = tracks;
    return s;
}

TEST(ClearMot, ByHand) {
    // Target 0 at 0 m for 5 stamps, target 1 at 10 m for the last 3. Track 0 follows target 0 at 0.5 m, is
    // out of the gate at the third stamp, then track 1 takes over at 0.25 m; a false track at 50 m at the
    // first.
    const ClearMot m =
        clearMot(scene(2, 3,
                       {frame(0, {{0, 0}}, {{0, 0.5}, {2, 50}}), frame(1, {{0, 0}}, {{0, 0.5}}),
                        frame(2, {{0, 0}, {1, 10}}, {{0, 1.5}}), frame(3, {{0, 0}, {1, 10}}, {{1, 0.25}}),
                        frame(4, {{0, 0}, {1, 10}}, {{1, 0.25}})}),
                 gate);
    EXPECT_EQ(m.target_stamps, 8);
    EXPECT_EQ(m.matched, 4);
    EXPECT_EQ(m.misses, 4);           // target 0 once, target 1 three times
    EXPECT_EQ(m.false_positives, 2);  // at 50 m, and track 0 at 1.5 m
    EXPECT_EQ(m.switches, 1);
    EXPECT_EQ(m.fragmentations, 1);
    EXPECT_DOUBLE_EQ(m.mota, 1 - (4 + 2 + 1) / 8.0);
    EXPECT_DOUBLE_EQ(m.motp, (0.5 + 0.5 + 0.25 + 0.25) / 4);
    EXPECT_EQ(m.mostly_tracked, 1);  // 4 of 5 is 80 %
    EXPECT_EQ(m.partly_tracked, 0);
    EXPECT_EQ(m.mostly_lost, 1);
}

TEST(ClearMot, KeepsACorrespondenceThatHoldsThoughAnotherIsNearer) {
    // Track 1 comes nearer than track 0 at the second stamp: no switch while track 0 is within the gate.
    const ClearMot kept = clearMot(
        scene(1, 2, {frame(0, {{0, 0}}, {{0, 0.5}}), frame(1, {{0, 0}}, {{0, 0.9}, {1, 0.1}})}), gate);
    EXPECT_EQ(kept.switches, 0);
    EXPECT_EQ(kept.false_positives, 1);
    EXPECT_DOUBLE_EQ(kept.motp, (0.5 + 0.9) / 2);
    const ClearMot lost = clearMot(
        scene(1, 2, {frame(0, {{0, 0}}, {{0, 0.5}}), frame(1, {{0, 0}}, {{0, 1.1}, {1, 0.1}})}), gate);
    EXPECT_EQ(lost.switches, 1);
}

TEST(ClearMot, CountsAnExchangeOfTwoTracksTwice) {
    const ClearMot m = clearMot(
        scene(2, 2,
              {frame(0, {{0, 0}, {1, 5}}, {{0, 0}, {1, 5}}), frame(1, {{0, 0}, {1, 5}}, {{1, 0}, {0, 5}})}),
        gate);
    EXPECT_EQ(m.switches, 2);
    EXPECT_EQ(m.misses + m.false_positives, 0);
    EXPECT_EQ(m.fragmentations, 0);
    EXPECT_DOUBLE_EQ(m.mota, 0.5);
}

TEST(ClearMot, GoesOnWithTheOldTrackAfterAPause) {
    // The target is missed at stamp 1; at stamp 2 its old track, 0.8 m off, goes before a new one at 0.1 m.
    const ClearMot m = clearMot(scene(1, 2,
                                      {frame(0, {{0, 0}}, {{0, 0}}), frame(1, {{0, 0}}, {}),
                                       frame(2, {{0, 0}}, {{0, 0.8}, {1, 0.1}})}),
                                gate);
    EXPECT_EQ(m.switches, 0);
    EXPECT_EQ(m.fragmentations, 1);
    EXPECT_EQ(m.false_positives, 1);
}

TEST(ClearMot, TheNewerOfTwoClaimsToATrackHolds) {
    // Track 0 was target 0's, then target 1's. At stamp 2 both are within its gate: target 1 keeps it, though
    // target 0 is nearer.
    const ClearMot m = clearMot(scene(2, 1,
                                      {frame(0, {{0, 0}}, {{0, 0}}), frame(1, {{1, 3}}, {{0, 3}}),
                                       frame(2, {{0, 2.9}, {1, 3.5}}, {{0, 3}})}),
                                gate);
    EXPECT_EQ(m.switches, 0);
    EXPECT_EQ(m.misses, 1);
    EXPECT_DOUBLE_EQ(m.motp, 0.5 / 3);
}

TEST(ClearMot, WithoutTargetsHasNoRatio) {
    const ClearMot m = clearMot(scene(0, 1, {frame(0, {}, {{0, 0}})}), gate);
    EXPECT_TRUE(std::isnan(m.mota));
    EXPECT_TRUE(std::isnan(m.motp));
    EXPECT_EQ(m.false_positives, 1);
}

TEST(IdentityScores, ByHand) {
    // Target 0 for 5 stamps: track 0 for the first 2, track 1 for the last 3, which also has 1 stamp alone at
    // the first. The best one track is 1: 3 true positives; 5 - 3 missed, 6 - 3 false.
    const IdentityScores s = identityScores(
        scene(1, 2,
              {frame(0, {{0, 0}}, {{0, 0.5}, {1, 9}}), frame(1, {{0, 0}}, {{0, 0.5}}),
               frame(2, {{0, 0}}, {{1, 0.5}}), frame(3, {{0, 0}}, {{1, 0.5}}), frame(4, {{0, 0}}, {{1, 1}})}),
        gate);
    EXPECT_EQ(s.true_positives, 3);
    EXPECT_EQ(s.false_negatives, 2);
    EXPECT_EQ(s.false_positives, 3);
    EXPECT_DOUBLE_EQ(s.recall, 3 / 5.0);
    EXPECT_DOUBLE_EQ(s.precision, 3 / 6.0);
    EXPECT_DOUBLE_EQ(s.idf1, 6 / 11.0);
}

TEST(IdentityScores, AssignsWholeTracksAtTheMostStampsTogether) {
    // Track 0 is 3 stamps with target 0 and 2 with target 1, track 1 is 2 with target 0 and none with target
    // 1: pairs 0-1 and 1-0 have 4 stamps, 0-0 alone 3.
    const auto s =
        identityScores(scene(2, 2,
                             {frame(0, {{0, 0}, {1, 0}}, {{0, 0}}), frame(1, {{0, 0}, {1, 0}}, {{0, 0}}),
                              frame(2, {{0, 0}, {1, 9}}, {{0, 0}}), frame(3, {{0, 0}, {1, 9}}, {{1, 0}}),
                              frame(4, {{0, 0}, {1, 9}}, {{1, 0}})}),
                       gate);
    EXPECT_EQ(s.true_positives, 4);
    EXPECT_DOUBLE_EQ(s.idf1, 8.0 / (10 + 5));
}

TEST(IdentityScores, MoreTracksWithoutATargetDoNotCostTruePositives) {
    // A second track that is never near must not push out the pair for the sake of one more pair.
    const auto s = identityScores(scene(1, 2, {frame(0, {{0, 0}}, {{0, 0}, {1, 9}})}), gate);
    EXPECT_EQ(s.true_positives, 1);
    EXPECT_EQ(s.false_positives, 1);
    EXPECT_EQ(identityScores(scene(1, 0, {frame(0, {{0, 0}}, {})}), gate).false_negatives, 1);
}

TEST(CardinalityError, OverStamps) {
    // Errors +2, -1, 0, 0.
    const CardinalityError e = cardinalityError(scene(1, 3,
                                                      {frame(0, {}, {{0, 0}, {1, 0}}), frame(1, {{0, 0}}, {}),
                                                       frame(2, {}, {}), frame(3, {{0, 0}}, {{2, 9}})}));
    EXPECT_DOUBLE_EQ(e.mean, 0.25);
    EXPECT_DOUBLE_EQ(e.mean_absolute, 0.75);
    EXPECT_DOUBLE_EQ(e.mean_targets, 0.5);
    EXPECT_DOUBLE_EQ(e.mean_tracks, 0.75);
}

/// Target 7 for 5 stamps of 1 s, detected at 1, 2 and 3 s; target 8 never detected. Track 3 on target 7 for
/// all stamps, track 4 on target 8, track 5 on nothing.
struct Scene {
    RunRecord run;
    Truth truth;
    EvaluationOptions options;

    Scene() {
        for (int i = 0; i < 5; ++i) {
            run.trajectory.push_back(row(i, 0, 0, 0));
            run.tracks[at(i)] = {track(3, -1, 0.5, 0), track(4, -1, 20, 0), track(5, -1, 50, 0)};
            truth.targets[SourceId{7}].push_back(trueTarget(i, 0, 0));
            truth.targets[SourceId{8}].push_back(trueTarget(i, 20, 0));
        }
        for (const double t : {2.0, 1.0, 3.0, 99.0})
            truth.associations.push_back({at(t), 0, "mover", SourceId{7}});
        // A landmark of the same number is another thing.
        truth.associations.push_back({at(0), 0, "landmark", SourceId{8}});
        options.target_gate = gate;
    }
};

TEST(SceneOfAllTargets, HasEveryTargetAndLikelyTrack) {
    Scene s;
    s.run.tracks[at(4)].back().existence = 0.4;
    const auto all = sceneOfAllTargets(s.run, s.truth, s.options);
    ASSERT_TRUE(all);
    ASSERT_EQ(all->frames.size(), 5u);
    EXPECT_EQ(all->targets, 2);
    EXPECT_EQ(all->tracks, 3);
    EXPECT_EQ(all->frames[0].targets[1].index, 1);
    EXPECT_EQ(all->frames[0].targets[1].position, Vector2(20, 0));
    EXPECT_EQ(all->frames[0].tracks.size(), 3u);
    EXPECT_EQ(all->frames[4].tracks.size(), 2u);
}

TEST(SceneOfSeenTargets, SetsAsideWhatFollowsTargetsThatDoNotCount) {
    const Scene s;
    const auto seen = sceneOfSeenTargets(s.run, s.truth, s.options);
    ASSERT_TRUE(seen);
    // Target 7 counts at 1, 2 and 3 s; track 3 is set aside at 0 and 4 s, track 4 always, track 5 never.
    for (const std::size_t k : {0u, 4u}) {
        EXPECT_TRUE(seen->frames[k].targets.empty());
        EXPECT_EQ(seen->frames[k].tracks.size(), 1u);
    }
    for (const std::size_t k : {1u, 2u, 3u}) {
        EXPECT_EQ(seen->frames[k].targets.size(), 1u);
        EXPECT_EQ(seen->frames[k].tracks.size(), 2u);
    }
    EXPECT_EQ(seen->set_aside, 5 + 2);
    const ClearMot m = clearMot(*seen, gate);
    EXPECT_EQ(m.misses, 0);
    EXPECT_EQ(m.false_positives, 5);
}

TEST(SceneOfSeenTargets, SaysWhatIsMissing) {
    Scene s;
    s.truth.associations = {{at(0), 0, "clutter", SourceId{}}};
    EXPECT_EQ(sceneOfSeenTargets(s.run, s.truth, s.options).whyAbsent(),
              "no target was seen, say truth's associations");
    s.truth.associations.clear();
    EXPECT_EQ(sceneOfSeenTargets(s.run, s.truth, s.options).whyAbsent(),
              "truth has no associations, which would tell when a target was seen");
    s.truth.targets.clear();
    EXPECT_EQ(trackingMetrics(sceneOfSeenTargets(s.run, s.truth, s.options), s.options).whyAbsent(),
              "truth has no targets");
}

TEST(TrackingMetrics, OfARunWithoutTracks) {
    Scene s;
    s.run.tracks.clear();
    const auto m = trackingMetrics(sceneOfAllTargets(s.run, s.truth, s.options), s.options);
    ASSERT_TRUE(m);
    EXPECT_EQ(m->clear.mota, 0);
    EXPECT_EQ(m->identity.idf1, 0);
    EXPECT_TRUE(std::isnan(m->identity.precision));
    EXPECT_EQ(m->cardinality.mean, -2);
    // Two missed of 25 / 2 each.
    EXPECT_DOUBLE_EQ(m->trajectories.per_stamp, 5);
}

}  // namespace tracking_test
}  // namespace slamot::eval
