// What of the log was not used, every setting, and how to run it again.
#include <fmt/format.h>

#include "sections/Sections.h"

namespace slamot::report {
namespace {

std::string always(const RunFolder&) {
    return {};
}

std::vector<Block> drops(const RunFolder& run) {
    PageTable table{"Dropped", {{"sensor", false}, {"reason", false}, {"count"}}, {}};
    for (const auto& drop : run.summary.value("drops", nlohmann::json::array())) {
        table.rows.push_back({{{drop.value("sensor", "")},
                               {drop.value("reason", "")},
                               {fmt::format("{}", drop.value("count", std::int64_t{0}))}}});
    }
    if (table.rows.empty()) {
        return {Paragraph{"Nothing of the log was dropped."}};
    }
    return {table};
}

/// A word of a shell's command line.
std::string quoted(const std::string& word) {
    const bool plain = !word.empty() && word.find_first_not_of(
                                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                            "0123456789_-+./=:,@%") == std::string::npos;
    if (plain) {
        return word;
    }
    std::string result = "'";
    for (const char c : word) {
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return result + "'";
}

std::vector<Block> configuration(const RunFolder& run) {
    const std::string truth = run.text("truth");
    const std::string command =
        fmt::format("slamot run run.ini {} -o out --truth {} --seed {:.0f}", quoted(run.text("log")),
                    truth.empty() ? "none" : quoted(truth), run.number("seed").value_or(1));
    return {Paragraph{"Save the settings below as run.ini, then"}, Verbatim{command, "", true},
            Verbatim{run.text("config"),
                     "Settings that were given; `slamot config` prints all with their defaults", true},
            Paragraph{"The estimates are the same where estimate_sha256 in summary.json is"},
            Verbatim{run.text("estimate_sha256"), "", false}};
}

}  // namespace

const ReportSection drop_section{
    "drops", "Dropped data", "Parts of the log that the run left out, with the reason (doc/output_files.md).",
    always, drops};

const ReportSection configuration_section{"configuration", "Configuration", "", always, configuration};

}  // namespace slamot::report
