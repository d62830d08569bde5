#include "World.h"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "slamot/rawlog/MemoryLog.h"
#include "slamot/sim/Simulation.h"

namespace slamot::study {

World::World(const Plan& plan, const WorldPlan& world, const std::function<bool()>& stopped)
    : name_(plan.nameOf(world)), log_file_(plan.kinds[world.kind].log_file) {
    const auto begin = std::chrono::steady_clock::now();
    if (plan.kinds[world.kind].scenario) {
        simulate(plan, world, stopped);
    } else if (std::filesystem::is_directory(truthFolderOf(log_file_))) {
        truth_ = readTruth(truthFolderOf(log_file_));
        has_truth_ = true;
    }
    seconds_to_make_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void World::simulate(const Plan& plan, const WorldPlan& world, const std::function<bool()>& stopped) {
    std::vector<sim::SimulatedLog> logs = sim::simulate(sim::loadScenario(*plan.kinds[world.kind].scenario),
                                                        world.world_seed, [&](double) { return !stopped(); });
    if (logs.empty()) throw Stopped{};
    const int robot = plan.sourceOf(world).scenario->robot;
    const auto log = std::find_if(logs.begin(), logs.end(),
                                  [&](const sim::SimulatedLog& one) { return one.robot == robot; });
    observations_ = std::make_shared<const std::vector<mrpt::obs::CObservation::Ptr>>(log->observations());
    truth_ = std::move(log->truth);
    has_truth_ = true;
}

std::string World::withoutPlace(std::string message) const {
    const std::string begin = name_ + ": ";
    if (message.rfind(begin, 0) == 0) message.erase(0, begin.size());
    if (log_file_.empty()) return message;
    const std::string file = std::filesystem::path(log_file_).filename().string();
    for (std::size_t at = 0; (at = message.find(log_file_, at)) != std::string::npos; at += file.size())
        message.replace(at, log_file_.size(), file);
    return message;
}

std::unique_ptr<LogSource> World::log(const LogParameters& parameters) const {
    if (observations_) return std::make_unique<MemoryLog>(observations_, parameters);
    return std::make_unique<RawlogReader>(log_file_, parameters);
}

}  // namespace slamot::study
