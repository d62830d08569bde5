#include <fmt/format.h>

#include <algorithm>

#include "Command.h"
#include "LogGuard.h"
#include "Progress.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Stamp.h"
#include "slamot/rawlog/LogConvert.h"

namespace slamot::app {
namespace {

struct Options {
    std::string in, out, format, from, to;
    std::vector<std::string> labels;
};

/// A time given as seconds since the epoch, or as +SECONDS from the log's first stamp.
Stamp timeFrom(const std::string& text, const LogSummary& summary) {
    try {
        if (text.empty() || text[0] != '+') return stampFromText(text);
        Stamp first{INT64_MAX};
        for (const SensorSummary& sensor : summary.sensors) first = std::min(first, sensor.first);
        return {first.ticks + stampFromText(text.substr(1)).ticks};
    } catch (const std::invalid_argument& error) {
        throw UsageError(fmt::format("--from/--to: {}; expected seconds since the epoch, or +SECONDS from the log's start",
                                     error.what()));
    }
}

/// What would leave nothing is a slip.
void requireSomethingKept(const ConvertOptions& how, const LogSummary& summary) {
    std::vector<std::string> labels;
    Stamp first{INT64_MAX}, last{INT64_MIN};
    for (const SensorSummary& sensor : summary.sensors) {
        labels.push_back(sensor.label);
        first = std::min(first, sensor.first);
        last = std::max(last, sensor.last);
    }
    for (const std::string& label : how.labels) {
        if (std::find(labels.begin(), labels.end(), label) != labels.end()) continue;
        const auto near = nearestWord(label, labels);
        throw UsageError(fmt::format("--label {}: the log has no such sensor, expected one of '{}'{}", label,
                                     fmt::join(labels, "', '"),
                                     near ? " (did you mean '" + *near + "'?)" : ""));
    }
    if (!how.from && !how.to) return;
    const Stamp from = how.from.value_or(first), to = how.to.value_or(last);
    if (from > to || from > last || to < first)
        throw UsageError(fmt::format(
            "--from/--to: nothing lies between {} and {}, expected times within the log's {} to {}",
            toText(from), toText(to), toText(first), toText(last)));
}

int convert(const Options& options, const Verbosity& verbosity) {
    const LogParameters parameters;
    const LogSummary summary = guardedSummary(options.in, parameters);
    ConvertOptions how;
    how.labels = options.labels;
    if (options.format == "observations") how.format = LogFormat::observations;
    if (options.format == "action-frames") how.format = LogFormat::action_frames;
    if (!options.from.empty()) how.from = timeFrom(options.from, summary);
    if (!options.to.empty()) how.to = timeFrom(options.to, summary);

    requireSomethingKept(how, summary);

    ConvertResult result;
    {
        Progress progress("converting", verbosity.quiet);
        result = convertLog(options.in, options.out, parameters, how, [&](double done) {
            progress.show(done);
            return !interrupted();
        });
    }
    if (!verbosity.quiet)
        fmt::print("{}: {} observations and {} odometry entries written, {} left out\n", options.out, result.observations,
                   result.odometry, result.left_out);
    if (result.end != LogEnd::clean) {
        fmt::print(stderr, "slamot: {}; what came before was written\n", result.end_message);
        return exit_bad_input;
    }
    return exit_success;
}

}  // namespace

void addConvert(CLI::App& app, Action& chosen) {
    auto* command = app.add_subcommand("convert",
                                       "Change a log's format, cut it in time, keep some sensors.\nExample: slamot "
                                       "convert LOG.rawlog -o FRAMES.rawlog --format action-frames");
    auto options = std::make_shared<Options>();
    command->add_option("log", options->in, "Rawlog to read")->required();
    command->add_option("-o,--out", options->out, "Rawlog to write")->required();
    command->add_option("--format", options->format, "observations, or action-frames (what kf-slam reads)")
        ->check(CLI::IsMember({"observations", "action-frames"}));
    command->add_option("--label", options->labels, "Keep this sensor label; may be given several times")
        ->allow_extra_args(false);
    command->add_option("--from", options->from, "First time kept: epoch seconds, or +SECONDS from the start");
    command->add_option("--to", options->to, "Last time kept, likewise");
    command->callback([&chosen, options] { chosen = [options](const Verbosity& v) { return convert(*options, v); }; });
}

}  // namespace slamot::app
