// slamot: one program, one source file per subcommand.
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>

#include "Command.h"
#include "slamot/core/Version.h"
#include "slamot/core/config/Config.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/core/plugin/ErrorText.h"
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

/// CLI11 takes a word it does not know for no subcommand at all.
void requireKnownSubcommand(const CLI::App& app, const std::vector<std::string>& arguments) {
    const auto word = std::find_if(arguments.begin(), arguments.end(), [](const std::string& a) { return a[0] != '-'; });
    if (word == arguments.end()) return;
    std::vector<std::string> shown;
    for (const CLI::App* command : app.get_subcommands({})) {
        if (command->get_name() == *word) return;
        if (!command->get_group().empty()) shown.push_back(command->get_name());
    }
    const auto near = nearestWord(*word, shown);
    throw UsageError(fmt::format("no subcommand '{}', expected one of {}{}", *word, fmt::join(shown, ", "),
                                 near ? " (did you mean '" + *near + "'?)" : ""));
}

int runMain(int argc, char** argv) {
    CLI::App app{
        "Simultaneous localization, mapping and object tracking on MRPT rawlogs.\n"
        "Planar, from odometry and range-bearing observations.\n\n"
        "Example:\n"
        "  slamot simulate config/scenarios/demo.ini -o demo.rawlog\n"
        "  slamot run config/runs/demo.ini demo.rawlog -o out/"};
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
    addReport(app, action);
    addCompare(app, action);
    addStudy(app, action);
    addPlugins(app, action);
    addConfig(app, action);
    addCheckLog(app, action);

    app.failure_message([](const CLI::App* at, const CLI::Error& error) {
        const auto chosen = at->get_subcommands();
        return fmt::format("slamot: {}; see slamot{} --help\n", error.what(),
                           chosen.empty() ? "" : " " + chosen.front()->get_name());
    });
    requireKnownSubcommand(app, {argv + std::min(argc, 1), argv + argc});

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exit_success : exit_bad_input;
    }
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
    const int code = action(verbosity);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
        throw std::runtime_error("standard output: cannot be written to its end (is the disk full?)");
    return code;
}

}  // namespace

CLI::Validator wholeNumber() {
    return {[](const std::string& text) {
                const bool digits =
                    !text.empty() && text.size() <= 19 &&
                    std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
                return digits ? std::string() : "'" + text + "', expected a whole number of at least 0";
            },
            ""};
}

const std::atomic<bool>& interrupted() {
    return stop_requested;
}

std::string ownProgram() {
    return std::filesystem::read_symlink("/proc/self/exe").string();
}

}  // namespace slamot::app

int main(int argc, char** argv) {
    const auto fail = [](const std::exception& error, int code) {
        fmt::print(stderr, "slamot: {}\n", slamot::sentenceOf(error));
        return slamot::app::interrupted() ? slamot::app::exit_failed : code;
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
