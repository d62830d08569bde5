#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "Command.h"
#include "slamot/core/config/Config.h"
#include "slamot/eval/Metrics.h"

namespace slamot::app {
namespace {

struct Options {
    std::string run, truth, json;
    std::vector<std::string> set;
};

int evaluate(const Options& options, const Verbosity& verbosity) {
    eval::EvaluationOptions how;
    Config config;
    for (const std::string& assignment : options.set) config.setFromAssignment(assignment);
    requireKnownSections(config, {"eval"});
    load(eval::describe(how), config);

    const bool is_folder = std::filesystem::is_directory(options.run);
    const eval::RunRecord run = is_folder ? eval::readRun(options.run) : eval::readTum(options.run);
    const eval::Metrics metrics = eval::evaluate(run, readTruth(options.truth), how);
    if (!verbosity.quiet) fmt::print("{}", eval::summaryTable(metrics));
    if (!options.json.empty()) {
        std::ofstream out(options.json);
        out << eval::toJson(metrics).dump(2) << '\n';
        out.close();
        if (!out) throw UsageError(options.json + ": cannot be written");
    }
    return exit_success;
}

}  // namespace

void addEval(CLI::App& app, Action& chosen) {
    auto* command = app.add_subcommand("eval",
                                       "Metrics of a run's output folder, or of a TUM trajectory, against "
                                       "truth.\nExample: slamot eval out/ --truth demo.truth");
    auto options = std::make_shared<Options>();
    command->add_option("run", options->run, "Output folder of a run, or a TUM file")->required();
    command->add_option("--truth", options->truth, "Truth folder")->required();
    command->add_option("--json", options->json, "Write the metrics here too");
    command->add_option("--set", options->set, "eval.key=value (doc/metrics.md)")->allow_extra_args(false);
    command->callback([&chosen, options] { chosen = [options](const Verbosity& v) { return evaluate(*options, v); }; });
}

}  // namespace slamot::app
