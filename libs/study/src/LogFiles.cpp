#include "LogFiles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glob.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "Digest.h"
#include "FileLock.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/rawlog/Importer.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/PartFile.h"
#include "slamot/study/Build.h"

namespace slamot::study {
namespace {

namespace fs = std::filesystem;

/// Where the datasets lie: SLAMOT_DATASETS or, for a study in a source tree, the folder beside the tree.
fs::path datasetsFolder(const StudyFile& study) {
    if (const char* given = std::getenv("SLAMOT_DATASETS")) return given;
    return fs::path(study.text.folder()) / "../../../shared/datasets";
}

std::vector<std::string> matching(const fs::path& pattern) {
    glob_t found{};
    std::vector<std::string> files;
    if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
        files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
    globfree(&found);
    std::sort(files.begin(), files.end(), [](const std::string& a, const std::string& b) {
        return strverscmp(a.c_str(), b.c_str()) < 0;
    });
    return files;
}

const Importer& importerOf(const StudyFile& study, const Source& source) {
    std::vector<std::string> formats;
    for (const Importer& importer : importers()) {
        if (importer.format == source.log->importer) return importer;
        formats.push_back(importer.format);
    }
    const auto near = nearestWord(source.log->importer, formats);
    throw ConfigError(fmt::format("{}: import = '{}' in [log.{}]{}, expected one of {}",
                                  study.text.section("log." + source.name).at("import").origin,
                                  source.log->importer, source.name,
                                  near ? " (did you mean '" + *near + "'?)" : "", fmt::join(formats, ", ")));
}

/// Of the files' names, sizes and times of change.
std::string digestOfFiles(const fs::path& data) {
    std::vector<std::string> files;
    for (const auto& entry :
         fs::recursive_directory_iterator(data, fs::directory_options::follow_directory_symlink))
        if (entry.is_regular_file())
            files.push_back(fmt::format("{} {} {}", entry.path().lexically_relative(data).string(),
                                        entry.file_size(),
                                        entry.last_write_time().time_since_epoch().count()));
    std::sort(files.begin(), files.end());
    return digestOf(files);
}

/// The folder with the imported logs, made when it is not there: another one for each state of the dataset
/// and for each build.
fs::path imported(const Importer& importer, const fs::path& data, const Source& source,
                  const std::string& work_folder) {
    const std::string made_from =
        digestOf({importer.format, fs::absolute(data).string(), digestOfFiles(data), buildOf({})});
    const fs::path out = fs::path(work_folder) / fmt::format("{}-{}", source.name, made_from.substr(0, 12));
    // Never half-made, and perhaps in a folder where nothing may be written.
    if (fs::is_directory(out)) return out;
    std::error_code error;
    fs::create_directories(work_folder, error);
    if (error) throw LogError(fmt::format("{}: cannot be made ({})", work_folder, error.message()));
    const FileLock lock(out.string() + ".lock");
    if (fs::is_directory(out)) return out;
    // A killed import leaves its unfinished folder, which never has the final name.
    const fs::path unfinished = partOf(out.string());
    fs::remove_all(unfinished);
    fs::create_directories(unfinished);
    // An importer of a single log writes that file, one of several writes a folder.
    const bool single = source.log->files.find_first_of("*?[") == std::string::npos;
    importer.run(data.string(), (single ? unfinished / source.log->files : unfinished).string(), {});
    finishPart(out.string());
    return out;
}

}  // namespace

FoundFolder findDataset(const StudyFile& study, const Source& source, const std::string& name) {
    const fs::path folder = datasetsFolder(study) / name;
    if (fs::is_directory(folder)) return {folder.string(), {}};
    return {{},
            fmt::format("source {} is skipped: there is no {} in the datasets' folder{}", source.name, name,
                        std::getenv("SLAMOT_DATASETS") ? "" : " (SLAMOT_DATASETS is not set)")};
}

FoundLogs findLogs(const StudyFile& study, const Source& source, const std::string& work_folder) try {
    const LogSourceFiles& wanted = *source.log;
    const Importer* importer = wanted.importer.empty() ? nullptr : &importerOf(study, source);
    fs::path folder = study.text.folder();
    if (!wanted.folder.empty()) {
        const FoundFolder found = findDataset(study, source, wanted.folder);
        if (!found.why_none.empty()) return {{}, found.why_none};
        folder = found.folder;
        if (importer) folder = imported(*importer, folder, source, work_folder);
    }
    const std::vector<std::string> files = matching(folder / wanted.files);
    if (files.empty())
        return {{},
                fmt::format("source {} is skipped: no {} in {}", source.name, wanted.files, folder.string())};
    return {files, {}};
} catch (const fs::filesystem_error& error) {
    throw LogError(fmt::format("source {}: {}: {}, expected files that can be read and a folder to write to",
                               source.name, error.path1().string(), error.code().message()));
}

}  // namespace slamot::study
