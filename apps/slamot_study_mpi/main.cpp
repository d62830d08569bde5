// slamot_study_mpi: `slamot study` over the ranks of an MPI job. One rank runs it alone, without handing out.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <boost/mpi/collectives.hpp>
#include <boost/mpi/environment.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>

#include "../slamot/src/ExitCode.h"
#include "../slamot/src/SessionOptions.h"
#include "Ranks.h"
#include "slamot/core/Version.h"
#include "slamot/core/plugin/ErrorText.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/study/Session.h"

namespace {

using namespace slamot;
namespace mpi = boost::mpi;
using Clock = std::chrono::steady_clock;
using app::exit_bad_input, app::exit_failed, app::exit_success;

std::atomic<bool> stop_requested{false};

void onSignal(int) {
    stop_requested = true;
}

struct Options {
    study::SessionRequest session;
    bool quiet = false;
};

void addOptions(CLI::App& app, Options& options) {
    app.set_version_flag("--version", std::string("slamot_study_mpi ") + version);
    slamot::app::addSessionOptions(app, options.session);
    app.add_flag("-q,--quiet", options.quiet, "No progress");
}

/// A line every five seconds: a job's output goes to a file.
class ProgressLines {
  public:
    explicit ProgressLines(bool quiet) : quiet_(quiet) {}
    void operator()(const study::StudyProgress& now) {
        last = now;
        if (quiet_ || now.done == 0 || Clock::now() - shown_ < std::chrono::seconds(5)) return;
        shown_ = Clock::now();
        const double elapsed = std::chrono::duration<double>(shown_ - begin_).count();
        fmt::print(stderr, "study {}/{} runs, {} failed, {:.1f} runs/s, {:.0f} s left\n", now.done, now.total,
                   now.failed, static_cast<double>(now.done) / elapsed,
                   elapsed * static_cast<double>(now.total - now.done) / static_cast<double>(now.done));
    }
    study::StudyProgress last;

  private:
    bool quiet_;
    Clock::time_point begin_ = Clock::now(), shown_ = begin_;
};

/// The exit code: failed while runs are missing. When stopped, the other ranks have ended cleanly too.
int firstRank(const mpi::communicator& world, const Options& options, const PluginRegistry& registry,
              Clock::time_point begin) {
    study::Session session(options.session, registry);
    for (const std::string& sentence : session.plan().skipped)
        fmt::print(stderr, "slamot_study_mpi: {}\n", sentence);
    // Imports are there now; the others find them.
    world.barrier();
    const std::vector<study::Unit> units = session.missing({});
    ProgressLines progress(options.quiet);
    const auto tell = [&](const study::StudyProgress& now) { progress(now); };
    const auto take = [&](const study::Row& row) { session.store().add(row); };
    study::StudyTimes times;
    if (world.size() > 1) {
        times = study::handOut(world, session.plan(), units, stop_requested, tell, take);
    } else {
        study::RunnerOptions how;
        how.unit.stop = &stop_requested;
        how.unit.measure_memory = true;
        how.progress = tell;
        times = study::runStudy(session.plan(), units, registry, how, take);
    }
    const double wall = std::chrono::duration<double>(Clock::now() - begin).count();
    if (!options.quiet)
        fmt::print("{}\n",
                   study::timesInWords(progress.last, wall, times.runs_s, std::max(world.size() - 1, 1)));
    const std::string state = session.stateInWords();
    fmt::print(state.find('\n') == std::string::npos ? stdout : stderr, "slamot_study_mpi: {}\n", state);
    std::size_t wanted = 0;
    for (const study::Unit& unit : units) wanted += unit.runs.size();
    if (progress.last.done == wanted) return exit_success;
    fmt::print(stderr,
               "slamot_study_mpi: stopped; the rows so far are kept, the same command does the rest\n");
    return exit_failed;
}

void otherRank(const mpi::communicator& world, const Options& options, const PluginRegistry& registry) {
    world.barrier();
    study::work(world, study::planOf(options.session, registry), registry, stop_requested);
}

}  // namespace

int main(int argc, char** argv) {
    const auto begin = Clock::now();
    CLI::App app{
        "`slamot study` over the ranks of an MPI job: rank 0 hands out and keeps the rows, the others run.\n"
        "Example: mpirun -n 5 slamot_study_mpi config/studies/consistency.ini --db consistency.db"};
    Options options;
    addOptions(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exit_success : exit_bad_input;
    }

    const auto tellAndGiveUp = [&](const std::exception& error, int code) {
        fmt::print(stderr, "slamot_study_mpi: {}\n", sentenceOf(error));
        return code;
    };
    // Plugins are probed in child processes, which are better not made once MPI has started.
    PluginRegistry registry;
    try {
        registry = PluginRegistry::discover();
    } catch (const std::exception& error) {
        return tellAndGiveUp(error, exit_bad_input);
    }
    mpi::environment environment(argc, argv);
    const mpi::communicator world;
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
    int code = exit_success;
    try {
        if (world.rank() == 0) return firstRank(world, options, registry, begin);
        otherRank(world, options, registry);
        return exit_success;
    } catch (const ConfigError& error) {
        code = tellAndGiveUp(error, exit_bad_input);
    } catch (const PluginError& error) {
        code = tellAndGiveUp(error, exit_bad_input);
    } catch (const LogError& error) {
        code = tellAndGiveUp(error, exit_bad_input);
    } catch (const std::exception& error) {
        code = tellAndGiveUp(error, exit_failed);
    }
    // The other ranks wait for this one.
    std::fflush(nullptr);
    if (world.size() > 1) mpi::environment::abort(code);
    return code;
}
