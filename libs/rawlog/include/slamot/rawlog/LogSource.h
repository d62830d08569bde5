#pragma once
// Where the entries of a run come from: a rawlog, or a simulation that never was a file.
#include <mrpt/obs/CObservation.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "slamot/core/data/Odometry.h"
#include "slamot/core/data/Stamp.h"

namespace slamot {

/// What was not used, by sensor label and reason. Reasons are short words; doc/file_formats.md lists those of
/// the reader.
class DropTable {
  public:
    void add(const std::string& sensor, const std::string& reason, std::int64_t count = 1);
    const std::map<std::pair<std::string, std::string>, std::int64_t>& rows() const { return rows_; }
    std::int64_t total() const;

  private:
    std::map<std::pair<std::string, std::string>, std::int64_t> rows_;
};

/// How reading ended.
enum class LogEnd { not_yet, clean, truncated, corrupt };

/// One thing to process, in order. Exactly one of `observation` and `increment` is set.
struct LogEntry {
    Stamp stamp;
    mrpt::obs::CObservation::Ptr observation;
    /// Action-frame logs only: the odometry of the step that ends at `stamp`.
    std::optional<OdometryIncrement> increment;
    std::int64_t position = 0;  ///< index of the object in the log
};

/// Entries come out ordered by (stamp, odometry < lidar < detections, label, position in the log), so that
/// permuted arrival gives the same run; what comes later than the reorder window allows is dropped as 'late',
/// a single stamp more than an hour ahead of its neighbours as 'stamp-jump'.
class LogSource {
  public:
    virtual ~LogSource() = default;
    /// The next entry, or nothing at the end: then `end()` says which end it was.
    virtual std::optional<LogEntry> next() = 0;
    virtual LogEnd end() const = 0;
    /// For LogEnd::truncated and corrupt: one sentence with object number and byte.
    virtual const std::string& endMessage() const = 0;
    virtual const DropTable& drops() const = 0;
    /// Part read so far, 0 to 1.
    virtual double progress() const = 0;
};

}  // namespace slamot
