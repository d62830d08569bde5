#include "slamot/study/Session.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <regex>

#include "slamot/rawlog/LogError.h"
#include "slamot/report/ShellWord.h"

namespace slamot::study {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t reasons_shown = 3;

}  // namespace

std::vector<std::string> argumentsOf(const SessionRequest& request) {
    std::vector<std::string> words = {request.study_file, "--db", request.store_file};
    if (request.short_form) words.push_back("--short");
    if (request.replicates) words.insert(words.end(), {"--replicates", std::to_string(*request.replicates)});
    if (request.any_build) words.push_back("--any-build");
    return words;
}

std::string shellLine(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) line += (line.empty() ? "" : " ") + report::shellWord(word);
    return line;
}

Plan planOf(const SessionRequest& request, const PluginRegistry& registry) {
    if (request.short_form && request.replicates)
        throw ConfigError("--short and --replicates both say how many worlds, expected one of the two");
    PlanRequest plan;
    plan.short_form = request.short_form;
    plan.replicates = request.replicates;
    plan.work_folder = workFolderOf(request.store_file);
    return layOut(loadStudy(request.study_file), plan, registry);
}

std::string workFolderOf(const std::string& store_file) {
    return (fs::path(store_file).parent_path() / "imported_logs").string();
}

Session::Session(const SessionRequest& request, const PluginRegistry& registry)
    : request_(request), plan_(planOf(request, registry)), store_(request.store_file, plan_.study) {
    if (!request.any_build) store_.requireBuild(plan_);
}

std::vector<Unit> Session::missing(const Shard& shard) const {
    std::vector<Unit> units = unitsOf(plan_, store_.done(plan_, request_.retry_failed), shard);
    if (store_.readOnly() && !units.empty())
        throw LogError(fmt::format(
            "{}: runs are missing, but file or folder may not be written to, expected --no-run or "
            "a file that takes rows",
            request_.store_file));
    return units;
}

std::vector<std::string> Session::merge(const std::vector<std::string>& files) {
    std::vector<std::string> not_there;
    for (const std::string& file : files) {
        if (fs::exists(file))
            store_.merge(file, plan_, request_.any_build);
        else
            not_there.push_back(file + ": is not there, expected a file of rows to merge");
    }
    return not_there;
}

std::string Session::stateInWords() const {
    // One reason, whatever numbers it comes with: the first stands for all.
    std::map<std::string, std::pair<std::string, std::size_t>> reasons;
    std::size_t there = 0, failed = 0;
    for (const Row& row : rows()) {
        ++there;
        if (row.status != "failed") continue;
        ++failed;
        const std::string reason = row.variant + " on " + row.source + ": " + row.reason;
        ++reasons.try_emplace(std::regex_replace(reason, std::regex("[0-9]+"), "#"), reason, 0)
              .first->second.second;
    }
    std::string text = fmt::format("{} of {} runs are there", there, plan_.runCount());
    if (failed > 0) text += fmt::format(", of which {} failed", failed);
    std::size_t shown = 0;
    for (const auto& [pattern, reason_and_count] : reasons) {
        if (shown++ == reasons_shown) {
            text += fmt::format("\n  and {} further reasons", reasons.size() - reasons_shown);
            break;
        }
        text += fmt::format("\n  {} x {}", reason_and_count.second, reason_and_count.first);
    }
    return text;
}

std::string timesInWords(const StudyProgress& progress, double wall_s, double runs_s, int threads) {
    if (progress.done == 0) return fmt::format("nothing was run, in {:.1f} s", wall_s);
    const std::string counts =
        fmt::format("{} runs, {} failed, in {:.1f} s", progress.done, progress.failed, wall_s);
    if (runs_s <= 0 || wall_s <= 0) return counts;
    const double engine = wall_s * threads - runs_s;
    return fmt::format(
        "{}; runs took {:.1f} s, so speed-up {:.2f} on {} thread{}, engine and waiting {:.1f} % of the runs",
        counts, runs_s, runs_s / wall_s, threads, threads == 1 ? "" : "s", 100 * engine / runs_s);
}

}  // namespace slamot::study
