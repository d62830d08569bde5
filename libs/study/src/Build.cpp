#include "slamot/study/Build.h"

#include <link.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include "slamot/rawlog/RawlogWriter.h"
#include "slamot/rawlog/Sha256.h"

namespace slamot::study {
namespace {

// Not libslamot_report and what else only some of the programs load.
constexpr std::array computing_libraries = {"libslamot_core.", "libslamot_rawlog.", "libslamot_sim.",
                                            "libslamot_eval.", "libslamot_run.",    "libslamot_study.",
                                            "libblas",         "libopenblas",       "libm."};

int addLibrary(dl_phdr_info* info, std::size_t, void* files) {
    const std::string name = std::filesystem::path(info->dlpi_name).filename().string();
    const bool computes = std::any_of(computing_libraries.begin(), computing_libraries.end(),
                                      [&](const char* prefix) { return name.rfind(prefix, 0) == 0; });
    if (computes) static_cast<std::set<std::string>*>(files)->insert(info->dlpi_name);
    return 0;
}

/// Of the libraries' contents, in an order that does not depend on where they lie.
const std::string& librariesDigest() {
    static const std::string digest = [] {
        std::set<std::string> files;
        dl_iterate_phdr(addLibrary, &files);
        std::set<std::string> contents;
        for (const std::string& file : files) contents.insert(sha256OfFile(file));
        Sha256 sum;
        for (const std::string& content : contents) sum.add(content.data(), content.size());
        return sum.hex();
    }();
    return digest;
}

}  // namespace

std::string buildOf(const std::vector<const PluginInfo*>& plugins) {
    std::set<std::string> contents;
    for (const PluginInfo* plugin : plugins) contents.insert(sha256OfFile(plugin->file));
    Sha256 sum;
    sum.add(librariesDigest().data(), librariesDigest().size());
    for (const std::string& content : contents) sum.add(content.data(), content.size());
    return sum.hex();
}

}  // namespace slamot::study
