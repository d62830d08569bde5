#include <fmt/format.h>

#include "Command.h"
#include "SessionOptions.h"
#include "slamot/report/Comparison.h"
#include "slamot/report/FigureWriter.h"

namespace slamot::app {
namespace {

struct Options {
    std::vector<std::string> runs;
    std::string out = "comparison.html", pictures, truth;
};

int compareJob(const Options& options, const Verbosity& verbosity) {
    std::vector<report::RunFolder> runs;
    for (const std::string& folder : options.runs)
        runs.push_back(report::readRunFolder(folder, options.truth));
    for (const std::string& note : report::dropRepeats(runs)) fmt::print(stderr, "slamot: {}\n", note);
    const std::vector<report::RunGroup> groups = report::groupRuns(std::move(runs));
    const report::Page page = report::comparisonPage(groups);
    report::writePage(page, options.out);
    if (!options.pictures.empty()) report::writePictures(page, options.pictures);
    if (!verbosity.quiet) fmt::print("{}page: {}\n", report::comparisonText(groups), options.out);
    return exit_success;
}

}  // namespace

void addCompare(CLI::App& app, Action& chosen) {
    auto* command =
        app.add_subcommand("compare",
                           "Runs side by side: one table, one page. Runs of one configuration that differ by seed "
                           "or log alone are taken together.\nExample: slamot compare out/p1 out/p1_classic -o p1.html");
    auto options = std::make_shared<Options>();
    command->add_option("runs", options->runs, "Output folders of runs")->required();
    command->add_option("--truth", options->truth,
                        "Truth folder for all runs, metrics included; default: each run's; none: no truth");
    command->add_option("-o,--out", options->out, "Page to write")
        ->check(notEmpty())
        ->capture_default_str();
    command->add_option("--pictures", options->pictures, "Folder for an SVG and a PNG of each plot")
        ->check(notEmpty());
    command->callback(
        [&chosen, options] { chosen = [options](const Verbosity& v) { return compareJob(*options, v); }; });
}

}  // namespace slamot::app
