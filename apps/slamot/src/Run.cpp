#include <fmt/format.h>

#include <filesystem>

#include "Command.h"
#include "LiveWindow.h"
#include "LogGuard.h"
#include "Progress.h"
#include "slamot/eval/TerminalText.h"
#include "slamot/report/FigureWriter.h"
#include "slamot/report/Overview.h"
#include "slamot/report/RunReport.h"
#include "slamot/run/RunJob.h"

namespace slamot::app {
namespace {

struct Options {
    std::string config, log, out, truth;
    std::vector<std::string> set;
    std::string seed;
    int threads = 1;
    bool live = false;
};

/// `--truth`: a folder, `none`, or by default the folder beside the log where there is one.
std::string truthFolder(const Options& options) {
    if (options.truth == "none") return {};
    if (!options.truth.empty()) return options.truth;
    const std::string beside = truthFolderOf(options.log);
    return std::filesystem::is_directory(beside) ? beside : std::string();
}

void writeOverview(const run::JobResult& result, const Truth* truth, const Options& options) {
    try {
        report::OverviewText text;
        text.title = fmt::format("{} on {}", result.summary["estimator"].get<std::string>(),
                                 std::filesystem::path(options.log).filename().string());
        report::writeFigure(report::overviewFigure(result.record, truth, text), options.out + "/overview");
    } catch (const std::exception& error) {  // whatever it is, the run itself is done
        fmt::print(stderr, "slamot: no overview picture: {}\n", error.what());
    }
}

/// From the files of the run, so that `slamot report` makes the same page again.
void writeReport(const Options& options) {
    try {
        report::writeRunReport(options.out);
    } catch (const std::exception& error) {  // whatever it is, the run itself is done
        fmt::print(stderr, "slamot: no report: {}\n", error.what());
    }
}

void printSummary(const run::JobResult& result, const Options& options, const Verbosity& verbosity) {
    const auto& counts = result.summary["counts"];
    const auto& time = result.summary["time"];
    fmt::print("{}", eval::wrapped(fmt::format("{} on {}: {}", result.summary["estimator"].get<std::string>(),
                                               options.log, toText(result.status))));
    const auto counted = [&counts](const char* name, const char* one, const char* many) {
        const long count = counts[name].get<long>();
        return fmt::format("{} {}", count, count == 1 ? one : many);
    };
    fmt::print("  {}, {} in {};\n  {} and {} at the end\n", counted("odometry", "odometry entry", "odometry entries"),
               counted("detections", "detection", "detections"), counted("detection_sets", "set", "sets"),
               counted("landmarks", "landmark", "landmarks"), counted("tracks_at_end", "track", "tracks"));
    fmt::print("  detections used {}, down-weighted {}, rejected {}, tentative {}, ignored {}\n",
               counts["detections_used"].get<long>(), counts["detections_inflated"].get<long>(),
               counts["detections_rejected"].get<long>(), counts["detections_tentative"].get<long>(),
               counts["detections_ignored"].get<long>());
    for (const auto& drop : result.summary["drops"])
        fmt::print("  dropped: {} of '{}' ({})\n", drop["count"].get<long>(), drop["sensor"].get<std::string>(),
                   drop["reason"].get<std::string>());
    if (verbosity.verbose)
        fmt::print("  {:.2f} s, of it predict {:.2f}, detect {:.2f}, update {:.2f}; peak memory {:.0f} MB\n",
                   time["wall_s"].get<double>(), time["predict_s"].get<double>(), time["detect_s"].get<double>(),
                   time["update_s"].get<double>(), result.summary["peak_memory_mb"].get<double>());
    if (!result.metrics_table.empty())
        fmt::print("{}", result.metrics_table);
    else if (result.summary["truth"].is_null())
        fmt::print("  no truth ({}), so no errors are computed\n",
                   options.truth == "none" ? "--truth none" : truthFolderOf(options.log) + " is not there");
    fmt::print("outputs in {}{}\n", options.out, result.writes_report ? ", look at report.html" : "");
}

int runJob(const Options& options, const Verbosity& verbosity) {
    run::RunRequest request;
    request.config = Config::fromFile(options.config);
    for (const std::string& assignment : options.set) request.config.setFromAssignment(assignment);
    if (!options.seed.empty()) request.config.set("run", "seed", options.seed, "--seed");
    request.log_file = options.log;
    request.out_folder = options.out;
    request.threads = options.threads;
    request.stop = &interrupted();

    // The child looks at the log before anything of it is read here, and before any thread starts.
    LogParameters log_parameters;
    load(describe(log_parameters), request.config);
    guardLog(options.log, log_parameters);

    const std::string folder = truthFolder(options);
    Truth truth;
    if (!folder.empty()) {
        truth = readTruth(folder);
        request.truth = &truth;
        request.truth_folder = folder;
    }

    const PluginRegistry registry = PluginRegistry::discover();
    std::unique_ptr<LiveWindow> window;
    if (options.live) {
        window = std::make_unique<LiveWindow>("slamot: " + options.log, interrupted());
        request.sinks.push_back(window.get());
    }
    run::JobResult result;
    {
        Progress progress("running", verbosity.quiet);
        request.progress = [&](double done) { progress.show(done); };
        result = run::runLog(request, registry);
    }
    for (const std::string& warning : result.warnings) fmt::print(stderr, "slamot: warning: {}\n", warning);
    if (result.writes_figure) writeOverview(result, request.truth, options);
    if (result.writes_report) writeReport(options);
    if (result.failure) std::rethrow_exception(result.failure);
    if (!verbosity.quiet) printSummary(result, options, verbosity);
    if (window) window->waitUntilClosed();
    switch (result.status) {
        case run::RunStatus::complete: return exit_success;
        case run::RunStatus::stopped:
            fmt::print(stderr, "slamot: stopped; the outputs hold what was done\n");
            return exit_failed;
        default:
            fmt::print(stderr, "slamot: {}; the outputs hold what came before\n", result.end_message);
            return exit_bad_input;
    }
}

}  // namespace

void addRun(CLI::App& app, Action& chosen) {
    auto* command = app.add_subcommand("run",
                                       "The main job: a log in; robot, map and movers out.\nExample: slamot run "
                                       "config/runs/demo.ini demo.rawlog -o out/ --set ekf_slamot.consistency=classic");
    auto options = std::make_shared<Options>();
    command->add_option("config", options->config, "Config INI file; `slamot config PLUGIN` prints one")->required();
    command->add_option("log", options->log, "Rawlog")->required();
    command->add_option("-o,--out", options->out, "Folder for the outputs")->required();
    command->add_option("--truth", options->truth, "Truth folder; default LOG's stem + .truth; none: no truth");
    command->add_option("--set", options->set, "section.key=value, instead of the file's")->allow_extra_args(false);
    command->add_option("--seed", options->seed, "Instead of [run] seed");
    command->add_option("--threads", options->threads, "Threads; results do not depend on it")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    command->add_flag("--live", options->live,
                      "A window that follows the run: space pauses, s steps, + - speed, f follow, q closes");
    command->callback([&chosen, options] { chosen = [options](const Verbosity& v) { return runJob(*options, v); }; });
}

}  // namespace slamot::app
