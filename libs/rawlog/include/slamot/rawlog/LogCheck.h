#pragma once
// Looking through a log that may be broken or hostile, in a child process with limited memory: MRPT's readers
// can be made to allocate without bound or to crash by a flipped bit.
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "slamot/core/data/Stamp.h"
#include "slamot/rawlog/RawlogReader.h"

namespace slamot {

/// What one sensor (class and label) has in a log.
struct SensorSummary {
    std::string class_name, label;
    std::int64_t count = 0;
    Stamp first, last;
    std::int64_t detections = 0, identified = 0;  ///< range-bearing only
    bool has_velocities = false;                  ///< odometry only
    bool has_noise = true;                        ///< range-bearing: every reading claims a noise
};

struct LogSummary {
    LogFormat format = LogFormat::observations;
    bool timed_by_step = false;  ///< action frames only, see RawlogReader::timedByStep
    LogEnd end = LogEnd::clean;
    std::string end_message;
    std::int64_t objects = 0;
    std::vector<SensorSummary> sensors;
    DropTable drops;
};

/// Reads the whole log in this process. Throws LogError.
LogSummary summarise(const std::string& file, const LogParameters& parameters);

std::string toJson(const LogSummary& summary);
LogSummary logSummaryFromJson(const std::string& json);

/// CPU time the child may take; a log of many gigabytes takes minutes [s].
constexpr std::uint64_t log_check_cpu_limit = 600;

/// What the program started by summariseInChild does: lowers its own address space to `memory_limit` bytes
/// (not in sanitizer builds, which reserve far more) and its CPU time to log_check_cpu_limit, prints
/// toJson(summarise(file)) or the error, and returns its exit code.
int checkLogMain(const std::string& file, const LogParameters& parameters, std::uint64_t memory_limit);

/// Runs `program check-log FILE --memory-limit BYTES --reorder-window S --step S`, which must call
/// checkLogMain, and takes its answer. A child that dies is a corrupt log: LogSummary::end says so. Call
/// before any thread is started. Throws LogError when the child says the file cannot be used at all,
/// std::runtime_error when it cannot be started or is interrupted (SIGINT, whatever the parent makes of it).
LogSummary summariseInChild(const std::string& program, const std::string& file,
                            const LogParameters& parameters, std::uint64_t memory_limit = 2ull << 30);

}  // namespace slamot
