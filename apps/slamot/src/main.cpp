// slamot: one program, one source file per subcommand.
#include <fmt/format.h>

#include <csignal>
#include <filesystem>

#include "Command.h"
#include "slamot/core/Version.h"
#include "slamot/core/config/Config.h"
#include "slamot/core/plugin/PluginRegistry.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::app {
namespace {

std::atomic<bool> stop_requested{false};

void onSignal(int signal) {
    if (stop_requested.exchange(true)) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

int runMain(int argc, char** argv) {
    CLI::App app{
        "Simultaneous localization, mapping and object tracking on MRPT rawlogs.\n"
        "Planar, from odometry and range-bearing observations.\n\n"
        "Example:\n"
        "  slamot simulate config/scenarios/demo.ini -o demo.rawlog\n"
        "  slamot run config/ekf_slamot.ini demo.rawlog -o out/"};
    app.set_version_flag("--version", std::string("slamot ") + version);
    app.require_subcommand(1);
    Verbosity verbosity;
    app.add_flag("-q,--quiet", verbosity.quiet, "No progress, no tables");
    app.add_flag("-v,--verbose", verbosity.verbose, "More detail in tables");
    app.fallthrough();

    Action action;
    addSimulate(app, action);
    addImport(app, action);
    addConvert(app, action);
    addInfo(app, action);
    addRun(app, action);
    addEval(app, action);
    addPlugins(app, action);
    addConfig(app, action);
    addCheckLog(app, action);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exit_success : exit_bad_input;
    }
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
    return action(verbosity);
}

}  // namespace

const std::atomic<bool>& interrupted() {
    return stop_requested;
}

std::string ownProgram() {
    return std::filesystem::read_symlink("/proc/self/exe").string();
}

}  // namespace slamot::app

int main(int argc, char** argv) {
    const auto fail = [](const std::exception& error, int code) {
        fmt::print(stderr, "slamot: {}\n", error.what());
        return code;
    };
    try {
        return slamot::app::runMain(argc, argv);
    } catch (const slamot::ConfigError& error) {
        return fail(error, slamot::app::exit_bad_input);
    } catch (const slamot::PluginError& error) {
        return fail(error, slamot::app::exit_bad_input);
    } catch (const slamot::LogError& error) {
        return fail(error, slamot::app::exit_bad_input);
    } catch (const slamot::app::UsageError& error) {
        return fail(error, slamot::app::exit_bad_input);
    } catch (const std::exception& error) {
        return fail(error, slamot::app::exit_failed);
    }
}
