#pragma once
// What the subcommands share. Each subcommand is one source file with one `add...` function.
#include <CLI/CLI.hpp>
#include <atomic>
#include <functional>
#include <stdexcept>
#include <string>

#include "ExitCode.h"

namespace slamot::app {

/// Bad usage or input that is no fault of a library call: one sentence.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

struct Verbosity {
    bool quiet = false, verbose = false;
};

/// What a subcommand does once the command line has been read; returns the exit code.
using Action = std::function<int(const Verbosity&)>;

/// Adds a subcommand. `chosen` receives its action when the user asks for it.
void addSimulate(CLI::App& app, Action& chosen);
void addImport(CLI::App& app, Action& chosen);
void addConvert(CLI::App& app, Action& chosen);
void addInfo(CLI::App& app, Action& chosen);
void addRun(CLI::App& app, Action& chosen);
void addEval(CLI::App& app, Action& chosen);
void addReport(CLI::App& app, Action& chosen);
void addCompare(CLI::App& app, Action& chosen);
void addStudy(CLI::App& app, Action& chosen);
void addPlugins(CLI::App& app, Action& chosen);
void addConfig(CLI::App& app, Action& chosen);
/// Hidden: the child that looks through an untrusted log.
void addCheckLog(CLI::App& app, Action& chosen);

/// For options that take a whole number from 0 on: CLI11 itself reads -1 as a very large one.
CLI::Validator wholeNumber();

/// Becomes true at Ctrl-C (or SIGTERM); a second one ends the program at once.
const std::atomic<bool>& interrupted();

/// This program's own file, to start children with.
std::string ownProgram();

}  // namespace slamot::app
