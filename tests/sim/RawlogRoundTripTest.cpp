// What `slamot simulate` does with a simulated log: written, and read again by what runs use.
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/registerAllClasses.h>

#include "slamot/rawlog/RawlogReader.h"
#include "slamot/rawlog/RawlogWriter.h"
#include "slamot/sim/Simulation.h"
#include "support/TemporaryFolder.h"

namespace slamot::sim {
namespace rawlog_round_trip_test {

TEST(SimulatedLog, ComesBackFromARawlogInItsOrderWithItsTruth) {
    mrpt::obs::registerAllClasses_mrpt_obs();
    Scenario scenario = loadScenario(Config::fromFile(SLAMOT_SOURCE_DIR "/config/scenarios/two_robots.ini"));
    scenario.steps = 40;
    const SimulatedLog log = simulate(scenario, 1).at(1);
    const test::TemporaryFolder folder;
    const std::string file = folder.path("simulated.rawlog");
    const auto observations = log.observations();
    RawlogWriter writer(file);
    for (const auto& observation : observations) writer.write(*observation);
    writer.close();

    RawlogReader reader(file, LogParameters{});
    auto scan = log.scans.begin();
    std::size_t count = 0;
    for (auto entry = reader.next(); entry; entry = reader.next(), ++count) {
        ASSERT_LT(count, observations.size());
        ASSERT_EQ(entry->stamp, toStamp(observations[count]->timestamp));
        ASSERT_EQ(entry->observation->sensorLabel, observations[count]->sensorLabel);
        const auto* bearing_range =
            dynamic_cast<const mrpt::obs::CObservationBearingRange*>(entry->observation.get());
        if (!bearing_range) continue;
        const RangeBearingReading read = fromMrpt(*bearing_range);
        ASSERT_EQ(read.items.size(), scan->reading.items.size());
        for (std::size_t i = 0; i < read.items.size(); ++i) {
            // Floats: half a unit in the last of 24 binary digits.
            const auto &in = read.items[i], &out = scan->reading.items[i];
            EXPECT_EQ(in.id, out.id);
            EXPECT_NEAR(in.range, out.range, out.range * 6e-8);
            EXPECT_NEAR(in.bearing, out.bearing, std::abs(out.bearing) * 6e-8);
        }
        ++scan;
    }
    EXPECT_EQ(count, observations.size());
    EXPECT_EQ(reader.end(), LogEnd::clean);
    EXPECT_EQ(reader.drops().total(), 0);

    writeTruth(log.truth, truthFolderOf(file));
    const Truth truth = readTruth(truthFolderOf(file));
    ASSERT_EQ(truth.robot.size(), log.truth.robot.size());
    EXPECT_EQ(truth.robot.back().pose.vector(), log.truth.robot.back().pose.vector());
    EXPECT_EQ(truth.landmarks.size(), log.truth.landmarks.size());
    ASSERT_EQ(truth.targets.size(), 4u);  // three movers and robot 0
    EXPECT_EQ(truth.targets.at(SourceId{0}).back().position,
              log.truth.targets.at(SourceId{0}).back().position);
    EXPECT_EQ(truth.targets.at(SourceId{0}).back().mode, "cv");
    EXPECT_TRUE(std::isnan(truth.targets.at(SourceId{1000000}).back().acceleration.x()));
    ASSERT_EQ(truth.associations.size(), log.truth.associations.size());
    EXPECT_EQ(truth.associations.back().id, log.truth.associations.back().id);
}

}  // namespace rawlog_round_trip_test
}  // namespace slamot::sim
