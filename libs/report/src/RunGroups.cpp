// Which runs belong together, what they are called and in what their settings differ.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "ConfigLines.h"
#include "slamot/report/Comparison.h"

namespace slamot::report {
namespace {

std::string folderName(const RunFolder& run) {
    const std::filesystem::path path = std::filesystem::path(run.folder).lexically_normal();
    return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

bool isSeed(const std::string& section, const std::string& key) {
    return key == "seed" && (section == "run" || section == "clutter");
}

/// The settings without seeds.
std::string settingsOf(const RunFolder& run) {
    std::string settings;
    forEachConfigLine(run.text("config"),
                      [&](const std::string& section, const std::string& key, const std::string& line) {
                          if (!isSeed(section, key)) {
                              settings += line + "\n";
                          }
                      });
    return settings;
}

using Setting = std::pair<std::string, std::string>;  // section and key

std::map<Setting, std::string> valuesOf(const RunFolder& run) {
    std::map<Setting, std::string> values;
    forEachConfigLine(run.text("config"),
                      [&](const std::string& section, const std::string& key, const std::string& line) {
                          if (!key.empty() && !isSeed(section, key)) {
                              values[{section, key}] = configValue(line);
                          }
                      });
    return values;
}

/// What all names begin with, without the number or mark that it ends in.
std::string commonName(const std::vector<RunFolder>& runs) {
    std::string common = folderName(runs.front());
    for (const RunFolder& run : runs) {
        const std::string name = folderName(run);
        const auto differ = std::mismatch(common.begin(), common.end(), name.begin(), name.end());
        common.erase(differ.first, common.end());
    }
    while (!common.empty() && std::string("_-. 0123456789").find(common.back()) != std::string::npos) {
        common.pop_back();
    }
    return common.empty() ? runs.front().text("estimator") : common;
}

}  // namespace

std::vector<std::string> dropRepeats(std::vector<RunFolder>& runs) {
    std::map<std::pair<std::string, std::string>, std::string> first;
    std::vector<RunFolder> kept;
    std::vector<std::string> notes;
    for (RunFolder& run : runs) {
        const std::string hash = run.text("estimate_sha256");
        const auto [found, is_new] = first.try_emplace({settingsOf(run), hash}, run.folder);
        if (is_new || hash.empty()) {
            kept.push_back(std::move(run));
        } else {
            notes.push_back(
                fmt::format("{} repeats {} (settings but for seeds, and estimates) and is left out",
                            run.folder, found->second));
        }
    }
    runs = std::move(kept);
    return notes;
}

std::vector<RunGroup> groupRuns(std::vector<RunFolder> runs) {
    std::vector<RunGroup> groups;
    std::map<std::string, std::size_t> place;
    for (RunFolder& run : runs) {
        const auto [found, is_new] = place.try_emplace(settingsOf(run), groups.size());
        if (is_new) {
            groups.emplace_back();
        }
        groups[found->second].runs.push_back(std::move(run));
    }
    std::map<std::string, int> used;
    for (RunGroup& group : groups) {
        group.name = group.runs.size() == 1 ? folderName(group.runs.front()) : commonName(group.runs);
        if (used.count(group.name) > 0) {
            group.name += " " + group.runs.front().text("estimator");
        }
        if (const int times = ++used[group.name]; times > 1) {
            group.name += fmt::format(" ({})", times);
        }
    }
    return groups;
}

std::vector<ComparedSetting> compareSettings(const std::vector<RunGroup>& groups) {
    std::vector<std::map<Setting, std::string>> of_groups;
    std::set<std::string> estimators;
    std::set<Setting> all;
    for (const RunGroup& group : groups) {
        of_groups.push_back(valuesOf(group.runs.front()));
        estimators.insert(group.runs.front().text("estimator"));
        for (const auto& [setting, value] : of_groups.back()) {
            all.insert(setting);
        }
    }
    std::vector<ComparedSetting> compared;
    for (const Setting& setting : all) {
        ComparedSetting row{setting.first, setting.second, {}};
        // An estimator's own settings are compared among runs of it.
        const std::string owner = setting.first.substr(0, setting.first.find('.'));
        std::set<std::string> different;
        for (std::size_t g = 0; g < groups.size(); ++g) {
            const auto found = of_groups[g].find(setting);
            row.values.push_back(found == of_groups[g].end() ? "" : found->second);
            if (estimators.count(owner) == 0 || groups[g].runs.front().text("estimator") == owner) {
                different.insert(row.values.back());
            }
        }
        if (different.size() > 1) {
            compared.push_back(std::move(row));
        }
    }
    return compared;
}

}  // namespace slamot::report
