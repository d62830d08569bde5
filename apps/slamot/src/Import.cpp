#include <fmt/format.h>

#include "Command.h"
#include "Progress.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/rawlog/Importer.h"

namespace slamot::app {
namespace {

struct Options {
    std::string format, in, out;
};

const Importer& findImporter(const std::string& format) {
    std::vector<std::string> names;
    for (const Importer& importer : importers()) {
        if (importer.format == format) return importer;
        names.push_back(importer.format);
    }
    const auto near = nearestWord(format, names);
    throw UsageError(fmt::format("no import format '{}'{}; there are {}", format,
                                 near ? "; did you mean '" + *near + "'?" : "", fmt::join(names, ", ")));
}

int import(const Options& options, const Verbosity& verbosity) {
    const Importer& importer = findImporter(options.format);
    ImportResult result;
    {
        Progress progress("importing", verbosity.quiet);
        result = importer.run(options.in, options.out, [&](double done) {
            progress.show(done);
            return !interrupted();
        });
    }
    if (interrupted()) throw std::runtime_error("stopped before the import was complete");
    if (!verbosity.quiet) {
        for (const std::string& file : result.files) fmt::print("{}\n", file);
        for (const std::string& note : result.notes) fmt::print("note: {}\n", note);
    }
    return exit_success;
}

std::string formatsInWords() {
    std::string text = "Turn a public dataset into rawlogs and truth.\nFormats:\n";
    for (const Importer& importer : importers()) text += fmt::format("  {:13} {}\n", importer.format, importer.about);
    return text + "Example: slamot import mrclam MRCLAM_Dataset6 -o mrclam6";
}

}  // namespace

void addImport(CLI::App& app, Action& chosen) {
    auto* command = app.add_subcommand("import", formatsInWords());
    auto options = std::make_shared<Options>();
    command->add_option("format", options->format, "Name of the format")->required();
    command->add_option("dir", options->in, "Folder of the dataset")->required();
    command->add_option("-o,--out", options->out, "Log, or folder of logs, to write")->required();
    command->callback([&chosen, options] { chosen = [options](const Verbosity& v) { return import(*options, v); }; });
}

}  // namespace slamot::app
