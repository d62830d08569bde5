#include "slamot/sim/Simulation.h"

#include <algorithm>

#include "slamot/sim/Robot.h"
#include "slamot/sim/World.h"

namespace slamot::sim {
namespace {

bool carries(const SensorParameters& sensor, int robot) {
    return sensor.robots.empty() ||
           std::find(sensor.robots.begin(), sensor.robots.end(), robot) != sensor.robots.end();
}

/// Index counts the detections of a stamp over all scans, in the order of the log.
void addAssociations(const Scan& scan, Truth& truth) {
    int index = 0;
    if (!truth.associations.empty() && truth.associations.back().stamp == scan.reading.stamp) {
        index = truth.associations.back().index + 1;
    }
    for (TrueAssociation origin : scan.origins) {
        origin.index = index++;
        truth.associations.push_back(origin);
    }
}

Truth truthOf(const Scenario& scenario, int robot, const std::vector<Pose2>& poses, const World& world,
              const std::vector<Trajectory>& movers) {
    Truth truth;
    truth.source = scenario.about.empty() ? "simulated" : "simulated: " + scenario.about;
    truth.landmarks = world.landmarks;
    for (int step = 0; step <= scenario.steps; ++step)
        truth.robot.push_back({scenario.stampOfStep(step), poses[step]});
    for (const Trajectory& mover : movers) {
        if (mover.id.value != robot_id_base + robot && !mover.states.empty())
            truth.targets[mover.id] = mover.states;
    }
    return truth;
}

}  // namespace

std::vector<mrpt::obs::CObservation::Ptr> SimulatedLog::observations() const {
    std::vector<mrpt::obs::CObservation::Ptr> all;
    all.reserve(odometry.size() + scans.size());
    auto next = scans.begin();
    const auto scansBefore = [&](const Stamp* limit) {
        for (; next != scans.end() && (!limit || next->reading.stamp < *limit); ++next) {
            all.push_back(toMrpt(next->reading, next->range_std, next->bearing_std));
        }
    };
    for (const OdometryReading& reading : odometry) {
        scansBefore(&reading.stamp);
        all.push_back(toMrpt(reading, odometry_label));
    }
    scansBefore(nullptr);
    return all;
}

std::vector<SimulatedLog> simulate(const Scenario& scenario, std::uint64_t seed,
                                   const SimulationProgress& progress) {
    requirePossible(scenario);
    const World world = makeWorld(scenario.world, seed);
    std::vector<Trajectory> movers;
    for (const MoverParameters& mover : scenario.movers)
        movers.push_back(simulateMover(scenario, mover, seed));
    std::vector<RobotRun> runs;
    for (const RobotParameters& robot : scenario.robots) {
        runs.push_back(simulateRobot(scenario, robot, world, movers, seed));
    }
    if (scenario.robots.size() > 1 && scenario.robots_see_each_other) {
        for (std::size_t i = 0; i < runs.size(); ++i)
            movers.push_back(asMover(scenario, scenario.robots[i], runs[i]));
    }
    // The order of the log within a stamp.
    std::vector<SensorParameters> sensors = scenario.sensors;
    std::sort(sensors.begin(), sensors.end(),
              [](const SensorParameters& a, const SensorParameters& b) { return a.label < b.label; });

    std::vector<SimulatedLog> logs;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        SimulatedLog log;
        log.robot = scenario.robots[i].number;
        log.truth = truthOf(scenario, log.robot, runs[i].poses, world, movers);
        for (int step = 0; step <= scenario.steps; ++step) {
            for (const SensorParameters& sensor : sensors) {
                if (!carries(sensor, log.robot) || step % sensor.every_n_steps != sensor.phase) continue;
                log.scans.push_back(
                    scan(scenario, sensor, log.robot, step, runs[i].poses[step], world, movers, seed));
                addAssociations(log.scans.back(), log.truth);
            }
            const double done = (static_cast<double>(i) + (step + 1.0) / (scenario.steps + 1.0)) /
                                static_cast<double>(runs.size());
            if (progress && !progress(done)) return {};
        }
        log.odometry = std::move(runs[i].odometry);
        logs.push_back(std::move(log));
    }
    return logs;
}

}  // namespace slamot::sim
