#include <fmt/format.h>

#include "Command.h"
#include "slamot/core/plugin/PluginRegistry.h"
#include "slamot/run/RunConfig.h"

namespace slamot::app {
namespace {

int listPlugins(const Verbosity& verbosity) {
    const PluginRegistry registry = PluginRegistry::discover();
    for (const PluginInfo& plugin : registry.plugins()) {
        fmt::print("{:16} {:10} {}\n", plugin.name, plugin.kind, plugin.about);
        if (verbosity.verbose) fmt::print("{:16} {} in {}\n", "", plugin.class_name, plugin.file);
    }
    for (const RefusedPlugin& refused : registry.refused())
        fmt::print(stderr, "refused: {}: {}\n", refused.file, refused.reason);
    if (!registry.plugins().empty()) return exit_success;
    std::string folders;
    for (const std::string& folder : PluginRegistry::defaultFolders()) folders += "\n  " + folder;
    fmt::print(stderr, "slamot: no plugins found; looked in:{}\n", folders);
    return exit_failed;
}

}  // namespace

void addPlugins(CLI::App& app, Action& chosen) {
    auto* command = app.add_subcommand("plugins", "List estimators and detectors.\nExample: slamot plugins");
    command->callback([&chosen] { chosen = listPlugins; });
}

void addConfig(CLI::App& app, Action& chosen) {
    auto* command = app.add_subcommand("config",
                                       "Print a plugin's full, commented config.\nExample: slamot config ekf_slamot > "
                                       "my.ini");
    auto name = std::make_shared<std::string>();
    command->add_option("plugin", *name, "Plugin name")->required();
    command->callback([&chosen, name] {
        chosen = [name](const Verbosity&) {
            fmt::print("{}", run::fullConfigText(*name, PluginRegistry::discover()));
            return exit_success;
        };
    });
}

}  // namespace slamot::app
