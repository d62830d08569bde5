#include "Command.h"
#include "slamot/rawlog/LogCheck.h"

namespace slamot::app {

void addCheckLog(CLI::App& app, Action& chosen) {
    struct Options {
        std::string file;
        std::uint64_t memory_limit = 0;
        LogParameters parameters;
    };
    auto* command = app.add_subcommand("check-log", "Look through a log with limited memory; used by the other commands");
    command->group("");
    auto options = std::make_shared<Options>();
    command->add_option("file", options->file)->required();
    command->add_option("--memory-limit", options->memory_limit)->required();
    command->add_option("--reorder-window", options->parameters.reorder_window);
    command->add_option("--step", options->parameters.step);
    command->callback([&chosen, options] {
        chosen = [options](const Verbosity&) {
            return checkLogMain(options->file, options->parameters, options->memory_limit);
        };
    });
}

}  // namespace slamot::app
