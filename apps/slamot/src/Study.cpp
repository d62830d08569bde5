#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "Command.h"
#include "Progress.h"
#include "SessionOptions.h"
#include "slamot/study/Checks.h"
#include "slamot/study/Export.h"
#include "slamot/study/OneRun.h"
#include "slamot/study/Page.h"
#include "slamot/study/Report.h"
#include "slamot/study/Session.h"

namespace slamot::app {
namespace {

struct Options {
    study::SessionRequest session;
    std::string shard, keep;
    std::vector<std::string> merge;
    int threads = 1;
    bool list = false, check = false, no_run = false;
    std::string export_folder, report_file;
    std::vector<std::string> pages;
};

study::Shard shardFrom(const std::string& text) {
    study::Shard shard;
    if (text.empty()) return shard;
    int read = 0;
    const bool whole = std::sscanf(text.c_str(), "%d/%d%n", &shard.number, &shard.count, &read) == 2 &&
                       static_cast<std::size_t>(read) == text.size();
    if (!whole || shard.count < 1 || shard.number < 1 || shard.number > shard.count)
        throw UsageError(fmt::format("--shard {}: expected k/K with k from 1 to K", text));
    return shard;
}

std::string inWords(const study::GridPoint& point) {
    std::string text;
    for (const auto& [key, value] : point) text += fmt::format(" {}={}", key, value);
    return text;
}

void printPlan(const study::Plan& plan, const std::set<study::RunIndex>& done, const study::Shard& shard) {
    std::size_t worlds = 0, runs = 0;
    for (std::size_t w = 0; w < plan.worlds.size(); ++w) {
        if (interrupted()) throw std::runtime_error("stopped");
        const study::WorldPlan& world = plan.worlds[w];
        if (!shard.has(world)) continue;
        const study::PlannedWorldKind& kind = plan.kinds[world.kind];
        fmt::print("{} seed {}{}{}\n", plan.nameOf(world), world.world_seed,
                   kind.scenario ? inWords(plan.study.scenario_grid[world.scenario_point]) : " ",
                   kind.log_file);
        const std::vector<study::RunPlan>& planned = plan.runsOf(world);
        for (std::size_t r = 0; r < planned.size(); ++r)
            fmt::print("  {} {}{}{}\n", plan.keyOf(world, planned[r]), plan.nameOf(planned[r]),
                       inWords(plan.study.config_grid[planned[r].config_point]),
                       done.count({w, r}) ? " (done)" : "");
        ++worlds;
        runs += planned.size();
    }
    fmt::print("{} worlds, {} runs\n", worlds, runs);
}

double secondsSince(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// A run that is not made again leaves nothing in --keep.
void tellWhatIsNotKept(const study::Session& session, const std::string& folder,
                       const std::vector<study::Unit>& units, const study::Shard& shard) {
    std::set<study::RunIndex> run_now;
    for (const study::Unit& unit : units)
        for (const std::size_t run : unit.runs) run_now.insert({unit.world, run});
    const study::Plan& plan = session.plan();
    std::size_t without = 0;
    for (const auto& [w, r] : session.done()) {
        const study::WorldPlan& world = plan.worlds[w];
        const std::filesystem::path kept =
            std::filesystem::path(folder) / plan.nameOf(world) / plan.nameOf(plan.runsOf(world)[r]);
        without += shard.has(world) && run_now.count({w, r}) == 0 && !std::filesystem::exists(kept);
    }
    if (without > 0)
        fmt::print(stderr,
                   "slamot: --keep: nothing was kept of {} runs whose rows were there already; the same "
                   "command with a new --db runs and keeps them\n",
                   without);
}

/// Runs what is missing; whether all of it was.
bool runMissing(study::Session& session, const Options& options, const study::Shard& shard,
                const PluginRegistry& registry, std::chrono::steady_clock::time_point begin,
                const Verbosity& verbosity) {
    const std::vector<study::Unit> units = session.missing(shard);
    study::RunnerOptions how;
    how.threads = options.threads;
    how.unit.stop = &interrupted();
    how.unit.measure_memory = true;
    how.unit.keep_folder = options.keep;
    study::StudyProgress last;
    study::StudyTimes times;
    {
        Progress progress("study", verbosity.quiet);
        how.progress = [&](const study::StudyProgress& now) {
            last = now;
            progress.show(static_cast<double>(now.done) / static_cast<double>(now.total),
                          fmt::format("{}/{} runs, {:.1f}/s, {} failed", now.done, now.total,
                                      static_cast<double>(now.done) / secondsSince(begin), now.failed));
        };
        times = study::runStudy(session.plan(), units, registry, how,
                                [&](const study::Row& row) { session.store().add(row); });
    }
    if (!options.keep.empty()) tellWhatIsNotKept(session, options.keep, units, shard);
    if (!verbosity.quiet)
        fmt::print("{}\n", study::timesInWords(last, secondsSince(begin), times.runs_s, options.threads));
    std::size_t wanted = 0;
    for (const study::Unit& unit : units) wanted += unit.runs.size();
    return last.done == wanted;
}

/// The command that makes a page again.
std::string commandOf(const Options& options, const std::string& option, const std::string& page) {
    std::vector<std::string> words = {"slamot", "study"};
    for (const std::string& word : study::argumentsOf(options.session)) words.push_back(word);
    if (options.check) words.push_back("--check");
    words.insert(words.end(), {option, page});
    return study::shellLine(words);
}

/// What the rows say, where it was asked for; false when a check failed.
bool tellFindings(const study::Session& session, const study::Analysis& analysis, const Options& options,
                  const PluginRegistry& registry) {
    if (!options.check && options.export_folder.empty() && options.pages.empty() &&
        options.report_file.empty())
        return true;
    const std::vector<study::Row> rows = session.rows();
    if (rows.empty() && !options.report_file.empty())
        throw UsageError(fmt::format("--report: {} has no rows of this study, expected some to report on",
                                     options.session.store_file));
    if (rows.empty() && !options.pages.empty())
        throw UsageError(
            fmt::format("--fill: {} has no rows of this study, expected some before pages are filled",
                        options.session.store_file));
    study::OneRuns one_runs(session.plan(), registry, &interrupted());
    const study::Findings findings{session.plan().study, analysis, rows, &session.plan(), &one_runs};
    study::CheckReport checks;
    if (options.check) {
        checks = study::runChecks(analysis, session.plan(), rows, options.session.short_form);
        fmt::print("{}", study::toTerminal(checks));
    }
    if (!options.export_folder.empty()) study::exportStudy(findings, options.export_folder);
    for (const std::string& page : options.pages)
        study::fillPage(page, findings, study::provenanceHere(commandOf(options, "--fill", page)),
                        options.check ? &checks : nullptr);
    if (!options.report_file.empty())
        study::writeReport(options.report_file, findings,
                           study::provenanceHere(commandOf(options, "--report", options.report_file)),
                           options.check ? &checks : nullptr);
    return !options.check || checks.passed();
}

void requireOptionsThatFit(const Options& options) {
    const bool runs = !options.list && !options.no_run && options.merge.empty();
    if (options.session.retry_failed && !runs)
        throw UsageError("--retry-failed: expected without --list, --no-run and --merge, which run nothing");
    if (!options.keep.empty() && !runs)
        throw UsageError("--keep: expected without --list, --no-run and --merge, which run nothing");
    if (!options.shard.empty() && (options.no_run || !options.merge.empty()))
        throw UsageError("--shard: expected without --no-run and --merge, which run nothing");
    if (!options.shard.empty() && (options.check || !options.export_folder.empty() ||
                                   !options.pages.empty() || !options.report_file.empty()))
        throw UsageError(
            "--shard: expected without --check, --export, --report and --fill, which need all rows; "
            "give them when merging");
}

/// Only looks: no file of rows is made.
void listPlan(const Options& options, const study::Shard& shard, const PluginRegistry& registry) {
    const study::Plan plan = study::planOf(options.session, registry);
    for (const std::string& sentence : plan.skipped) fmt::print(stderr, "slamot: {}\n", sentence);
    const std::string& file = options.session.store_file;
    printPlan(plan,
              std::filesystem::exists(file) ? study::Store(file, plan.study).done(plan)
                                            : std::set<study::RunIndex>(),
              shard);
}

int studyJob(const Options& options, const Verbosity& verbosity) {
    const auto begin = std::chrono::steady_clock::now();
    const study::Shard shard = shardFrom(options.shard);
    requireOptionsThatFit(options);
    const std::filesystem::path folder = std::filesystem::path(options.session.store_file).parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder))
        throw UsageError(
            fmt::format("--db {}: there is no folder {}", options.session.store_file, folder.string()));

    const PluginRegistry registry = PluginRegistry::discover();
    if (options.list) {
        listPlan(options, shard, registry);
        return exit_success;
    }
    study::Session session(options.session, registry);
    // A mistake in a table must not come to light after hours of runs.
    const study::Analysis analysis = study::readAnalysis(session.plan().study);
    if (options.check && analysis.checks.empty())
        throw UsageError(
            fmt::format("--check: {} has no [check.NAME] to compare with", options.session.study_file));
    for (const std::string& sentence : session.plan().skipped) fmt::print(stderr, "slamot: {}\n", sentence);
    bool complete = true;
    const bool merging = !options.merge.empty();
    if (merging)
        for (const std::string& sentence : session.merge(options.merge))
            fmt::print(stderr, "slamot: {}\n", sentence);
    else if (!options.no_run)
        complete = runMissing(session, options, shard, registry, begin, verbosity);
    const bool merged_in_part = merging && !session.isComplete();
    const std::string state = session.stateInWords();
    if (merged_in_part || state.find('\n') != std::string::npos)
        fmt::print(stderr, "slamot: {}\n", state);
    else if (!verbosity.quiet)
        fmt::print("{}\n", state);
    if (!complete)
        throw std::runtime_error("stopped; the rows so far are kept, the same command does the rest");
    return tellFindings(session, analysis, options, registry) && !merged_in_part ? exit_success : exit_failed;
}

}  // namespace

void addStudy(CLI::App& app, Action& chosen) {
    auto* command = app.add_subcommand(
        "study",
        "Many runs by one file: scenarios or logs, configs, grids and seeds.\nExample: slamot "
        "study config/studies/consistency.ini --db consistency.db --threads 2");
    auto options = std::make_shared<Options>();
    addSessionOptions(*command, options->session);
    command->add_option("--shard", options->shard, "k/K: only the k-th of K equal parts")->check(notEmpty());
    command->add_option("--threads", options->threads, "Runs at the same time; rows do not depend on it")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    command->add_option("--merge", options->merge, "Take the rows of other files of this study; run nothing");
    command->add_flag("--list", options->list, "Print worlds, runs and keys; run nothing");
    command->add_option("--keep", options->keep, "Folder for the complete outputs of every run");
    command->add_flag("--no-run", options->no_run, "Run nothing: only what the rows there are say");
    command->add_flag("--check", options->check,
                      "Compare with the intervals of [check.*]; exit 1 when one fails");
    command->add_option("--export", options->export_folder,
                        "Folder for all rows, statistics, tables and figures");
    command->add_option("--report", options->report_file, "Page of all tables, figures and checks")
        ->check(notEmpty());
    command->add_option("--fill", options->pages, "Markdown pages whose marks of this study are filled");
    command->callback(
        [&chosen, options] { chosen = [options](const Verbosity& v) { return studyJob(*options, v); }; });
}

}  // namespace slamot::app
