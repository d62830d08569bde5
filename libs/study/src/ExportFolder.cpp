#include "ExportFolder.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/PartFile.h"

namespace slamot::study {
namespace {

namespace fs = std::filesystem;

/// The study's name, then a file a line.
constexpr const char* list_name = "exported_files.txt";

/// Below the folder, whatever the list says.
bool staysBelow(const fs::path& file) {
    return file.is_relative() && !file.empty() &&
           std::none_of(file.begin(), file.end(), [](const fs::path& part) { return part == ".."; });
}

void removeEarlierExport(const fs::path& folder, const std::string& study) {
    std::error_code error;
    if (!fs::is_directory(folder, error) || fs::is_empty(folder, error)) return;
    std::ifstream list(folder / list_name);
    std::string line;
    if (!std::getline(list, line))
        throw LogError(fmt::format("{}: holds files that no export of a study made, expected an empty folder",
                                   folder.string()));
    if (line != study)
        throw LogError(
            fmt::format("{}: holds an export of the study '{}', expected one of '{}' or an empty folder",
                        folder.string(), line, study));
    while (std::getline(list, line))
        if (staysBelow(line)) fs::remove(folder / line, error);
}

}  // namespace

void replaceExport(const fs::path& folder, const std::string& study, const std::vector<fs::path>& files) {
    removeEarlierExport(folder, study);
    std::error_code error;  // PartFile says what is wrong
    fs::create_directories(folder, error);
    PartFile list((folder / list_name).string());
    list.line(study);
    for (const fs::path& file : files) list.line(file.string());
    list.close();
}

}  // namespace slamot::study
