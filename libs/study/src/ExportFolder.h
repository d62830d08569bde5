#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace slamot::study {

/// Makes room for an export: removes what an earlier one of the same study left in the folder, by the list
/// that it wrote there, and writes the list of the new one. Throws LogError for a folder with another study's
/// export or with files of any other origin; it is then as it was.
void replaceExport(const std::filesystem::path& folder, const std::string& study,
                   const std::vector<std::filesystem::path>& files);

}  // namespace slamot::study
