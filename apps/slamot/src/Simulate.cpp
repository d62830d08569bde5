#include <fmt/format.h>

#include <filesystem>

#include "Command.h"
#include "Progress.h"
#include "slamot/rawlog/RawlogWriter.h"
#include "slamot/sim/Simulation.h"

namespace slamot::app {
namespace {

namespace fs = std::filesystem;

struct Options {
    std::string scenario, out;
    std::uint64_t seed = 1;
    std::vector<std::string> set;
};

void writeLog(const sim::SimulatedLog& log, const std::string& file) {
    RawlogWriter writer(file);
    for (const auto& observation : log.observations()) writer.write(*observation);
    writer.close();
    writeTruth(log.truth, truthFolderOf(file));
}

void makeFolder(const fs::path& folder) {
    std::error_code error;
    if (!folder.empty()) fs::create_directories(folder, error);
    if (!folder.empty() && !fs::is_directory(folder))
        throw UsageError(fmt::format("{}: cannot be made ({}), expected a folder to write to",
                                     folder.string(), error ? error.message() : "it is no folder"));
}

std::vector<sim::SimulatedLog> makeLogs(const Options& options, const Verbosity& verbosity) {
    Config config = Config::fromFile(options.scenario);
    for (const std::string& assignment : options.set) config.setFromAssignment(assignment);
    const sim::Scenario scenario = sim::loadScenario(config);
    std::error_code ignored;
    if (fs::equivalent(options.scenario, options.out, ignored))
        throw UsageError(options.out + ": is the scenario, expected another name for the log");
    std::vector<sim::SimulatedLog> logs;
    {
        Progress progress("simulating", verbosity.quiet);
        logs = sim::simulate(scenario, options.seed, [&](double done) {
            progress.show(done);
            return !interrupted();
        });
    }
    if (logs.empty()) throw std::runtime_error("stopped before anything was written");
    return logs;
}

/// What is wrong with several settings together has no line of its own: then the file is named here.
std::vector<sim::SimulatedLog> makeLogsOrNameFile(const Options& options, const Verbosity& verbosity) {
    try {
        return makeLogs(options, verbosity);
    } catch (const ConfigError& error) {
        const std::string what = error.what();
        const bool named = what.rfind(options.scenario, 0) == 0 || what.rfind("--set", 0) == 0;
        throw ConfigError(named ? what : options.scenario + ": " + what);
    }
}

int simulate(const Options& options, const Verbosity& verbosity) {
    const std::vector<sim::SimulatedLog> logs = makeLogsOrNameFile(options, verbosity);

    // One robot's log is OUT itself, several go into the folder OUT without its ending.
    const fs::path out(options.out);
    const fs::path folder = fs::path(out).replace_extension();
    makeFolder(logs.size() == 1 ? out.parent_path() : folder);
    for (const sim::SimulatedLog& log : logs) {
        const std::string file =
            logs.size() == 1 ? out.string() : (folder / fmt::format("robot_{}.rawlog", log.robot)).string();
        writeLog(log, file);
        if (!verbosity.quiet)
            fmt::print("{}: {} odometry readings, {} scans, {} landmarks, {} movers; truth in {}\n", file,
                       log.odometry.size(), log.scans.size(), log.truth.landmarks.size(), log.truth.targets.size(),
                       truthFolderOf(file));
    }
    return exit_success;
}

}  // namespace

void addSimulate(CLI::App& app, Action& chosen) {
    auto* command = app.add_subcommand("simulate",
                                       "Make a log and its truth from a scenario.\nExample: slamot simulate "
                                       "config/scenarios/paper1.ini -o paper1.rawlog --seed 7");
    auto options = std::make_shared<Options>();
    command->add_option("scenario", options->scenario, "Scenario INI file (doc/simulator.md)")->required();
    command->add_option("-o,--out", options->out, "Log to write; with several robots the folder NAME for NAME.rawlog")
        ->required();
    command->add_option("--seed", options->seed, "Seed of the world and all noise")
        ->check(wholeNumber())
        ->capture_default_str();
    command->add_option("--set", options->set, "section.key=value, instead of the file's")->allow_extra_args(false);
    command->callback([&chosen, options] { chosen = [options](const Verbosity& v) { return simulate(*options, v); }; });
}

}  // namespace slamot::app
