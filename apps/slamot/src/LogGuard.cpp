#include "LogGuard.h"

#include "Command.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/RawlogWriter.h"

namespace slamot::app {
namespace {

Checksum requireNotTampered(const std::string& file) {
    const Checksum checksum = checkChecksum(file);
    if (checksum == Checksum::differs)
        throw LogError(file + ": differs from its checksum in " + file +
                       ".sha256: the log was changed or damaged after it was written");
    return checksum;
}

}  // namespace

LogSummary guardedSummary(const std::string& file, const LogParameters& parameters) {
    requireNotTampered(file);
    LogSummary summary = summariseInChild(ownProgram(), file, parameters);
    if (summary.end == LogEnd::corrupt) throw LogError(summary.end_message + "; the log is corrupt");
    return summary;
}

void guardLog(const std::string& file, const LogParameters& parameters) {
    if (requireNotTampered(file) != Checksum::matches) guardedSummary(file, parameters);
}

}  // namespace slamot::app
