#include <fmt/format.h>

#include "Command.h"
#include "SessionOptions.h"
#include "slamot/report/FigureWriter.h"
#include "slamot/report/RunReport.h"

namespace slamot::app {
namespace {

struct Options {
    std::string run, truth, out, pictures;
};

int reportJob(const Options& options, const Verbosity& verbosity) {
    const report::RunFolder run = report::readRunFolder(options.run, options.truth);
    if (run.lost_truth) fmt::print(stderr, "slamot: the page is without truth: {}\n", run.why_no_truth);
    const report::Page page = report::runPage(run);
    const std::string file = options.out.empty() ? options.run + "/report.html" : options.out;
    report::writePage(page, file);
    if (!verbosity.quiet) fmt::print("{}\n", file);
    if (!options.pictures.empty()) {
        report::writePictures(page, options.pictures);
        if (!verbosity.quiet) fmt::print("pictures in {}\n", options.pictures);
    }
    return exit_success;
}

}  // namespace

void addReport(CLI::App& app, Action& chosen) {
    auto* command =
        app.add_subcommand("report",
                           "The page of a run again, from its files, and its plots as pictures.\nExample: "
                           "slamot report out/ --pictures out/pictures");
    auto options = std::make_shared<Options>();
    command->add_option("run", options->run, "Output folder of a run")->required();
    command->add_option("--truth", options->truth,
                        "Truth folder, for metrics too; default: the run's; none: no truth");
    command->add_option("-o,--out", options->out, "Page to write; default: report.html in the run's folder")
        ->check(notEmpty());
    command->add_option("--pictures", options->pictures, "Folder for an SVG and a PNG of each plot")
        ->check(notEmpty());
    command->callback(
        [&chosen, options] { chosen = [options](const Verbosity& v) { return reportJob(*options, v); }; });
}

}  // namespace slamot::app
