#pragma once
// Streams either of MRPT's log formats in a stable order.
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Odometry.h"
#include "slamot/core/data/Stamp.h"

namespace slamot {

/// Step 0 of action-frame logs without usable stamps: 2020-01-01 00:00 UTC.
inline constexpr Stamp action_frame_epoch{1'577'836'800 * Stamp::ticks_per_second};

/// Section `[log]`: how a log is read.
struct LogParameters {
    double reorder_window = 1.0;  ///< [s]
    double step = 0.1;            ///< [s] per frame, for action-frame logs without usable stamps
};
ParameterTable describe(LogParameters& parameters);

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

enum class LogFormat { observations, action_frames };

/// How reading ended.
enum class LogEnd { not_yet, clean, truncated, corrupt };

/// One thing to process, in order. Exactly one of `observation` and `increment` is set.
struct LogEntry {
    Stamp stamp;
    mrpt::obs::CObservation::Ptr observation;
    /// Action-frame logs only: the odometry of the step that ends at `stamp`.
    std::optional<OdometryIncrement> increment;
    std::int64_t position = 0;  ///< index of the object in the file
};

/// Entries come out ordered by (stamp, odometry < lidar < detections, label, position in file), so that
/// permuted arrival gives the same run; what comes later than the reorder window allows is dropped as 'late',
/// a single stamp more than an hour ahead of its neighbours as 'stamp-jump'.
/// Action-frame logs are ordered by position; their time is the step number times `step` where the stamps
/// cannot be used.
class RawlogReader {
  public:
    /// Throws LogError when the file is missing, empty or no rawlog.
    RawlogReader(const std::string& file, const LogParameters& parameters);
    ~RawlogReader();

    /// The next entry, or nothing at the end: then `end()` says which end it was. Throws LogError for an
    /// action whose numbers are not finite: the way would be lost.
    std::optional<LogEntry> next();

    LogFormat format() const;
    /// Action-frame logs only: their stamps cannot be used, the step number is their time.
    bool timedByStep() const;
    LogEnd end() const;
    /// For LogEnd::truncated and corrupt: one sentence with object number and byte.
    const std::string& endMessage() const;
    /// Objects read from the file so far.
    std::int64_t objects() const;
    const DropTable& drops() const;
    /// Part of the file read so far, 0 to 1.
    double progress() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace slamot
