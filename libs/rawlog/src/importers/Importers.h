#pragma once
// One function per dataset format, listed in Importer.cpp.
#include "slamot/rawlog/Importer.h"

namespace slamot {

ImportResult importMrclam(const std::string& in, const std::string& out, const ImportProgress& progress);
ImportResult importVictoriaPark(const std::string& in, const std::string& out,
                                const ImportProgress& progress);
ImportResult importCsv(const std::string& in, const std::string& out, const ImportProgress& progress);

}  // namespace slamot
