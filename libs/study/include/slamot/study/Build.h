#pragma once
#include <string>
#include <vector>

#include "slamot/core/plugin/PluginRegistry.h"

namespace slamot::study {

/// SHA-256 over this project's libraries, the libraries its numbers come from (BLAS, mathematics) and the
/// files of the plugins named: rows of two equal ones are the same on one type of CPU.
std::string buildOf(const std::vector<const PluginInfo*>& plugins);

}  // namespace slamot::study
