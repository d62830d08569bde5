#include "slamot/core/plugin/PluginRegistry.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <mrpt/system/os.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

namespace slamot {
namespace {

namespace fs = std::filesystem;

constexpr const char* module_prefix = "libslamot_";
constexpr const char* module_suffix = ".so";

/// Modules of a folder, by name. Libraries of this project lie elsewhere and carry version numbers.
std::vector<std::string> modulesIn(const std::string& folder) {
    std::vector<std::string> files;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const std::string name = entry.path().filename().string();
        const bool fits = name.rfind(module_prefix, 0) == 0 && entry.path().extension() == module_suffix;
        if (fits) files.push_back(fs::absolute(entry.path()).string());
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// Where the library with this code lies: build/lib in a build tree, PREFIX/lib when installed.
fs::path ownLibraryFolder() {
    Dl_info info{};
    if (!dladdr(reinterpret_cast<void*>(&ownLibraryFolder), &info) || !info.dli_fname) return ".";
    return fs::absolute(info.dli_fname).parent_path();
}

/// Refuses those of one folder that share a name or class: which one would win is an accident of order.
void refuseDoubles(std::vector<PluginInfo>& found, std::vector<RefusedPlugin>& refused) {
    std::map<std::string, std::vector<std::string>> owners;
    for (const auto& plugin : found) {
        owners["name '" + plugin.name + "'"].push_back(plugin.file);
        owners["class " + plugin.class_name].push_back(plugin.file);
    }
    const auto doubled = [&](const PluginInfo& plugin) {
        for (const std::string& what : {"class " + plugin.class_name, "name '" + plugin.name + "'"})
            for (const std::string& other : owners[what])
                if (other != plugin.file) {
                    refused.push_back(
                        {plugin.file, fmt::format("{}: {} is also that of {}", plugin.file, what, other)});
                    return true;
                }
        return false;
    };
    found.erase(std::remove_if(found.begin(), found.end(), doubled), found.end());
}

/// Loads the module, unless its class is there already, and creates one object.
template <class Interface>
std::shared_ptr<Interface> create(const PluginInfo& plugin) {
    if (!mrpt::rtti::findRegisteredClass(plugin.class_name)) {
        std::string errors;
        if (!mrpt::system::loadPluginModule(plugin.file, errors))
            throw PluginError(fmt::format("{}: cannot be loaded: {}", plugin.file, errors));
    }
    mrpt::rtti::CObject::Ptr object;
    try {
        object = mrpt::rtti::classFactory(plugin.class_name);
    } catch (const std::exception& error) {
        throw PluginError(fmt::format("{}: the constructor of {} failed: {}", plugin.file, plugin.class_name,
                                      error.what()));
    } catch (...) {
        throw PluginError(fmt::format("{}: the constructor of {} failed", plugin.file, plugin.class_name));
    }
    if (!object)
        throw PluginError(
            fmt::format("{}: says it has class {}, which it does not register", plugin.file, plugin.class_name));
    auto typed = std::dynamic_pointer_cast<Interface>(object);
    if (!typed)
        throw PluginError(fmt::format("{}: {} is no {}, as its record says", plugin.file, plugin.class_name, plugin.kind));
    return typed;
}

}  // namespace

std::vector<std::string> PluginRegistry::defaultFolders() {
    std::vector<std::string> folders;
    if (const char* path = std::getenv("SLAMOT_PLUGIN_PATH")) {
        std::istringstream parts(path);
        for (std::string part; std::getline(parts, part, ':');)
            if (!part.empty()) folders.push_back(part);
    }
    folders.push_back((ownLibraryFolder() / "slamot" / "plugins").string());
    return folders;
}

PluginRegistry PluginRegistry::discover() {
    return discover(defaultFolders());
}

PluginRegistry PluginRegistry::discover(const std::vector<std::string>& folders) {
    PluginRegistry registry;
    for (const std::string& folder : folders) {
        std::vector<PluginInfo> found;
        for (const std::string& file : modulesIn(folder)) try {
                found.push_back(probePlugin(file));
            } catch (const PluginError& error) {
                registry.refused_.push_back({file, error.what()});
            }
        refuseDoubles(found, registry.refused_);
        for (const PluginInfo& plugin : found) {
            const bool hidden = std::any_of(
                registry.plugins_.begin(), registry.plugins_.end(),
                [&](const PluginInfo& p) { return p.name == plugin.name || p.class_name == plugin.class_name; });
            if (!hidden) registry.plugins_.push_back(plugin);
        }
    }
    std::sort(registry.plugins_.begin(), registry.plugins_.end(),
              [](const PluginInfo& a, const PluginInfo& b) { return a.name < b.name; });
    return registry;
}

const PluginInfo& PluginRegistry::find(const std::string& name, const std::string& kind) const {
    std::vector<std::string> names;
    for (const PluginInfo& plugin : plugins_) {
        if (plugin.kind != kind) continue;
        if (plugin.name == name) return plugin;
        names.push_back(plugin.name);
    }
    for (const RefusedPlugin& refused : refused_)
        if (fs::path(refused.file).stem() == module_prefix + name)
            throw PluginError(fmt::format("{} '{}' was refused: {}", kind, name, refused.reason));
    const auto near = nearestWord(name, names);
    std::string known;
    for (const std::string& other : names) known += (known.empty() ? "" : ", ") + other;
    throw PluginError(fmt::format("no {} '{}'{}; there {} {} (searched SLAMOT_PLUGIN_PATH and the program's own "
                                  "plugin folder)",
                                  kind, name, near ? "; did you mean '" + *near + "'?" : "",
                                  names.size() == 1 ? "is" : "are", known.empty() ? "none" : known));
}

std::shared_ptr<Estimator> PluginRegistry::createEstimator(const std::string& name) const {
    return create<Estimator>(find(name, "estimator"));
}

std::shared_ptr<Detector> PluginRegistry::createDetector(const std::string& name) const {
    return create<Detector>(find(name, "detector"));
}

}  // namespace slamot
