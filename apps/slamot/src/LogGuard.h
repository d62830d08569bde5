#pragma once
#include <string>

#include "slamot/rawlog/LogCheck.h"

namespace slamot::app {

/// Looks through an untrusted log in a child process. Throws LogError for logs that cannot be read safely: corrupt
/// ones, and those that differ from the checksum beside them. A truncated log is returned with its end.
LogSummary guardedSummary(const std::string& file, const LogParameters& parameters);

/// As guardedSummary, but does nothing for a log that matches the checksum beside it.
void guardLog(const std::string& file, const LogParameters& parameters);

}  // namespace slamot::app
