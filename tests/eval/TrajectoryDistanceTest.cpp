#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "Builders.h"
#include "slamot/core/random/RandomStream.h"
#include "slamot/eval/TrajectoryDistance.h"

namespace slamot::eval {
namespace trajectory_distance_test {

/// Positions on a line by stamp; NaN where the object is not there.
using Line = std::vector<double>;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

TrackingScene lines(const std::vector<Line>& targets, const std::vector<Line>& tracks) {
    TrackingScene scene;
    scene.targets = static_cast<int>(targets.size());
    scene.tracks = static_cast<int>(tracks.size());
    for (std::size_t k = 0; k < targets.at(0).size(); ++k) {
        SceneFrame frame{at(static_cast<double>(k)), {}, {}};
        for (std::size_t i = 0; i < targets.size(); ++i)
            if (!std::isnan(targets[i][k]))
                frame.targets.push_back({static_cast<int>(i), {targets[i][k], 0}});
        for (std::size_t j = 0; j < tracks.size(); ++j)
            if (!std::isnan(tracks[j][k])) frame.tracks.push_back({static_cast<int>(j), {tracks[j][k], 0}});
        scene.frames.push_back(frame);
    }
    return scene;
}

TEST(TrajectoryDistance, WithoutASwitchIsTheSumOfGospa) {
    // Order 2, cutoff 5: 1 + 9 at the pairs, one missed and one false of 12.5 each at the last stamp.
    const auto d = trajectoryDistance(lines({{0, 0, 0}}, {{1, 3, 9}}), 2, 5, 1);
    EXPECT_DOUBLE_EQ(d.total, std::sqrt(1 + 9 + 25.0));
    EXPECT_EQ(d.switches, 0);
    EXPECT_EQ(d.lower_bound, d.total);
    EXPECT_DOUBLE_EQ(d.per_stamp, std::sqrt(35.0 / 3));
    EXPECT_DOUBLE_EQ(d.localisation_part, 10.0 / 3);
    EXPECT_DOUBLE_EQ(d.missed_part, 12.5 / 3);
    EXPECT_DOUBLE_EQ(d.false_part, 12.5 / 3);
    EXPECT_EQ(d.switch_part, 0);
}

TEST(TrajectoryDistance, ANewTrackIsASwitch) {
    // Track 0 for two stamps, then track 1: exact places, so the switch alone costs, gamma^p = 9.
    const auto d =
        trajectoryDistance(lines({{0, 0, 0, 0}}, {{0, 0, none, none}, {none, none, 0, 0}}), 2, 5, 3);
    EXPECT_DOUBLE_EQ(d.total, 3);
    EXPECT_EQ(d.switches, 1);
    EXPECT_DOUBLE_EQ(d.switch_part, 9.0 / 4);
}

TEST(TrajectoryDistance, ASwitchDearerThanWhatItSavesIsNotMade) {
    // Two stamps of the second track save 2 x 25; the switch costs 49 or 64. Not made, two missed and two
    // false cost 50.
    const auto scene = lines({{0, 0, 0, 0}}, {{0, 0, none, none}, {none, none, 0, 0}});
    EXPECT_DOUBLE_EQ(trajectoryDistance(scene, 2, 5, 7).total, 7);
    EXPECT_DOUBLE_EQ(trajectoryDistance(scene, 2, 5, 8).total, std::sqrt(50.0));
    EXPECT_EQ(trajectoryDistance(scene, 2, 5, 8).switches, 0);
}

TEST(TrajectoryDistance, TwoTracksThatChangePlacesAreTwoSwitches) {
    const auto d = trajectoryDistance(lines({{0, 0, 0}, {20, 20, 20}}, {{0, 0, 20}, {20, 20, 0}}), 1, 6, 2);
    // Order 1: two switches of 2 cost 4, less than the two missed and two false of 3 each.
    EXPECT_DOUBLE_EQ(d.total, 4);
    EXPECT_EQ(d.switches, 2);
}

TEST(TrajectoryDistance, ATrackThatGoesOverToAnotherTargetIsTwoHalves) {
    // Target 0 loses the track that target 1 gets. Misses: two of 12.5 each.
    const auto d = trajectoryDistance(lines({{0, 0, 0, 0}, {9, 9, 9, 9}}, {{0, 0, 9, 9}}), 2, 5, 2);
    EXPECT_EQ(d.switches, 1);
    EXPECT_DOUBLE_EQ(d.total, std::sqrt(4 * 12.5 + 4));
}

TEST(TrajectoryDistance, APauseOfTrackOrTargetIsNoSwitch) {
    EXPECT_EQ(trajectoryDistance(lines({{0, 0, 0}}, {{0, none, 0}}), 2, 5, 2).switches, 0);
    EXPECT_EQ(trajectoryDistance(lines({{0, none, 0}}, {{0, 0, 0}}), 2, 5, 2).switches, 0);
}

TEST(TrajectoryDistance, EmptySets) {
    EXPECT_EQ(trajectoryDistance({}, 2, 5, 2).total, 0);
    EXPECT_DOUBLE_EQ(trajectoryDistance(lines({{0, 0}}, {}), 2, 5, 2).total, 5);
    EXPECT_DOUBLE_EQ(trajectoryDistance(lines({{none, none}}, {{0, 0}}), 2, 5, 2).total, 5);
}

/// Straight from the definition: the shortest way through all assignments of all stamps, each assignment a
/// list of the track of every target or -1.
double byDefinition(const std::vector<Line>& targets, const std::vector<Line>& tracks, double p, double c,
                    double gamma) {
    const std::size_t n = targets.size(), m = tracks.size();
    std::vector<std::vector<int>> assignments;
    std::vector<int> current(n, -1);
    const std::function<void(std::size_t)> list = [&](std::size_t i) {
        if (i == n) {
            assignments.push_back(current);
            return;
        }
        for (int j = -1; j < static_cast<int>(m); ++j) {
            if (j >= 0 && std::find(current.begin(), current.begin() + static_cast<long>(i), j) !=
                              current.begin() + static_cast<long>(i))
                continue;
            current[i] = j;
            list(i + 1);
        }
        current[i] = -1;
    };
    list(0);
    const double cutoff = std::pow(c, p);
    const auto cost_at = [&](const std::vector<int>& assignment, std::size_t k) {
        double cost = 0;
        std::vector<bool> paired(m, false);
        for (std::size_t i = 0; i < n; ++i) {
            const bool there = !std::isnan(targets[i][k]);
            const int j = assignment[i];
            if (there && j >= 0 && !std::isnan(tracks[static_cast<std::size_t>(j)][k])) {
                const double d = std::abs(targets[i][k] - tracks[static_cast<std::size_t>(j)][k]);
                cost += std::min(cutoff, std::pow(d, p));
                paired[static_cast<std::size_t>(j)] = true;
            } else if (there) {
                cost += cutoff / 2;
            }
        }
        for (std::size_t j = 0; j < m; ++j)
            if (!std::isnan(tracks[j][k]) && !paired[j]) cost += cutoff / 2;
        return cost;
    };
    const auto switching = [&](const std::vector<int>& a, const std::vector<int>& b) {
        double switches = 0;
        for (std::size_t i = 0; i < n; ++i)
            if (a[i] != b[i]) switches += a[i] < 0 || b[i] < 0 ? 0.5 : 1;
        return switches * std::pow(gamma, p);
    };
    std::vector<double> best(assignments.size(), 0);
    for (std::size_t k = 0; k < targets[0].size(); ++k) {
        std::vector<double> next(assignments.size(), std::numeric_limits<double>::infinity());
        for (std::size_t b = 0; b < assignments.size(); ++b) {
            for (std::size_t a = 0; a < assignments.size(); ++a)
                next[b] =
                    std::min(next[b], best[a] + (k == 0 ? 0 : switching(assignments[a], assignments[b])));
            next[b] += cost_at(assignments[b], k);
        }
        best = next;
    }
    return std::pow(*std::min_element(best.begin(), best.end()), 1 / p);
}

/// Places on 8 m of a line, a quarter of them missing.
std::vector<Line> randomLines(RandomStream& random, std::size_t count, std::size_t stamps) {
    std::vector<Line> result(count, Line(stamps));
    for (Line& line : result)
        for (double& x : line) x = random.uniform() < 0.25 ? none : random.uniform(0, 8);
    return result;
}

TEST(TrajectoryDistance, IsThatOfItsDefinitionOnRandomSets) {
    for (std::uint32_t trial = 0; trial < 300; ++trial) {
        RandomStream random(7, RandomPurpose::test, 0, trial);
        const std::size_t n = 1 + random.bits() % 3, m = 1 + random.bits() % 4,
                          stamps = 1 + random.bits() % 8;
        const auto targets = randomLines(random, n, stamps), tracks = randomLines(random, m, stamps);
        const double p = 1 + static_cast<double>(random.bits() % 2), c = 3, gamma = 0.3 + 0.4 * (trial % 8);
        const auto d = trajectoryDistance(lines(targets, tracks), p, c, gamma);
        const double expected = byDefinition(targets, tracks, p, c, gamma);
        // Sums of up to 8 x 7 terms of about 10, and the root of a value that may be near zero.
        ASSERT_NEAR(d.total, expected, 1e-7) << "trial " << trial;
        EXPECT_EQ(d.lower_bound, d.total);
    }
}

TEST(TrajectoryDistance, ACutSearchBoundsTheMetric) {
    int wider = 0;
    for (std::uint32_t trial = 0; trial < 100; ++trial) {
        RandomStream random(8, RandomPurpose::test, 0, trial);
        const auto targets = randomLines(random, 3, 8), tracks = randomLines(random, 4, 8);
        const double expected = byDefinition(targets, tracks, 2, 3, 1.5);
        for (const TrajectorySearch search : {TrajectorySearch{1, 4096}, TrajectorySearch{512, 1}}) {
            const auto d = trajectoryDistance(lines(targets, tracks), 2, 3, 1.5, search);
            EXPECT_GE(d.total, expected - 1e-7);
            EXPECT_LE(d.lower_bound, expected + 1e-7);
            wider += d.lower_bound < d.total;
        }
    }
    EXPECT_GT(wider, 100);  // the cuts must have bitten for this to say anything
}

}  // namespace trajectory_distance_test
}  // namespace slamot::eval
