#pragma once
// Public datasets become rawlogs and truth folders. One source file per dataset, listed in Importer.cpp.
#include <functional>
#include <string>
#include <vector>

namespace slamot {

struct ImportResult {
    /// Files written, and what a user should know: counts, what was left out and why.
    std::vector<std::string> files, notes;
};

/// Called with the part done, 0 to 1; returns false to stop.
using ImportProgress = std::function<bool(double)>;

struct Importer {
    std::string format, about;
    /// Reads folder `in`; writes `out` (a .rawlog for single-robot data, a folder for several). Throws
    /// LogError.
    ImportResult (*run)(const std::string& in, const std::string& out, const ImportProgress& progress);
};

const std::vector<Importer>& importers();

}  // namespace slamot
