#include <fmt/format.h>

#include "Command.h"
#include "LogGuard.h"
#include "Progress.h"
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

int convert(const Options& options, const Verbosity& verbosity) {
    const LogParameters parameters;
    const LogSummary summary = guardedSummary(options.in, parameters);
    ConvertOptions how;
    how.labels = options.labels;
    if (options.format == "observations") how.format = LogFormat::observations;
    if (options.format == "action-frames") how.format = LogFormat::action_frames;
    if (!options.from.empty()) how.from = timeFrom(options.from, summary);
    if (!options.to.empty()) how.to = timeFrom(options.to, summary);

    ConvertResult result;
    {
        Progress progress("converting", verbosity.quiet);
        result = convertLog(options.in, options.out, parameters, how, [&](double done) {
            progress.show(done);
            return !interrupted();
        });
    }
    if (interrupted()) throw std::runtime_error(options.out + ".part holds what was written before the stop");
    if (!verbosity.quiet)
        fmt::print("{}: {} observations and {} odometry entries written, {} left out\n", options.out, result.observations,
                   result.odometry, result.left_out);
    if (result.end != LogEnd::clean) {
        fmt::print(stderr, "slamot: {}: {}\n", options.in, result.end_message);
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
