#include <fmt/format.h>

#include <algorithm>

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
        fmt::print(stderr, "refused: {}\n", refused.reason);
    if (!registry.plugins().empty()) return exit_success;
    std::string folders;
    for (const std::string& folder : PluginRegistry::defaultFolders()) folders += "\n  " + folder;
    fmt::print(stderr, "slamot: no plugins found; looked in:{}\n", folders);
    return exit_failed;
}

/// The tables of a plugin's doc page.
void printMarkdown(const std::string& plugin, const PluginRegistry& registry) {
    const auto print = [](const std::vector<ParameterTable>& tables) {
        for (std::size_t i = 0; i < tables.size(); ++i) fmt::print("{}{}", i ? "\n" : "", toMarkdown(tables[i]));
    };
    const bool is_detector = std::any_of(registry.plugins().begin(), registry.plugins().end(), [&](const PluginInfo& p) {
        return p.name == plugin && p.kind == "detector";
    });
    if (is_detector) {
        const auto detector = registry.createDetector(plugin);
        print(detector->parameterTables());
    } else {
        const auto estimator = registry.createEstimator(plugin);
        print(estimator->parameterTables());
    }
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
    auto markdown = std::make_shared<bool>(false);
    command->add_option("plugin", *name, "Plugin name")->required();
    command->add_flag("--markdown", *markdown, "The plugin's own tables as Markdown, for its doc page");
    command->callback([&chosen, name, markdown] {
        chosen = [name, markdown](const Verbosity&) {
            const PluginRegistry registry = PluginRegistry::discover();
            if (*markdown)
                printMarkdown(*name, registry);
            else
                fmt::print("{}", run::fullConfigText(*name, registry));
            return exit_success;
        };
    });
}

}  // namespace slamot::app
