#pragma once
// Finds, checks and loads plugins.
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "slamot/core/plugin/Detector.h"
#include "slamot/core/plugin/Estimator.h"

namespace slamot {

/// A plugin that cannot be found, does not fit, or fails: one sentence naming the file.
class PluginError : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
};

struct PluginInfo {
    std::string name, class_name, kind, about, file;
};

/// A module that was found and refused.
struct RefusedPlugin {
    std::string file;
    /// One sentence, beginning with the file.
    std::string reason;
};

/// The plugins of this process. Load before starting threads.
///
/// Folders are searched in this order: those of SLAMOT_PLUGIN_PATH (separated by ':'), then slamot/plugins beside the
/// core library, which is the build's folder in a build tree and the prefix's when installed. A name found in an earlier folder hides a later one; two modules of
/// one name or one class in the same folder are an error.
class PluginRegistry {
   public:
    /// Looks into the folders and checks what is there in child processes; loads nothing yet.
    static PluginRegistry discover();
    static PluginRegistry discover(const std::vector<std::string>& folders);

    const std::vector<PluginInfo>& plugins() const { return plugins_; }
    const std::vector<RefusedPlugin>& refused() const { return refused_; }

    /// Throws PluginError with the nearest name for an unknown one.
    const PluginInfo& find(const std::string& name, const std::string& kind) const;
    std::shared_ptr<Estimator> createEstimator(const std::string& name) const;
    std::shared_ptr<Detector> createDetector(const std::string& name) const;

    /// The folders `discover()` looks into.
    static std::vector<std::string> defaultFolders();

   private:
    std::vector<PluginInfo> plugins_;
    std::vector<RefusedPlugin> refused_;
};

/// Reads a module's record in a child process. Throws PluginError for: no file, no shared library, unresolved
/// symbols, no record, another interface, MRPT, Eigen alignment or compiler.
PluginInfo probePlugin(const std::string& file);

}  // namespace slamot
