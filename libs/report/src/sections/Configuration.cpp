// What of the log was not used, every setting, and how to run it again.
#include <fmt/format.h>

#include "ConfigLines.h"
#include "sections/Sections.h"
#include "slamot/report/ShellWord.h"

namespace slamot::report {
namespace section_configuration {

std::string always(const RunFolder&) {
    return {};
}

std::vector<Block> drops(const RunFolder& run) {
    PageTable table{"Dropped", {{"sensor", false}, {"reason", false}, {"count"}}, {}};
    for (const auto& drop : run.list("drops")) {
        const auto text = [&](const char* name) {
            const auto found = drop.find(name);
            return found != drop.end() && found->is_string() ? found->get<std::string>() : std::string();
        };
        const auto count = drop.find("count");
        const bool counted = count != drop.end() && count->is_number_integer();
        table.rows.push_back({{{text("sensor")},
                               {text("reason")},
                               {counted ? fmt::format("{}", count->get<std::int64_t>()) : "?"}}});
    }
    if (table.rows.empty()) {
        return {Paragraph{"Nothing of the log was dropped."}};
    }
    return {table};
}

std::vector<Block> configuration(const RunFolder& run) {
    const std::string truth = run.text("truth");
    std::string command = fmt::format("slamot run run.ini {} -o run_again --truth {}",
                                      shellWord(run.text("log")), truth.empty() ? "none" : shellWord(truth));
    if (const std::string seed = run.digits("seed");
        !seed.empty() && !configHolds(run.text("config"), "run", "seed")) {
        command += " --seed " + seed;
    }
    const std::string directory = run.text("directory");
    const std::string start = directory.empty() ? "Save the settings below as run.ini, then"
                                                : fmt::format(
                                                      "Save the settings below as run.ini in {}, where "
                                                      "the run was started, then there",
                                                      directory);
    return {
        Paragraph{start}, Verbatim{command, "", true},
        Verbatim{run.text("config"),
                 "Settings that were given; `slamot config` prints all with their defaults", true},
        Paragraph{run.text("status") == "stopped"
                      ? "This run was stopped, and the command runs the whole log: estimate_sha256, of all "
                        "estimates, will be another than"
                      : "The estimates are the same where estimate_sha256 in summary.json is"},
        Verbatim{run.text("estimate_sha256"), "", false}};
}

}  // namespace section_configuration

const ReportSection drop_section{
    "drops", "Dropped data", "Parts of the log that the run left out, with the reason (doc/output_files.md).",
    section_configuration::always, section_configuration::drops};

const ReportSection configuration_section{"configuration", "Configuration", "", section_configuration::always,
                                          section_configuration::configuration};

}  // namespace slamot::report
